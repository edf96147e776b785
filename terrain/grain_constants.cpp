// SPDX-License-Identifier: BSD-3-Clause
#include "terrain/grain_constants.hpp"

#include "base/error.hpp"
#include "base/rounded.hpp"
#include "terrain/feet_search.hpp"
#include "terrain/searched_height_field.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace grouser::terrain {

std::vector<contact::ContactLaw> boundaryLaws(const GrainModel& model, const Boundaries& boundaries) {
  if (model.materials.count() > 0) return model.materials.boundaries;
  std::vector<contact::ContactLaw> laws;
  for (const Wall& wall : boundaries.walls) laws.push_back(wall.law);
  if (boundaries.floor) laws.push_back(model.floorLaw);
  for (const RigidSurface& surface : boundaries.surfaces) laws.push_back(surface.law);
  return laws;
}

unsigned featuresOf(const GrainModel& model, const Boundaries& boundaries, bool manyRadii) {
  std::vector<contact::ContactLaw> laws = boundaryLaws(model, boundaries);
  if (model.materials.count() > 0)
    laws.insert(laws.end(), model.materials.grains.begin(), model.materials.grains.end());
  else
    laws.push_back(model.law);
  unsigned features = 0;
  bool linear = false;
  for (const contact::ContactLaw& law : laws) features |= law.features(), linear = linear || !law.hertz;
  if (linear && features & contact::kHertz) features |= contact::kGeneral; // selected per contact at run time
  if (manyRadii) features |= kManyRadii;
  if (model.materials.count() > 0) features |= kManyMaterials;
  if (!boundaries.walls.empty() || boundaries.floor) features |= kBoundaries;
  if (boundaries.floor) features |= kFloor;
  if (boundaries.periodic[0] || boundaries.periodic[1]) features |= kPeriodic;
  if (!boundaries.surfaces.empty()) features |= kBoundaries | kSurfaces;
  if (model.ledger) features |= kLedger;
  if (model.fixedGrains) features |= kFixed;
  return features;
}

int Boundaries::floorPlaces(double radius) const {
  return !floor ? 0 : SearchedHeightField::hasHollows(*floor, radius) ? Feet::kMax : 1;
}

GrainLayout layoutOf(unsigned features, int boundaries, std::size_t materials, int floorPlaces) {
  const auto has = [&](unsigned feature) -> std::int64_t { return (features & feature) != 0; };
  const int springs = contact::plasticPlace(features);
  return {has(kLedger),
          boundaries,
          springs > 0,
          springs > 3,
          has(kManyRadii),
          static_cast<std::int64_t>(materials),
          has(kPeriodic),
          has(kFixed),
          has(contact::kPlastic),
          springs > 0 && floorPlaces > 1 ? floorPlaces : 0};
}

namespace {

double smallestOf(const GrainModel& model, const std::vector<GrainSpec>& start) {
  double least = model.smallestRadius > 0 ? model.smallestRadius : model.radius;
  for (const GrainSpec& g : start) least = g.radius > 0 ? std::min(least, g.radius) : least;
  return least;
}

GrainModel withFixedGrains(GrainModel model, const std::vector<GrainSpec>& start) {
  const bool fixed = std::any_of(start.begin(), start.end(), [](const GrainSpec& g) { return g.fixed; });
  model.fixedGrains = model.fixedGrains || fixed;
  return model;
}

/// Nearest radius [m] that is both a float and a whole number of units.
float nearestStored(double radius, const base::PositionScale& scale) {
  const auto nearest = static_cast<float>(radius);
  return static_cast<float>(std::floor(static_cast<double>(nearest) * scale.perMetre + 0.5) * scale.unit);
}

/// Periodic boundaries in whole units. A grain must not touch two images of another: at least three search cells must
/// fit in between.
base::Period periodOf(const Boundaries& boundaries, const base::PositionScale& scale, std::int64_t reach) {
  base::Period period;
  for (int a = 0; a < 2; ++a) {
    const auto& sides = boundaries.periodic[static_cast<std::size_t>(a)];
    if (!sides) continue;
    const auto [from, to] = *sides;
    if (!(std::fabs(from) < scale.limit() && std::fabs(to) < scale.limit()))
      throw base::InputError(
          fmt::format("periodic boundaries {} = {:g} m and {:g} m are more than {:.6g} m from the origin", "xy"[a],
                      from, to, scale.limit()));
    period.low[a] = scale.inUnits(from), period.length[a] = scale.inUnits(to) - period.low[a];
    if (period.length[a] < 3 * reach)
      throw base::InputError(
          fmt::format("periodic boundaries {} = {:g} m and {:g} m are too close: a grain could touch another from "
                      "both sides; set them at least {} m apart (three diameters plus skins)",
                      "xy"[a], from, to, base::roundedUp(static_cast<double>(3 * reach) * scale.unit, 6)));
  }
  return period;
}

} // namespace

GrainConstants::GrainConstants(const GrainModel& grainModel, const Boundaries& boundaries,
                               const std::vector<GrainSpec>& start)
    : model(withFixedGrains(grainModel, start)), scale(base::positionScale(2 * model.radius)),
      smallestRadius(smallestOf(model, start)), diameterUnits(scale.inUnits(2 * model.radius)),
      marginUnits(model.complementarity ? scale.inUnits(margin()) : 0),
      skinUnits(scale.inUnits(model.skin * smallestRadius) + marginUnits),
      features(featuresOf(model, boundaries, smallestRadius != model.radius || model.materials.count() > 0)),
      historyWidth(contact::historyWidth(features)), wallCount(static_cast<int>(boundaries.walls.size())),
      floorPlaces(boundaries.floorPlaces(model.radius)), boundaryCount(boundaries.count(model.radius)),
      period(periodOf(boundaries, scale, listRange())) {
  // Overlaps are whole units: a grain a thousand times smaller than the largest resolves only 1e-5 of its size.
  if (smallestRadius < 1e-3 * model.radius)
    throw base::InputError(
        fmt::format("radii from {:g} m to {:g} m in one scene; the largest may be at most 1000 times "
                    "the smallest",
                    smallestRadius, model.radius));
  if (boundaryCount > 32)
    throw base::InputError(fmt::format(
        "{} planes and other surfaces, including the floor{}; at most 32 are supported", boundaryCount,
        floorPlaces > 1 ? fmt::format(" (counts as {}: its hollows are tighter than the grains)", floorPlaces) : ""));
}

float GrainConstants::storedRadius(const GrainSpec& grain) const {
  return storedRadius(manyRadii() ? nearestStored(grain.radius > 0 ? grain.radius : model.radius, scale) : 0.0f,
                      grain.fixed);
}

float GrainConstants::storedRadius(float radius, bool fixed) const {
  return !fixed ? radius : manyRadii() ? -radius : -1.0f;
}

} // namespace grouser::terrain
