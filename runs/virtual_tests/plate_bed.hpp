// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/virtual_tests/soil_bed.hpp"
#include "terrain/radius_distribution.hpp"

#include <functional>

/// Beds for plates: rained in lifts, so that a bed's depth has no part in how densely its upper part lies, and graded
/// by depth.
namespace grouser::virtual_tests {

/// What a bed stands on.
enum class BedFloor {
  fixed, ///< grains that never move
  rough, ///< a plane with a friction of 2
  plane  ///< a plane with the grains' own friction, on which they roll
};

struct BedPreparation {
  BedSize size;
  BedFloor floor = BedFloor::fixed;
  bool lattice = false; ///< instead of rain: equal spheres laid in five layers
  terrain::DepthGrading grading;
  double lift = 0; ///< [m] thickness of one; 0: the whole bed at once
  /// Diameter over that at the surface of the grains at the floor [-].
  double coarsest(const Soil& soil) const;
};

/// A bed at rest, without the grains of its floor.
struct PreparedBed {
  BedGrains grains;
  std::int64_t steps = 0; ///< that its preparation took
  double seconds = 0;     ///< of wall time
};

/// Sections of a scene that bear a bed; its floor at about z = 0.
std::string floorSections(const Soil& soil, const BedPreparation& bed, std::int64_t seed);

/// Heights [m] at which the lifts of a bed end, the lowest first.
std::vector<double> liftTops(const BedPreparation& bed);

/// Lays the bed and lets it come to rest: with the soil's preparation friction, each lift before the next is rained
/// upon it. `tell` hears about it. Throws SimulationError where it does not come to rest.
PreparedBed prepareBed(const Soil& soil, const BedPreparation& bed, std::int64_t seed,
                       const std::filesystem::path& folder, const base::Exec& exec,
                       const std::function<void(const std::string&)>& tell);

/// The same, taken from bed.txt in `folder` where that is there, and kept there where not. The same grains to the last
/// bit either way.
PreparedBed keptBed(const Soil& soil, const BedPreparation& bed, std::int64_t seed, const std::filesystem::path& folder,
                    const base::Exec& exec, const std::function<void(const std::string&)>& tell);

} // namespace grouser::virtual_tests
