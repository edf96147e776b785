// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/scene/scene.hpp"

namespace grouser::sweeps {

/// Throws InputError where a run of this scene would be refused before its first step: reads height-map and vehicle
/// spec, lays out bed and parts, chooses the step, builds the mechanism. Settles nothing.
void checkScene(const scene::Scene& scene);

} // namespace grouser::sweeps
