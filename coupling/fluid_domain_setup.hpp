// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "fluid/fluid_setup.hpp"
#include "fluid/fluid_state.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace grouser::coupling {

/// A body of the model in the fluid.
struct BodyInFluid {
  std::size_t body{};               ///< index into the model's bodies
  std::vector<base::Vec3d> markers; ///< in the body's frame [m]
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
  double top{}; ///< upper end of the lines of level probes [m]
};

/// Fluid of a saved simulation: the state of the particles, and the accelerations that wall pressures are extrapolated
/// with, six numbers a body [m/s2, rad/s2].
struct FluidDomainState {
  fluid::FluidState fluid;
  std::vector<double> accelerations;
};

} // namespace grouser::coupling
