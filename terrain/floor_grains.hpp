// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "terrain/bed_plan.hpp"
#include "terrain/radius_distribution.hpp"

namespace grouser::terrain {

/// Fixed grains that roughen a floor; on a smooth floor a bed would slide and roll as on a ball bearing.
struct FloorGrainOptions {
  RadiusDistribution radii;       ///< same distribution as the grains of the bed
  double scale{1};                ///< factor of the radii (DepthGrading)
  std::array<bool, 2> periodic{}; ///< along x, y
  std::uint64_t seed{1};
};

/// Places fixed grains within `walls`, with centres on the floor or up to half a radius below it, on a square lattice.
/// Its pitch is two mean radii; each grain is shifted randomly by up to 0.3 pitch along x and y. Fixed grains may
/// overlap each other; a grain between them also contacts the floor.
std::vector<Seed> layFloorGrains(const HeightField& floor, const Rectangle& walls, const FloorGrainOptions& options);

/// Returns the number of these grains.
std::int64_t floorGrainCount(const Rectangle& walls, const FloorGrainOptions& options);

} // namespace grouser::terrain
