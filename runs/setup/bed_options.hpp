// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/scene/scene.hpp"
#include "terrain/bed.hpp"
#include "terrain/height_field.hpp"

namespace grouser::setup {

/// The ground's surface as the height-map says. Throws InputError where that cannot be read.
terrain::HeightField readSurface(const scene::Scene& scene);

/// How the scene's bed is laid.
terrain::BedOptions bedOptions(const scene::Scene& scene);

} // namespace grouser::setup
