// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "terrain/height_field.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace grouser::terrain {

/// Initial grain; its id is its index in the list.
struct Seed {
  Vec3d centre;    ///< [m]
  double radius{}; ///< [m]
  bool fixed{};    ///< true: never moves
};

/// Shape of the floor under the grains.
enum class FloorShape {
  follow, ///< the height map's surface, lowered by the thickness of the settled bed: a bed of uniform thickness
  flat    ///< level, one bed thickness below the height-map's lowest point; hills are filled with more layers
};

/// Dimensions and size of a bed before its grains are placed.
struct BedPlan {
  Rectangle walls;       ///< inner faces [m]
  HeightField floor;     ///< rigid surface below the grains
  int layers{};          ///< full layers (with a flat floor: maximum over the bed); 0 for a random bed
  double thickness{};    ///< expected thickness of the settled bed [m] (with a flat floor: at the lowest point)
  double fall{};         ///< height of the loose bed above the settled bed [m]
  std::int64_t grains{}; ///< number of grains; exact in layers, within a few per mille in random beds
};

/// Lowest height [m], at least `z`, of a sphere of `radius` above (x, y) that does not touch the floor.
double clearHeight(const HeightField& floor, double x, double y, double z, double radius);

/// Throws InputError "bed of grains: key = value is outside range" unless `ok`.
void requireOfBed(bool ok, const char* key, double value, const char* range);

} // namespace grouser::terrain
