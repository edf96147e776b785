// SPDX-License-Identifier: BSD-3-Clause
#include "runs/setup/scene_surfaces.hpp"

#include "runs/scene/scene.hpp"
#include "runs/support/orientation.hpp"

#include <fmt/format.h>

namespace grouser::setup {

using base::Vec3d;
using terrain::SurfaceShape;

namespace {

coupling::SurfaceMotion motionOf(const scene::SurfaceSection& s, const Vec3d& centre) {
  coupling::SurfaceMotionLaw law;
  law.pivot = s.pivot.value_or(centre);
  law.velocity = s.velocity.value_or(Vec3d{}), law.spin = s.spin.value_or(Vec3d{});
  law.amplitude = s.amplitude.value_or(Vec3d{});
  law.frequency = s.frequency.value_or(0), law.phase = s.phase.value_or(0) / 360;
  law.start = s.start.value_or(0);
  if (s.until) law.until = *s.until;
  return coupling::SurfaceMotion(law, centre);
}

std::optional<coupling::FreeSurface> freedomOf(const scene::SurfaceSection& s) {
  if (!s.free) return {};
  coupling::FreeSurface free;
  free.axis[static_cast<int>(*s.free)] = 1;
  free.mass = *s.mass, free.load = s.load.value_or(0), free.loadRamp = s.loadRamp.value_or(0);
  return free;
}

/// Default: fixed surfaces are placed before the bed settles, moving surfaces and meshes after settling.
bool isPlacedLater(const scene::Scene& scene, const scene::SurfaceSection& s, coupling::SurfaceKind kind) {
  if (!scene.terrain || !scene.terrain->granular()) return false;
  if (s.placed) return *s.placed == scene::PlacedWhen::afterSettling;
  if (s.aboveBed) return true;
  return scene.terrain->settleTimeLimit > 0 && (s.moves() || kind == coupling::SurfaceKind::mesh);
}

} // namespace

std::vector<SceneSurface> surfacesOf(const scene::Scene& scene) {
  std::vector<SceneSurface> all;
  const auto add = [&](coupling::SurfaceKind kind, std::size_t number, const scene::SurfaceSection& section,
                       SurfaceShape shape, const Vec3d& half, const base::Pose& pose) {
    all.push_back({{.name = section.name.value_or(fmt::format("{}{}", base::wordOf(kind), number)),
                    .kind = kind,
                    .number = number,
                    .place = scene.placeOf(std::string(base::wordOf(kind)), number),
                    .material = section.material,
                    .geometry = {shape, half},
                    .start = pose,
                    .motion = motionOf(section, pose.position),
                    .free = freedomOf(section),
                    .moves = section.moves(),
                    .hasPivot = section.pivot.has_value(),
                    .placedLater = isPlacedLater(scene, section, kind),
                    .aboveBed = section.aboveBed},
                   section});
  };
  for (std::size_t k = 0; k < scene.planes.size(); ++k) {
    const scene::Plane& p = scene.planes[k];
    if (!p.isWall())
      add(coupling::SurfaceKind::plane, k, p, SurfaceShape::plane, {}, {p.point, support::turnFromZ(p.normal)});
  }
  for (std::size_t k = 0; k < scene.boxes.size(); ++k) {
    const scene::BoxSection& b = scene.boxes[k];
    add(coupling::SurfaceKind::box, k, b, SurfaceShape::box, 0.5 * b.size,
        {b.position, support::orientationOf(b.axis, b.angle, b.orientation.value_or(std::vector<double>{}))});
  }
  for (std::size_t k = 0; k < scene.cylinders.size(); ++k) {
    const scene::CylinderSection& c = scene.cylinders[k];
    add(coupling::SurfaceKind::cylinder, k, c, c.hollow ? SurfaceShape::tube : SurfaceShape::cylinder,
        {c.radius, 0, 0.5 * c.length}, {c.position, support::turnFromZ(c.axis)});
  }
  for (std::size_t k = 0; k < scene.meshes.size(); ++k) {
    const scene::MeshSection& m = scene.meshes[k];
    const auto [low, high] = spheredecomp::bounds(m.loaded.query->mesh());
    add(coupling::SurfaceKind::mesh, k, m, SurfaceShape::box, 0.5 * (high - low),
        {m.position, support::orientationOf(m.axis, m.angle, m.orientation.value_or(std::vector<double>{}))});
    all.back().mesh = m.loaded.query;
    all.back().sphereRadius = m.loaded.sphereRadius;
    all.back().sphereRadiusGiven = m.sphereRadius.has_value();
    all.back().sphereRefinement = m.sphereRefinement;
  }
  return all;
}

} // namespace grouser::setup
