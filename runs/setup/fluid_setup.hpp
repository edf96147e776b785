// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "coupling/fluid_domain_setup.hpp"

#include <optional>
#include <string>

namespace grouser::scene {
struct Scene;
} // namespace grouser::scene

namespace grouser::setup {

/// Tank of a scene's fluid: inner faces as the scene has them [m].
struct FluidTank {
  base::Vec3d low, high;
};

/// Model of the fluid of a scene with [fluid], with the given sound speed or that from depth and speed; without a time
/// step. Throws InputError for a sound speed that is too low.
fluid::FluidModel fluidModel(const scene::Scene& scene);

/// Limits of its time step [s].
fluid::StepLimits fluidStepLimits(const scene::Scene& scene);

FluidTank fluidTank(const scene::Scene& scene);

/// Particles, markers of walls and bodies, and probes; empty without [fluid]. Throws InputError if there are no
/// particles, or a body is thinner than the spacing.
std::optional<coupling::FluidDomainSetup> fluidSetup(const scene::Scene& scene, double timeStep);

} // namespace grouser::setup
