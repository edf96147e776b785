// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/virtual_tests/soil_bed.hpp"
#include "terrain/radius_distribution.hpp"

#include <functional>

/// Beds for plates: rained in lifts, so that the packing near the surface does not depend on depth, and graded by
/// depth.
namespace grouser::virtual_tests {

/// Floor of a bed.
enum class BedFloor {
  fixed, ///< grains that never move
  rough, ///< a plane with a friction of 2
  plane  ///< a plane with the friction of the grains, on which they roll
};

struct BedPreparation {
  BedSize size;
  BedFloor floor = BedFloor::fixed;
  bool lattice = false; ///< equal spheres in five layers instead of rain
  terrain::DepthGrading grading;
  double lift = 0; ///< [m] thickness of a lift; 0: the whole bed at once
  /// Grain diameter at the floor over that at the surface [-].
  double coarsest(const Soil& soil) const;
};

/// A bed at rest, without the grains of its floor.
struct PreparedBed {
  BedGrains grains;
  std::int64_t steps = 0; ///< steps of its preparation
  double seconds = 0;     ///< wall time
};

/// Scene sections of the floor of a bed, at about z = 0.
std::string floorSections(const Soil& soil, const BedPreparation& bed, std::int64_t seed);

/// Upper ends of the lifts of a bed [m], lowest first.
std::vector<double> liftTops(const BedPreparation& bed);

/// Settles the bed lift by lift with the soil's preparation friction. `tell` receives the progress. Throws
/// SimulationError if it does not come to rest.
PreparedBed prepareBed(const Soil& soil, const BedPreparation& bed, std::int64_t seed,
                       const std::filesystem::path& folder, const base::Exec& exec,
                       const std::function<void(const std::string&)>& tell);

/// The same, read from bed.txt in `folder` if it exists, else stored there. Bitwise the same grains either way.
PreparedBed keptBed(const Soil& soil, const BedPreparation& bed, std::int64_t seed, const std::filesystem::path& folder,
                    const base::Exec& exec, const std::function<void(const std::string&)>& tell);

} // namespace grouser::virtual_tests
