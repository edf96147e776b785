// SPDX-License-Identifier: BSD-3-Clause
#include "terrain/grain_entry.hpp"

#include "base/algorithms.hpp"
#include "base/error.hpp"
#include "base/random.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numeric>
#include <stdexcept>
#include <tuple>

namespace grouser::terrain {

using base::Position;
using base::Vec3d;

std::size_t fixedAmong(const std::vector<GrainSpec>& grains) {
  return static_cast<std::size_t>(
      std::count_if(grains.begin(), grains.end(), [](const GrainSpec& g) { return g.fixed; }));
}

std::vector<Position> placesOf(const std::vector<GrainSpec>& start, std::size_t first, const GrainConstants& c) {
  const base::PositionScale& scale = c.scale;
  const base::Period& period = c.period;
  std::vector<Position> places(start.size());
  const double limit = scale.limit();
  for (std::size_t i = 0; i < start.size(); ++i) {
    const Vec3d& x = start[i].position;
    if (!(std::fabs(x.x) < limit && std::fabs(x.y) < limit && std::fabs(x.z) < limit))
      throw base::InputError(
          fmt::format("grain {} at ({}, {}, {}) m lies outside the position range of +-{:.6g} m for grains of radius "
                      "{} m; move the scene closer to the origin",
                      first + i, x.x, x.y, x.z, limit, c.model.radius));
    places[i] = scale.fromMetres(x);
    if (start[i].fixed && (norm2(start[i].velocity) > 0 || norm2(start[i].spin) > 0))
      throw base::InputError(fmt::format("grain {} at ({}, {}, {}) m is fixed and has a velocity or a spin; a fixed "
                                         "grain never moves: remove fixed, or velocity and spin",
                                         first + i, x.x, x.y, x.z));
    if (start[i].fixed && !c.has(kFixed)) throw std::logic_error("a fixed grain enters a scene without fixed grains");
    for (int a = 0; a < 2; ++a)
      if (period.periodsBack(a, base::toUnits(places[i])[a]) != 0)
        throw base::InputError(fmt::format("grain {} at ({}, {}, {}) m lies outside the periodic boundaries {} = "
                                           "{:.9g} m and {:.9g} m; move it between them",
                                           first + i, x.x, x.y, x.z, "xy"[a],
                                           static_cast<double>(period.low[a]) * scale.unit,
                                           static_cast<double>(period.low[a] + period.length[a]) * scale.unit));
  }
  return places;
}

namespace {

/// True if all positions have different hashes. Otherwise (rare) the caller compares the positions.
bool hashesDiffer(const base::Exec& exec, const std::vector<Position>& position) {
  constexpr std::uint64_t kPurpose = base::purpose("terrain.places");
  std::vector<std::uint64_t> hash(position.size());
  for (std::size_t i = 0; i < position.size(); ++i) {
    const Position& p = position[i];
    hash[i] = base::hash(std::uint64_t{p.x} << 32 | p.y, kPurpose, std::uint64_t{p.z} << 32 | p.high);
  }
  std::vector<std::uint32_t> unused(position.size());
  base::sortByKey(exec, hash.data(), unused.data(), hash.size());
  return std::adjacent_find(hash.begin(), hash.end()) == hash.end();
}

} // namespace

void checkDistinct(const base::Exec& exec, const std::vector<Position>& position,
                   const std::vector<std::uint32_t>& id) {
  if (hashesDiffer(exec.onCpu() ? exec : base::cpuExec(), position)) return;
  std::vector<std::size_t> order(position.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto key = [&](std::size_t i) {
    const Position& p = position[i];
    return std::tuple(p.x, p.y, p.z, p.high);
  };
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return key(a) < key(b); });
  for (std::size_t k = 1; k < order.size(); ++k)
    if (key(order[k - 1]) == key(order[k]))
      throw base::InputError(fmt::format("grains {} and {} have the same position; move one of them",
                                         std::min(id[order[k - 1]], id[order[k]]),
                                         std::max(id[order[k - 1]], id[order[k]])));
}

} // namespace grouser::terrain
