// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "contact/subdomain.hpp"
#include "fluid/fluid_setup.hpp"
#include "fluid/fluid_state.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace grouser::coupling {

/// Body of the model in the fluid.
struct BodyInFluid {
  std::size_t body{};               ///< index into the model's bodies
  std::size_t about{};              ///< body with the reference point of its torque, the centre of mass
  std::string column;               ///< output column, which sums the loads of its bodies
  std::vector<base::Vec3d> markers; ///< positions in the body frame [m]
  bool touches{};                   ///< see FluidBody
  double gain{};                    ///< upper bound of ghost inertia / mass or inertia [-]
};

/// Location where pressure or level is recorded.
struct FluidProbePoint {
  std::string name;
  bool level{};         ///< true: height of the surface above the point; false: pressure at the point
  base::Vec3d position; ///< [m]
};

/// Fluid of a scene.
struct FluidDomainSetup {
  fluid::FluidSetup fluid; ///< without bodies
  std::vector<BodyInFluid> bodies;
  std::vector<FluidProbePoint> probes;
  contact::PartitionOptions partition; ///< without communicator
  int stepsPerStep = 1;                ///< simulation steps per fluid step; the loads are constant over them
  double top{};                        ///< upper end of the lines of level probes [m]
  std::optional<base::Pose>
      chassis; ///< pose of the vehicle at the creation of particles and markers; empty without a vehicle
};

/// Fluid of a saved simulation.
struct FluidDomainState {
  fluid::FluidState fluid;
  /// 18 numbers per body: acceleration for the extrapolation of wall pressures, velocity at the last fluid step, and
  /// sum of the velocities since then, each linear and angular [m/s2, rad/s2, m/s, rad/s].
  std::vector<double> bodies;
  std::int64_t waited{}; ///< simulation steps since the last fluid step
};

} // namespace grouser::coupling
