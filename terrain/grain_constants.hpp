// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/period.hpp"
#include "terrain/grain_setup.hpp"
#include "terrain/grain_state.hpp"

#include <algorithm>

namespace grouser::terrain {

/// Features of the grains' step: of the laws, of `boundaries` and, with `manyRadii`, of different grains; without loads
/// of rigid parts. The positions of the boundaries do not matter.
unsigned featuresOf(const GrainModel& model, const Boundaries& boundaries, bool manyRadii);
/// The fields that grains of these features have. `materials`: GrainMaterials::count().
GrainLayout layoutOf(unsigned features, int boundaries, std::size_t materials, int floorPlaces = 1);

/// Constants of a scene's grains; the same on all ranks.
struct GrainConstants {
  /// Throws InputError if radii differ by more than a factor of 1000, there are more than 32 boundaries, or periodic
  /// boundaries are too close to each other or too far away.
  GrainConstants(const GrainModel& model, const Boundaries& boundaries, const std::vector<GrainSpec>& start);

  GrainModel model;
  base::PositionScale scale;
  double smallestRadius;      ///< of the scene [m]
  std::int64_t diameterUnits; ///< of the largest grain [units]
  std::int64_t marginUnits;   ///< complementarity: largest gap of a pair in the problem of a step [units]; else 0
  std::int64_t skinUnits;     ///< of the neighbour list, with the margin [units]
  unsigned features;          ///< see featuresOf()
  int historyWidth;           ///< numbers of history of a contact: 0, 3 (spring), 6 (spring, rolling angle)
  int wallCount;              ///< planes
  int floorPlaces;            ///< contacts that a grain may have with the floor
  int boundaryCount;          ///< planes, places of the floor and surfaces together
  base::Period period;        ///< of periodic boundaries

  bool has(unsigned feature) const { return (features & feature) != 0; }
  GrainLayout layout() const { return layoutOf(features, boundaryCount, model.materials.count(), floorPlaces); }
  /// Numbers that a grain near boundaries has in GrainBoundaries::springs().
  std::size_t springsWidth() const {
    const auto normals = static_cast<std::size_t>(3 * layout().places);
    return static_cast<std::size_t>(boundaryCount) * static_cast<std::size_t>(historyWidth) + normals;
  }
  bool manyRadii() const { return has(kManyRadii); }
  /// Two grains farther apart than this never touch before the neighbour list is built anew [units].
  std::int64_t listRange() const { return diameterUnits + skinUnits; }
  /// Largest displacement of a grain since the list was made, squared [units^2]: half the skin without the margin.
  std::int64_t halfSkinUnits2() const {
    const std::int64_t half = (skinUnits - marginUnits) / 2;
    return half * half;
  }
  /// Complementarity: largest gap of a pair at rest in the problem of a step [m].
  double leastMargin() const { return std::min(kLeastMargin * smallestRadius, model.complementarity->reach); }
  /// Largest gap of any pair [m]: adds the distance that both grains move in a step, at up to kFastImpacts times
  /// `reach`.
  double margin() const {
    return leastMargin() +
           std::min(2 * GrainModel::kMostWaySolved * smallestRadius, kFastImpacts * model.complementarity->reach);
  }
  static constexpr double kLeastMargin = 0.2; ///< [smallest radius]
  static constexpr double kFastImpacts = 4;
  /// Value of velocity.w in the state: the grain's radius [m], or 0 if all radii are equal; for a fixed grain minus its
  /// radius, or -1.
  float storedRadius(const GrainSpec& grain) const;
  float storedRadius(float radius, bool fixed) const;
};

} // namespace grouser::terrain
