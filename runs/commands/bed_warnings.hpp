// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "coupling/simulation.hpp"
#include "runs/scene/scene.hpp"

#include <cstdint>
#include <string>
#include <vector>

/// Warnings about beds that are looser than any random packing of spheres, or thinner than one layer.
namespace grouser::commands {

struct BedQuality {
  std::int64_t grains = 0, fixed = 0; ///< number of all grains of the bed, and of its fixed grains
  std::int64_t measured = 0;          ///< grains in the porosity measurement; 0: porosity unknown
  double porosity = 0, porosityError = 0;
  bool rollingFriction = false, cohesion = false;
  double cover = 1; ///< share of the floor that the loose grains cover side by side [-]
};

/// One warning for each limit of terrain/packing_limits.hpp that the bed exceeds.
std::vector<std::string> bedWarnings(const BedQuality& bed);

/// Warnings about the settled bed of a run; empty without a bed.
std::vector<std::string> bedWarnings(const scene::Scene& scene, const coupling::Simulation& simulation);

/// Warnings about the planned bed of a scene.
std::vector<std::string> plannedBedWarnings(const scene::Scene& scene);

} // namespace grouser::commands
