// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/setup/step_modes.hpp"
#include "vehicle/spec.hpp"

namespace grouser::scene {
struct Scene;
}

namespace grouser::setup {

/// Limits of the step by a vehicle's contacts: wheels on shoes, shoes on what is rigid or on soil that deforms.
void considerVehicle(StepLimit& limit, const scene::Scene& scene, const vehicle::VehicleSpec& spec);

} // namespace grouser::setup
