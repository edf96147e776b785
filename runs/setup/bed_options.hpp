// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/scene/scene.hpp"
#include "terrain/bed.hpp"
#include "terrain/height_field.hpp"

#include <string>
#include <vector>

namespace grouser::setup {

/// The ground's surface as the height-map says. Throws InputError where that cannot be read.
terrain::HeightField readSurface(const scene::Scene& scene);

/// Notes on a valid height-map that may surprise: colour, transparent pixels.
std::vector<std::string> terrainNotes(const scene::Scene& scene);
/// A floor below a bed that follows a map with edges so steep that the bed may not settle on it: place and slope.
std::vector<std::string> terrainWarnings(const scene::Scene& scene);

/// How the scene's bed is laid.
terrain::BedOptions bedOptions(const scene::Scene& scene);

} // namespace grouser::setup
