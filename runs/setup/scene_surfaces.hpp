// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "coupling/surface_setup.hpp"
#include "runs/scene/scene.hpp"

#include <string>
#include <vector>

namespace grouser::setup {

/// A surface with its section.
struct SceneSurface : coupling::SurfaceSetup {
  scene::SurfaceSection section;

  std::string list() const { return std::string(base::wordOf(kind)); } ///< "box" of [[box]]
};
/// Planes that move or have a name, then boxes, cylinders and meshes; each kind in the order of the file.
std::vector<SceneSurface> surfacesOf(const scene::Scene& scene);

} // namespace grouser::setup
