// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/scene/scene.hpp"

namespace grouser::sweeps {

/// Throws InputError if a run of this scene would fail before its first step: reads height-map and vehicle spec, lays
/// out bed and parts, chooses the step, builds the mechanism. Settles nothing. Unless `sizes` is false, first checks
/// that the grains fit the memory of this machine, as their number is the cause of errors that follow.
void checkScene(const scene::Scene& scene, bool sizes = true);

} // namespace grouser::sweeps
