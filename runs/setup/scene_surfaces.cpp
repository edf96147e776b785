// SPDX-License-Identifier: BSD-3-Clause
#include "runs/setup/scene_surfaces.hpp"

#include "runs/support/orientation.hpp"

#include <fmt/format.h>

namespace grouser::setup {

using base::Vec3d;
using terrain::SurfaceShape;

std::vector<SceneSurface> surfacesOf(const scene::Scene& scene) {
  std::vector<SceneSurface> all;
  const auto add = [&](const char* kind, std::size_t number, const scene::SurfaceSection& section, SurfaceShape shape,
                       const Vec3d& half, const base::Pose& pose) {
    all.push_back(
        {section.name.value_or(fmt::format("{}{}", kind, number)), kind, number, section, {shape, half}, pose});
  };
  for (std::size_t k = 0; k < scene.planes.size(); ++k) {
    const scene::Plane& p = scene.planes[k];
    if (!p.isWall()) add("plane", k, p, SurfaceShape::plane, {}, {p.point, support::turnFromZ(p.normal)});
  }
  for (std::size_t k = 0; k < scene.boxes.size(); ++k) {
    const scene::BoxSection& b = scene.boxes[k];
    add("box", k, b, SurfaceShape::box, 0.5 * b.size,
        {b.position, support::orientationOf(b.axis, b.angle, b.orientation.value_or(std::vector<double>{}))});
  }
  for (std::size_t k = 0; k < scene.cylinders.size(); ++k) {
    const scene::CylinderSection& c = scene.cylinders[k];
    add("cylinder", k, c, c.hollow ? SurfaceShape::tube : SurfaceShape::cylinder, {c.radius, 0, 0.5 * c.length},
        {c.position, support::turnFromZ(c.axis)});
  }
  for (std::size_t k = 0; k < scene.meshes.size(); ++k) {
    const scene::MeshSection& m = scene.meshes[k];
    const auto [low, high] = spheredecomp::bounds(m.loaded.query->mesh());
    add("mesh", k, m, SurfaceShape::box, 0.5 * (high - low),
        {m.position, support::orientationOf(m.axis, m.angle, m.orientation.value_or(std::vector<double>{}))});
    all.back().mesh = m.loaded.query;
  }
  return all;
}

terrain::SurfacePose startingPose(const SceneSurface& surface) {
  const base::Pose& pose = surface.start;
  return {{pose.position, pose.orientation.matrix(), pose.position, {}, {}}, base::Mat3d::identity()};
}

double startingOverlap(const SceneSurface& surface, const Vec3d& position, double radius) {
  return overlapAt(surface, surface.start, position, radius);
}

double overlapAt(const SceneSurface& surface, const base::Pose& pose, const Vec3d& position, double radius) {
  const Vec3d p = pose.toBody(position);
  if (surface.mesh) return radius - surface.mesh->signedDistance(p);
  return radius - terrain::gapTo(surface.geometry, p).distance;
}

} // namespace grouser::setup
