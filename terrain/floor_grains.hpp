// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "terrain/bed_plan.hpp"
#include "terrain/radius_distribution.hpp"

namespace grouser::terrain {

/// Fixed grains that make a floor rough: a bed on a smooth floor rolls on it as on a ball bearing.
struct FloorGrainOptions {
  RadiusDistribution radii;       ///< as of the grains of the bed
  double scale{1};                ///< factor on the radii (DepthGrading)
  std::array<bool, 2> periodic{}; ///< along x, y
  std::uint64_t seed{1};
};

/// Grains with centres on the floor or up to half a radius below it, on a square lattice of two mean radii, shifted at
/// random by up to 0.3 of that along x and y. They may overlap each other; a grain that lies among them meets the
/// floor between them too. Within `walls`.
std::vector<Seed> layFloorGrains(const HeightField& floor, const Rectangle& walls, const FloorGrainOptions& options);

/// Number of these grains.
std::int64_t floorGrainCount(const Rectangle& walls, const FloorGrainOptions& options);

} // namespace grouser::terrain
