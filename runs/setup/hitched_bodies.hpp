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

/// For each body of `model`: true if joints, springs or bushings connect it to the vehicle, directly or through other
/// bodies. `model` begins with the parts of `vehicle`. Throws InputError if a joint connects such a body, and thus the
/// vehicle, to the world or to a fixed body.
std::vector<bool> hitchedBodies(const scene::Scene& scene, const multibody::Model& model,
                                const vehicle::Assembly& vehicle);

} // namespace grouser::setup
