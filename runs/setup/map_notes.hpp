// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/scene/scene.hpp"
#include "terrain/heightmap.hpp"

#include <string>
#include <vector>

namespace grouser::setup {

/// Notes on a height map whose relief, pixel shape or height steps are unlikely to be intended: relief above the
/// smaller side of the terrain or a mean slope above 45 degrees, pixels stretched by more than 1.5, and steps of an
/// 8-bit map that are coarse for the ground. Requires [terrain].
std::vector<std::string> mapNotes(const scene::Scene& scene, const terrain::Heightmap& map);

} // namespace grouser::setup
