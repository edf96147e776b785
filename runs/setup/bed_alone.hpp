// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/scene/scene.hpp"

#include <string>

/// Beds that settle before anything is placed on them.
namespace grouser::setup {

/// Returns true if grains, meshes or surfaces are placed on the settled bed.
bool isPutOnBed(const scene::Scene& scene);

/// The scene reduced to its bed: terrain and surfaces placed before settling. The bed of the full scene settles bitwise
/// identically to the bed of this scene, with the time step of this scene.
scene::Scene sceneOfBed(scene::Scene scene);

/// bedOrigin() of the bed that a run of this scene settles and caches; empty if the run settles or caches no bed.
/// Throws InputError if the height-map cannot be read.
std::string originOfBed(const scene::Scene& scene);

} // namespace grouser::setup
