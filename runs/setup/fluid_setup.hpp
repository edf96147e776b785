// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "coupling/fluid_domain_setup.hpp"

#include <optional>
#include <string>

namespace grouser::scene {
struct Scene;
} // namespace grouser::scene

namespace grouser::setup {

/// Inner faces of the tank of a scene's fluid [m].
struct FluidTank {
  base::Vec3d low, high;
};

/// Fluid model of a scene with [fluid], without a time step; the sound speed is as given, or follows from depth and
/// flow speed. Throws InputError for a sound speed that is too low.
fluid::FluidModel fluidModel(const scene::Scene& scene);

/// Limits of its time step [s].
fluid::StepLimits fluidStepLimits(const scene::Scene& scene);

FluidTank fluidTank(const scene::Scene& scene);

/// Particles, markers of walls and bodies, and probes; empty without [fluid]. Throws InputError if there are no
/// particles, or a body is thinner than the spacing.
std::optional<coupling::FluidDomainSetup> fluidSetup(const scene::Scene& scene, double timeStep);

} // namespace grouser::setup
