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

/// A body of the model in the fluid.
struct BodyInFluid {
  std::size_t body{};               ///< index into the model's bodies
  std::size_t about{};              ///< body whose centre of mass is the reference point of its torque
  std::string column;               ///< column of the output, which sums the loads of its bodies
  std::vector<base::Vec3d> markers; ///< in the body's frame [m]
  bool touches{};                   ///< see FluidBody
  double gain{};                    ///< upper bound of ghost inertia over mass or inertia [-]
};

/// A place where pressure or level is recorded.
struct FluidProbePoint {
  std::string name;
  bool level{};         ///< height of the surface above the point, instead of the pressure there
  base::Vec3d position; ///< [m]
};

/// The fluid of a scene.
struct FluidDomainSetup {
  fluid::FluidSetup fluid; ///< without bodies
  std::vector<BodyInFluid> bodies;
  std::vector<FluidProbePoint> probes;
  contact::PartitionOptions partition; ///< without communicator
  int stepsPerStep = 1; ///< steps of the simulation in a step of the fluid; the loads hold for all of them
  double top{};         ///< upper end of the lines of level probes [m]
  std::optional<base::Pose>
      chassis; ///< pose of the vehicle that particles and markers were made for; empty without one
};

/// Fluid of a saved simulation.
struct FluidDomainState {
  fluid::FluidState fluid;
  /// 18 numbers a body: acceleration that wall pressures are extrapolated with, velocity at the last step of the fluid,
  /// and the sum of those since, each linear and angular [m/s2, rad/s2, m/s, rad/s].
  std::vector<double> bodies;
  std::int64_t waited{}; ///< steps of the simulation since the last step of the fluid
};

} // namespace grouser::coupling
