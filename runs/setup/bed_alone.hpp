// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/scene/scene.hpp"

#include <string>

/// Beds that settle before anything is placed on them.
namespace grouser::setup {

/// Returns true if grains, meshes or surfaces are placed on the settled bed.
bool isPutOnBed(const scene::Scene& scene);

/// The scene reduced to its bed: terrain and surfaces in it from the start, without anything placed later. The bed
/// settles bit by bit as in a scene with only these, and with the time step of that scene.
scene::Scene sceneOfBed(scene::Scene scene);

/// bedOrigin() of the bed that a run of this scene settles and stores; empty if it settles or stores none. Throws
/// InputError if its height-map cannot be read.
std::string originOfBed(const scene::Scene& scene);

} // namespace grouser::setup
