// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/table.hpp"
#include "runs/scene/scene.hpp"

#include <string>

namespace grouser::scene {

/// Reads and checks [[plane]], [[box]], [[cylinder]] and [[mesh]]; their materials are the caller's affair. Throws
/// InputError.
void readSurfaces(const base::Section& root, Scene& scene);
/// Reads the file of a [[mesh]], whose name is absolute now. Throws InputError.
void loadMesh(const base::Section& section, MeshSection& mesh);
/// Whether surfaces fit together with all else of the scene. Throws InputError.
void checkSurfaces(const base::Section& root, const Scene& scene);
/// The same sections as TOML.
std::string surfacesToml(const Scene& scene);

} // namespace grouser::scene
