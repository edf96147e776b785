// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/period.hpp"
#include "terrain/grain_setup.hpp"
#include "terrain/grain_state.hpp"

#include <algorithm>

namespace grouser::terrain {

/// Features of the grain step: those of the laws, the boundaries and, with `manyRadii`, unequal grains; kLoads is not
/// set. The positions of the boundaries do not matter.
unsigned featuresOf(const GrainModel& model, const Boundaries& boundaries, bool manyRadii);
/// Returns the fields of grains with these features. `materials`: GrainMaterials::count().
GrainLayout layoutOf(unsigned features, int boundaries, std::size_t materials, int floorPlaces = 1);

/// Constants of a scene's grains, identical on all ranks.
struct GrainConstants {
  /// Throws InputError if radii differ by more than a factor of 1000, there are more than 32 boundaries, or periodic
  /// boundaries are too close together or too far apart.
  GrainConstants(const GrainModel& model, const Boundaries& boundaries, const std::vector<GrainSpec>& start);

  GrainModel model;
  base::PositionScale scale;
  double smallestRadius;      ///< smallest radius in the scene [m]
  std::int64_t diameterUnits; ///< diameter of the largest grain [units]
  std::int64_t marginUnits;   ///< complementarity: maximum gap of a pair in the problem of a step [units]; else 0
  std::int64_t skinUnits;     ///< skin of the neighbour list, plus the margin [units]
  unsigned features;          ///< see featuresOf()
  int historyWidth;           ///< history values per contact: 0, 3 (spring), 6 (spring, rolling angle)
  int wallCount;              ///< planes
  int floorPlaces;            ///< maximum number of floor contacts of a grain
  int boundaryCount;          ///< total number of planes, floor contacts and surfaces
  base::Period period;        ///< periodic boundaries

  bool has(unsigned feature) const { return (features & feature) != 0; }
  GrainLayout layout() const { return layoutOf(features, boundaryCount, model.materials.count(), floorPlaces); }
  /// Values per grain near boundaries in GrainBoundaries::springs().
  std::size_t springsWidth() const {
    const auto normals = static_cast<std::size_t>(3 * layout().places);
    return static_cast<std::size_t>(boundaryCount) * static_cast<std::size_t>(historyWidth) + normals;
  }
  bool manyRadii() const { return has(kManyRadii); }
  /// Distance beyond which two grains cannot touch before the next neighbour list is built [units].
  std::int64_t listRange() const { return diameterUnits + skinUnits; }
  /// Maximum squared displacement of a grain since the list was built [units^2]: half the skin without the margin.
  std::int64_t halfSkinUnits2() const {
    const std::int64_t half = (skinUnits - marginUnits) / 2;
    return half * half;
  }
  /// Complementarity: maximum gap of a pair at rest in the problem of a step [m].
  double minMargin() const { return minMargin(smallestRadius, model.complementarity->reach); }
  static double minMargin(double smallestRadius, double reach) { return std::min(kMinMargin * smallestRadius, reach); }
  /// Maximum gap of any pair [m]: includes the distance that both grains travel in a step, at up to kFastImpacts times
  /// `reach`, see contact::ComplementarityOptions.
  double margin() const { return margin(smallestRadius, model.complementarity->reach); }
  static double margin(double smallestRadius, double reach) {
    return minMargin(smallestRadius, reach) +
           std::min(2 * GrainModel::kMaxWaySolved * smallestRadius, kFastImpacts * reach);
  }
  static constexpr double kMinMargin = 0.2; ///< [smallest radius]
  static constexpr double kFastImpacts = 4;
  /// Value of velocity.w in the state: grain radius [m], or 0 if all radii are equal; for a fixed grain minus its
  /// radius, or -1.
  float storedRadius(const GrainSpec& grain) const;
  float storedRadius(float radius, bool fixed) const;
};

} // namespace grouser::terrain
