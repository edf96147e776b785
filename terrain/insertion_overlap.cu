// SPDX-License-Identifier: BSD-3-Clause
// Overlaps of entering grains with existing ones.
#include "base/for_each.cuh"
#include "terrain/grain_entry.hpp"
#include "terrain/grain_system.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace grouser::terrain {

using base::Vec3d;
using base::Vec3l;

namespace {

constexpr std::uint64_t kMaxUnits = 0xFFFFFFFFull;

struct Entering {
  base::Position position;
  double radius; ///< [units]
};

/// Finds the grain with the deepest overlap with the entering grains.
struct FindInsertionOverlap {
  static constexpr double kNanoseconds = 50;
  const base::Position* position;
  const Motion* motion;
  const std::uint32_t *id, *ghost;
  base::Period period;
  const Entering* entering;
  std::int64_t count;
  base::Position centre;         ///< centre of the box around all entering grains
  Vec3d reach;                   ///< maximum distance from `centre` of grains that may touch one of them [units]
  double radius;                 ///< radius of all grains [units]; 0: each has its own
  double unitsPerMetre, allowed; ///< maximum allowed overlap / smaller radius [-]
  std::uint64_t*
      deepest; ///< kMaxUnits minus the overlap, then the id: the minimum has the deepest overlap, then the lowest id

  GROUSER_HD void operator()(int i) const {
    if (ghost && ghost[i]) return;
    const Vec3d fromCentre = period.apart(centre, position[i]).as<double>();
    for (int a = 0; a < 3; ++a)
      if (fabs(fromCentre[a]) > reach[a]) return;
    const double own = radius > 0 ? radius : fabs(static_cast<double>(motion[i].velocity.w)) * unitsPerMetre;
    for (std::int64_t k = 0; k < count; ++k) {
      const double overlap =
          own + entering[k].radius - norm(period.apart(entering[k].position, position[i]).as<double>());
      const double smaller = own < entering[k].radius ? own : entering[k].radius;
      if (!(overlap > allowed * smaller)) continue;
      const auto units = static_cast<std::uint64_t>(overlap); // at most two radii, 2e8
      base::atomicMin64(deepest, (kMaxUnits - units) << 32 | id[i]);
    }
  }
};

double radiusOf(const GrainSpec& grain, const GrainConstants& c) {
  return grain.radius > 0 ? grain.radius : c.model.radius;
}

std::optional<InsertionOverlap> overlapWithSurface(const std::vector<GrainSpec>& entering, const GrainSystem& system) {
  for (std::size_t k = 0; k < entering.size(); ++k) {
    const double radius = radiusOf(entering[k], system.constants);
    const double allowed = system.constants.model.maxEntryOverlap * radius;
    if (const auto overlap = system.boundaries.overlapOf(entering[k].position, radius, allowed))
      return InsertionOverlap{k, overlap->depth, {}, {}, overlap->surface};
  }
  return {};
}

constexpr std::uint64_t kNobody = std::numeric_limits<std::uint64_t>::max();

/// Key of the deepest overlap of FindInsertionOverlap; kNobody if no overlap is too deep. Equal on all ranks.
std::uint64_t deepestOverlap(const std::vector<GrainSpec>& entering, const std::vector<Entering>& all,
                             const GrainSystem& system) {
  const GrainConstants& c = system.constants;
  const base::PositionScale& scale = c.scale;
  Vec3d low = entering.front().position, high = low;
  double largest = 0;
  for (const GrainSpec& g : entering) {
    low = base::min(low, g.position), high = base::max(high, g.position);
    largest = std::max(largest, radiusOf(g, c));
  }
  const double beyond = largest + c.model.radius;
  const Vec3d reach = (high - low) * 0.5 + Vec3d{beyond, beyond, beyond};
  base::Array<Entering> device(system.exec, all);
  base::Array<std::uint64_t> deepest(system.exec, std::vector<std::uint64_t>{kNobody});
  const GrainFields& f = system.arrays.fields();
  base::forEach(system.exec, "find room", static_cast<std::int64_t>(system.arrays.slots()),
                FindInsertionOverlap{f.position.now.data(), f.motion.now.data(), f.id.now.data(), system.ghosts(),
                                     c.period, device.data(), static_cast<std::int64_t>(all.size()),
                                     scale.fromMetres((low + high) * 0.5), reach * scale.perMetre * (1 + 1e-6),
                                     c.manyRadii() ? 0.0 : c.model.radius * scale.perMetre, scale.perMetre,
                                     c.model.maxEntryOverlap, deepest.data()});
  std::uint64_t key = deepest.toHost().front();
  system.comm.minimum(&key, 1);
  return key;
}

/// Sets the position of the other grain, and the entering grain with that overlap.
void describeOverlap(const std::vector<GrainSpec>& entering, const std::vector<Entering>& all,
                     const GrainSystem& system, InsertionOverlap& overlap) {
  const GrainConstants& c = system.constants;
  const GrainFields& f = system.arrays.fields();
  // Only the owner of the other grain sets its position; the maximum over the ranks distributes it.
  const std::vector<std::uint32_t> id = f.id.now.toHost(), ghost = system.ghostsOnHost();
  double found[] = {-1e300, -1e300, -1e300};
  double nearest = 1e300; // minimum difference from the reported overlap [m]
  for (std::size_t i = 0; i < id.size(); ++i) {
    if (id[i] != *overlap.grain || ghost[i]) continue;
    const base::Position place = f.position.now.at(i);
    const Vec3d x = c.scale.toMetres(place);
    found[0] = x.x, found[1] = x.y, found[2] = x.z;
    const double own = c.manyRadii() ? std::fabs(double{f.motion.now.at(i).velocity.w}) : c.model.radius;
    for (std::size_t k = 0; k < all.size(); ++k) {
      const double apart = norm(c.period.apart(all[k].position, place).as<double>()) * c.scale.unit;
      const double miss = std::fabs(own + radiusOf(entering[k], c) - apart - overlap.overlap);
      if (miss < nearest) nearest = miss, overlap.entering = k;
    }
  }
  system.comm.maximum(found, 3);
  overlap.position = {found[0], found[1], found[2]};
  std::uint64_t which = nearest < 1e300 ? overlap.entering : kNobody;
  system.comm.minimum(&which, 1);
  overlap.entering = which;
}

} // namespace

std::optional<InsertionOverlap> insertionOverlapOf(const std::vector<GrainSpec>& entering, const GrainSystem& system) {
  if (entering.empty()) return {};
  if (const auto overlap = overlapWithSurface(entering, system)) return overlap;
  const GrainConstants& c = system.constants;
  std::vector<Entering> all;
  for (const GrainSpec& g : entering)
    all.push_back({c.scale.fromMetres(g.position), radiusOf(g, c) * c.scale.perMetre});
  const std::uint64_t key = deepestOverlap(entering, all, system);
  if (key == kNobody) return {};
  InsertionOverlap overlap;
  overlap.overlap = static_cast<double>(kMaxUnits - (key >> 32)) * c.scale.unit;
  overlap.grain = static_cast<std::uint32_t>(key);
  describeOverlap(entering, all, system, overlap);
  return overlap;
}

} // namespace grouser::terrain
