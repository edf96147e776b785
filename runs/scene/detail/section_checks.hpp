// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/table.hpp"
#include "runs/scene/scene.hpp"

#include <optional>
#include <string>

/// Checks shared by sections of several subjects.
namespace grouser::scene::detail {

/// Throws InputError unless `name` is a material of the scene; `key`: key that contains the name.
void requireMaterial(const Scene& scene, const base::Section& section, const std::string& key, const std::string& name);

/// Makes `name` the absolute path of an existing file. Throws InputError with the searched paths.
void resolveFile(const Scene& scene, const base::Section& section, const std::string& key, std::string& name);

/// Reads the mesh at the absolute path `file`. `scale`: metres per unit of the file; `sphereRadius` [m], empty for the
/// default; `centred`: moves the centre of the bounding box to the origin. Throws InputError at the key file, scale or
/// sphere_radius.
LoadedMesh loadMesh(const base::Section& section, const std::string& file, double scale,
                    const std::optional<double>& sphereRadius, bool centred);

/// Checks of the scene as a whole, once all sections are read. Throws InputError.
void checkTogether(const Scene& scene);

} // namespace grouser::scene::detail
