// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/scene/scene.hpp"

#include <string>

/// Beds that settle before anything is put on them.
namespace grouser::setup {

/// Whether grains, meshes or surfaces of the scene are put on its bed once that has settled.
bool isPutOnBed(const scene::Scene& scene);

/// The scene as if it ended with its bed: terrain, what stands in it from the start, and nothing that comes later. Its
/// bed settles with the bits of a scene that has no more than this, whatever is put on it afterwards, and with the time
/// step of that scene.
scene::Scene sceneOfBed(scene::Scene scene);

/// bedOrigin() of the bed that a run of this scene settles and keeps; empty where it settles none, or keeps none.
/// Throws InputError where its height-map cannot be read.
std::string originOfBed(const scene::Scene& scene);

} // namespace grouser::setup
