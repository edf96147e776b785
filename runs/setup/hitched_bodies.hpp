// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "multibody/model.hpp"
#include "vehicle/assembly.hpp"

#include <optional>
#include <vector>

namespace grouser::scene {
struct Scene;
}

namespace grouser::setup {

/// The scene's vehicle on level ground of height 0, relative to which bodies and joints are placed; empty in scenes
/// without a vehicle or without bodies.
std::optional<vehicle::Assembly> vehicleOf(const scene::Scene& scene);

/// [body of `model`] whether joints, springs or bushings connect it to the vehicle, also through other bodies; `model`
/// begins with the parts of `vehicle`. Throws InputError where a joint connects such a body, and so the vehicle, to the
/// world or to a fixed body.
std::vector<bool> hitchedBodies(const scene::Scene& scene, const multibody::Model& model,
                                const vehicle::Assembly& vehicle);

} // namespace grouser::setup
