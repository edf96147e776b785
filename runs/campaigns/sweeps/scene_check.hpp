// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/scene/scene.hpp"

namespace grouser::sweeps {

/// Throws InputError where a run of this scene would be refused before its first step: reads height-map and vehicle
/// spec, lays out bed and parts, chooses the step, builds the mechanism. Settles nothing. First of all, unless `sizes`
/// is false, whether its grains would fit into the memory of this machine: what is wrong with scenes of too many small
/// grains is their number, not the step that follows from it.
void checkScene(const scene::Scene& scene, bool sizes = true);

} // namespace grouser::sweeps
