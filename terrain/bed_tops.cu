// SPDX-License-Identifier: BSD-3-Clause
#include "terrain/bed_tops.hpp"

#include "base/bits.hpp"
#include "base/error.hpp"
#include "base/for_each.cuh"

#include <string>

namespace grouser::terrain {

using base::Vec3d;

namespace {

/// Order-reversing words: the minimum word corresponds to the maximum height, for any order of the threads. The word
/// with all bits set denotes "no grain"; no height has this word.
GROUSER_HD std::uint64_t wordOf(double height) {
  const auto bits = base::bitsAs<std::uint64_t>(height);
  const std::uint64_t rising = bits >> 63 ? ~bits : bits | std::uint64_t{1} << 63;
  return ~rising;
}

double heightOf(std::uint64_t word) {
  if (word == ~std::uint64_t{0}) return -HUGE_VAL;
  const std::uint64_t rising = ~word;
  return base::bitsAs<double>(rising >> 63 ? rising & ~(std::uint64_t{1} << 63) : ~rising);
}

/// Centres and radii of grains on the host, and of a bed during a run.
struct OfSeeds {
  const Seed* seeds;
  GROUSER_HD Vec3d centre(int g) const { return seeds[g].centre; }
  GROUSER_HD double radius(int g) const { return seeds[g].radius; }
  GROUSER_HD bool counts(int) const { return true; }
};
struct OfGrains {
  const base::Position* position;
  base::PositionScale scale;
  double grainRadius;
  const Motion* radiusInW;    ///< radius in velocity.w; null if all have grainRadius
  const std::uint32_t* ghost; ///< null without ghosts
  GROUSER_HD Vec3d centre(int g) const { return scale.toMetres(position[g]); }
  GROUSER_HD double radius(int g) const {
    return radiusInW ? std::fabs(static_cast<double>(radiusInW[g].velocity.w)) : grainRadius;
  }
  /// Slaves are skipped: they may lag one step behind, and their masters count on their own ranks.
  GROUSER_HD bool counts(int g) const { return !(ghost && ghost[g]); }
};

template <class Source> struct RaiseTops {
  Source grains;
  NodeGrid grid;
  double reach;
  std::uint64_t* words;
  GROUSER_HD void operator()(int g) const {
    if (!grains.counts(g)) return;
    const Vec3d c = grains.centre(g);
    const std::uint64_t top = wordOf(c.z + grains.radius(g));
    std::uint64_t* const target = words;
    grid.forEachWithin(c.x, c.y, reach, [=](std::size_t node) { base::atomicMin64(target + node, top); });
  }
};

template <class Source> std::vector<std::uint64_t> raise(const base::Exec& exec, const Source& source,
                                                         std::size_t count, const NodeGrid& grid, double reach) {
  base::Array<std::uint64_t> words(exec, std::vector<std::uint64_t>(grid.size(), ~std::uint64_t{0}));
  base::forEach(exec, "highest tops", static_cast<std::int64_t>(count),
                RaiseTops<Source>{source, grid, reach, words.data()});
  return words.toHost();
}

std::vector<double> heights(const std::vector<std::uint64_t>& words) {
  std::vector<double> out;
  out.reserve(words.size());
  for (const std::uint64_t word : words) out.push_back(heightOf(word));
  return out;
}

} // namespace

std::vector<double> highestTops(const base::Exec& exec, const Grains& grains, const NodeGrid& grid, double reach) {
  const contact::GrainsView view = grains.view();
  const OfGrains source{view.position, grains.scale(), grains.model().radius,
                        grains.system().constants.manyRadii() ? view.motion : nullptr, view.ghost};
  std::vector<std::uint64_t> words = raise(exec, source, view.count, grid, reach);
  grains.system().comm.minimum(words.data(), words.size());
  return heights(words);
}

std::vector<double> highestTops(std::span<const Seed> grains, const NodeGrid& grid, double reach) {
  for (std::size_t g = 0; g < grains.size(); ++g) {
    const Vec3d& c = grains[g].centre;
    if (!(std::isfinite(c.x) && std::isfinite(c.y) && std::isfinite(c.z) && std::isfinite(grains[g].radius)))
      throw base::InputError("surface of the bed: grain " + std::to_string(g) + " has no finite position");
  }
  return heights(raise(base::cpuExec(1), OfSeeds{grains.data()}, grains.size(), grid, reach));
}

} // namespace grouser::terrain
