// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "coupling/fluid_domain_setup.hpp"
#include "coupling/ground_setup.hpp"
#include "coupling/mechanism_setup.hpp"
#include "coupling/vehicle_setup.hpp"

#include <optional>

namespace grouser::coupling {

/// Validated setup of a simulation with all derived laws, as plain typed values.
struct SimulationSetup {
  double timeStep{};   ///< [s]
  base::Vec3d gravity; ///< [m/s2]
  GroundSetup ground;
  std::optional<VehicleSetup> vehicle;
  std::optional<MechanismSetup> mechanism;
  std::optional<FluidDomainSetup> fluid;

  bool crushes() const {
    return ground.grains && ground.grains->partLaws.crush();
  } ///< true if grains crush against parts
};

} // namespace grouser::coupling
