// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "terrain/bed_plan.hpp"
#include "terrain/radius_distribution.hpp"

namespace grouser::terrain {

/// Options of a random bed.
struct RandomBedOptions {
  RadiusDistribution radii;
  DepthGrading grading;
  double depth{};       ///< thickness of the settled bed [m]; with a flat floor: at the lowest point
  double porosity{0.4}; ///< expected porosity of the settled bed [-], in [0.2, 0.7]
  FloorShape floor{FloorShape::follow};
  bool roughFloor{};              ///< true: fixed grains on the floor
  std::array<bool, 2> periodic{}; ///< along x, y: no walls
  std::uint64_t seed{1};
};

/// Plans a bed whose settled surface (terrain::BedSurface) approximates `surface`, if it settles to the expected
/// porosity: within half a mean radius in trial beds of 8 and 14 diameters. Because of its rough surface and the floor,
/// a bed is 1.15 mean radii (rough floor: 1.5) higher than its solid volume implies. Throws InputError if an option is
/// out of range.
BedPlan planBed(const HeightField& surface, const RandomBedOptions& options);

/// Maximum radius of the bed [m]: of the coarsest grains at the maximum depth.
double largestRadius(const RandomBedOptions& options);

/// Places the grains of `planBed(surface, options)` around the existing grains `there`, which do not move, and returns
/// the new grains.
///
/// Random sequential insertion from below: each grain, of random radius, is placed at the first of its random
/// positions without overlap, in a column with the height for a solid fraction of 0.28. The grain's height is also
/// random, within four radii of the grain's share of the column, so that coarse grains of a graded bed start below
/// the fine ones. No grain touches floor or walls. Positions depend only on seed and number of the grain. Cost
/// O(grains).
std::vector<Seed> layGrains(const HeightField& surface, const RandomBedOptions& options,
                            const std::vector<Seed>& there = {});

} // namespace grouser::terrain
