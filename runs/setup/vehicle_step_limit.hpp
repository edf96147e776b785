// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/setup/step_modes.hpp"
#include "vehicle/spec.hpp"

namespace grouser::scene {
struct Scene;
}

namespace grouser::setup {

/// Adds the step limits of a vehicle's contacts: wheels on shoes, shoes on rigid surfaces or deformable soil.
void considerVehicle(StepLimit& limit, const scene::Scene& scene, const vehicle::VehicleSpec& spec);

} // namespace grouser::setup
