// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/scene/scene.hpp"
#include "terrain/rigid_surface.hpp"

#include <memory>
#include <string>
#include <vector>

namespace grouser::setup {

/// One rigid surface of a scene as grains meet it, whatever section it stands in.
struct SceneSurface {
  std::string name;     ///< "lid"
  const char* kind{};   ///< "box"
  std::size_t number{}; ///< among those of its kind
  scene::SurfaceSection section;
  terrain::SurfaceGeometry geometry; ///< of a mesh the box that holds it
  base::Pose start;
  std::shared_ptr<const spheredecomp::MeshQuery> mesh{}; ///< null but for meshes
};
/// Planes that move or have a name, boxes, cylinders, meshes: in this order, and in that of the file.
std::vector<SceneSurface> surfacesOf(const scene::Scene& scene);
/// At rest where it stands at the start.
terrain::SurfacePose startingPose(const SceneSurface& surface);
/// Overlap of a sphere with it at the start [m]; negative where they do not touch.
double startingOverlap(const SceneSurface& surface, const base::Vec3d& position, double radius);
/// The same where the surface's own frame has come to `pose`.
double overlapAt(const SceneSurface& surface, const base::Pose& pose, const base::Vec3d& position, double radius);

} // namespace grouser::setup
