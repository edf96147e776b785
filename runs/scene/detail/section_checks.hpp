// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/table.hpp"
#include "runs/scene/scene.hpp"

#include <optional>
#include <string>

/// What sections of several subjects are checked for.
namespace grouser::scene::detail {

/// Throws InputError unless `name` is a material of the scene; `key` is where the name stands.
void requireMaterial(const Scene& scene, const base::Section& section, const std::string& key, const std::string& name);

/// Makes `name` the absolute path of an existing file. Throws InputError with the places that were looked at.
void resolveFile(const Scene& scene, const base::Section& section, const std::string& key, std::string& name);

/// Reads a mesh, whose file's name is absolute, by `scale` [m] and with the sphere radius [m] of its section.
/// `centred`: shifts it to the middle of the box that holds it. Throws InputError at the keys file, scale and
/// sphere_radius.
LoadedMesh loadMesh(const base::Section& section, const std::string& file, double scale,
                    const std::optional<double>& sphereRadius, bool centred);

/// What only the scene as a whole shows, once all sections are read. Throws InputError.
void checkTogether(const Scene& scene);

} // namespace grouser::scene::detail
