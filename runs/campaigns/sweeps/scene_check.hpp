// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/scene/scene.hpp"

namespace grouser::sweeps {

/// Throws InputError if a run of this scene would fail before its first step: reads height-map and vehicle file, lays
/// out bed and parts, chooses the step, and builds the mechanism. Does not settle the bed. If `sizes`, first checks
/// that the grains fit into the memory of this machine, because too many grains would cause other errors later.
void checkScene(const scene::Scene& scene, bool sizes = true);

} // namespace grouser::sweeps
