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
  double porosity{0.4}; ///< expected of the settled bed [-], in [0.2, 0.7]
  FloorShape floor{FloorShape::follow};
  bool roughFloor{};              ///< whether fixed grains lie on it
  std::array<bool, 2> periodic{}; ///< along x, y: no walls
  std::uint64_t seed{1};
};

/// Plans a bed whose settled surface (terrain::BedSurface) comes close to `surface`, if it settles to the porosity that
/// is expected: within half a mean radius in trial beds of 8 and 14 diameters. Since its surface is uneven and its
/// floor a wall, a bed is 1.15 mean radii higher than its grains would fill, on a rough floor 1.5. InputError: an
/// option out of its range.
BedPlan planBed(const HeightField& surface, const RandomBedOptions& options);

/// The largest radius that a bed may have [m]: of the coarsest grains at the greatest depth.
double largestRadius(const RandomBedOptions& options);

/// Lays the grains of `planBed(surface, options)` around `there`, whose grains keep their places, and returns those
/// laid.
///
/// Random sequential insertion, from below: each grain, of a random radius, comes to the first of its random places
/// where it touches no other, in a column that is as much higher than the bed as a solid fraction of 0.28 needs. Its
/// height is random too, within four radii of where its share of the column is, so that coarse grains of a graded bed
/// begin below the fine ones. None touches floor or walls. The places follow from seed and number of the grain.
/// O(grains).
std::vector<Seed> layGrains(const HeightField& surface, const RandomBedOptions& options,
                            const std::vector<Seed>& there = {});

} // namespace grouser::terrain
