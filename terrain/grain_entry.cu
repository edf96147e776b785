// SPDX-License-Identifier: BSD-3-Clause
// Whether grains that enter find room among those that are there.
#include "base/for_each.cuh"
#include "terrain/grains.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace grouser::terrain {

using base::Vec3d;
using base::Vec3l;

namespace {

constexpr std::uint64_t kMostUnits = 0xFFFFFFFFull;

struct Entering {
  base::Position position;
  double radius; ///< [units]
};

/// Looks for the grain that the entering ones would overlap most.
struct FindCrowded {
  const base::Position* position;
  const Vec4f* velocity; ///< with the radius [m] in w, where they differ
  const std::uint32_t *id, *ghost;
  base::Period period;
  const Entering* entering;
  std::int64_t count;
  base::Position centre;         ///< of the box about all that enter
  Vec3d reach;                   ///< from there to where a grain may touch one of them [units]
  double radius;                 ///< of all [units]; 0: each has its own
  double unitsPerMetre, allowed; ///< [-] of the smaller radius
  std::uint64_t*
      deepest; ///< kMostUnits less the overlap, then the id: the smallest is the deepest, or of those the first

  GROUSER_HD void operator()(int i) const {
    if (ghost && ghost[i]) return;
    const Vec3d fromCentre = period.apart(centre, position[i]).as<double>();
    for (int a = 0; a < 3; ++a)
      if (fabs(fromCentre[a]) > reach[a]) return;
    const double own = radius > 0 ? radius : static_cast<double>(velocity[i].w) * unitsPerMetre;
    for (std::int64_t k = 0; k < count; ++k) {
      const double overlap =
          own + entering[k].radius - norm(period.apart(entering[k].position, position[i]).as<double>());
      const double smaller = own < entering[k].radius ? own : entering[k].radius;
      if (!(overlap > allowed * smaller)) continue;
      const auto units = static_cast<std::uint64_t>(overlap); // at most two radii, 2e8
      base::atomicMin64(deepest, (kMostUnits - units) << 32 | id[i]);
    }
  }
};

} // namespace

std::optional<InsertionOverlap> Grains::insertionOverlapOf(const std::vector<GrainSpec>& entering) const {
  if (entering.empty()) return {};
  const auto radiusOf = [&](const GrainSpec& g) { return g.radius > 0 ? g.radius : model_.radius; };
  for (std::size_t k = 0; k < entering.size(); ++k)
    for (std::size_t s = 0; s < geometries_.size(); ++s) {
      const Vec3d p_S = placements_.host()[s].motion.toPart(entering[k].position);
      const double overlap = radiusOf(entering[k]) - gapTo(geometries_[s], p_S).distance;
      if (overlap > model_.maxOverlap * radiusOf(entering[k])) return InsertionOverlap{k, overlap, {}, {}, s};
    }

  std::vector<Entering> all;
  Vec3d low = entering.front().position, high = low;
  double largest = 0;
  for (const GrainSpec& g : entering) {
    all.push_back({scale_.fromMetres(g.position), radiusOf(g) * scale_.perMetre});
    low = base::min(low, g.position), high = base::max(high, g.position);
    largest = std::max(largest, radiusOf(g));
  }
  const double beyond = largest + model_.radius;
  const Vec3d reach = (high - low) * 0.5 + Vec3d{beyond, beyond, beyond};
  constexpr std::uint64_t kNobody = std::numeric_limits<std::uint64_t>::max();
  base::Array<Entering> device(exec_, all);
  base::Array<std::uint64_t> deepest(exec_, std::vector<std::uint64_t>{kNobody});
  base::forEach(exec_, "find room", static_cast<std::int64_t>(slots_),
                FindCrowded{positions(), velocities(), ids(), ghosts(), period_, device.data(),
                            static_cast<std::int64_t>(all.size()), scale_.fromMetres((low + high) * 0.5),
                            reach * scale_.perMetre * (1 + 1e-6), manyRadii() ? 0.0 : model_.radius * scale_.perMetre,
                            scale_.perMetre, model_.maxOverlap, deepest.data()});
  std::uint64_t key = deepest.toHost().front();
  comm_.minimum(&key, 1);
  if (key == kNobody) return {};

  InsertionOverlap insertionOverlap;
  insertionOverlap.overlap = static_cast<double>(kMostUnits - (key >> 32)) * scale_.unit;
  insertionOverlap.grain = static_cast<std::uint32_t>(key);
  // Only the rank that integrates the other grain knows where it is.
  const std::vector<std::uint32_t> id = id_.toHost();
  const std::vector<std::uint32_t> roles =
      ghosts() ? base::toHost(exec_, ghosts(), slots_) : std::vector<std::uint32_t>();
  double found[] = {-1e300, -1e300, -1e300};
  double nearest = 1e300; // to the overlap that was found [m]
  for (std::size_t i = 0; i < slots_; ++i) {
    if (id[i] != *insertionOverlap.grain || (!roles.empty() && roles[i])) continue;
    const base::Position place = position_[0].at(i);
    const Vec3d x = scale_.toMetres(place);
    found[0] = x.x, found[1] = x.y, found[2] = x.z;
    const double own = manyRadii() ? double{velocity_[0].at(i).w} : model_.radius;
    for (std::size_t k = 0; k < all.size(); ++k) {
      const double apart = norm(period_.apart(all[k].position, place).as<double>()) * scale_.unit;
      const double miss = std::fabs(own + radiusOf(entering[k]) - apart - insertionOverlap.overlap);
      if (miss < nearest) nearest = miss, insertionOverlap.entering = k;
    }
  }
  comm_.maximum(found, 3);
  insertionOverlap.position = {found[0], found[1], found[2]};
  std::uint64_t which = nearest < 1e300 ? insertionOverlap.entering : kNobody;
  comm_.minimum(&which, 1);
  insertionOverlap.entering = which;
  return insertionOverlap;
}

} // namespace grouser::terrain
