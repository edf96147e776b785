// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/virtual_tests/soil_bed.hpp"
#include "terrain/radius_distribution.hpp"

#include <functional>

/// Beds for plates. They are rained in lifts, so that the packing near the surface does not depend on the bed depth.
/// In graded beds, the grain size increases with depth.
namespace grouser::virtual_tests {

/// Floor of a bed.
enum class BedFloor {
  fixed, ///< fixed grains
  rough, ///< a plane with a friction coefficient of 2
  plane  ///< a plane with the friction of the grains, on which the grains can roll
};

struct BedPreparation {
  BedSize size;
  BedFloor floor = BedFloor::fixed;
  bool lattice = false; ///< five layers of equal spheres instead of a rained bed
  terrain::DepthGrading grading;
  double lift = 0; ///< [m] thickness of a lift; 0: the whole bed at once
  /// Grain diameter at the floor / grain diameter at the surface [-].
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

/// Settles the bed lift by lift with the soil's preparation friction. `report` receives the progress. Throws
/// SimulationError if the bed does not come to rest.
PreparedBed prepareBed(const Soil& soil, const BedPreparation& bed, std::int64_t seed,
                       const std::filesystem::path& folder, const base::Exec& exec,
                       const std::function<void(const std::string&)>& report);

/// Reads the bed from bed.txt in `folder`, or prepares it and stores it there. Both return bitwise the same grains.
PreparedBed keptBed(const Soil& soil, const BedPreparation& bed, std::int64_t seed, const std::filesystem::path& folder,
                    const base::Exec& exec, const std::function<void(const std::string&)>& report);

} // namespace grouser::virtual_tests
