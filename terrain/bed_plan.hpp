// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "terrain/height_field.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace grouser::terrain {

/// One grain before the run. Its id is its place in the list.
struct Seed {
  Vec3d centre;    ///< [m]
  double radius{}; ///< [m]
  bool fixed{};    ///< whether it never moves
};

/// Shape of the floor under the grains.
enum class FloorShape {
  follow, ///< the height-map's surface, lowered by the thickness of the settled bed: a bed of even thickness
  flat    ///< level, one bed thickness below the height-map's lowest point; hills are filled with more layers
};

/// Dimensions and size of a bed before its grains are laid.
struct BedPlan {
  Rectangle walls;       ///< inner faces [m]
  HeightField floor;     ///< the rigid surface the grains are laid on
  int layers{};          ///< full layers (with a flat floor: the most anywhere); 0 of a bed without
  double thickness{};    ///< expected thickness of the settled bed [m] (with a flat floor: at the lowest point)
  double fall{};         ///< height of the loose bed above the settled one [m]
  std::int64_t grains{}; ///< exact in layers; in random beds to some per mille
};

/// Height [m], at least `z`, at which a sphere of `radius` above (x, y) keeps clear of the floor.
double clearHeight(const HeightField& floor, double x, double y, double z, double radius);

/// Throws InputError "bed of grains: key = value is outside range" unless `ok`.
void requireOfBed(bool ok, const char* key, double value, const char* range);

} // namespace grouser::terrain
