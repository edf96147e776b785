// SPDX-License-Identifier: BSD-3-Clause
#include "runs/setup/obstacles.hpp"

#include "runs/scene/scene.hpp"
#include "runs/setup/laws.hpp"
#include "runs/setup/scene_surfaces.hpp"
#include "runs/setup/vehicle_surface.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <optional>

namespace grouser::setup {

namespace {

/// Walls are planes without a name, which surfacesOf() omits.
std::vector<SceneSurface> wallsOf(const scene::Scene& scene) {
  std::vector<SceneSurface> walls;
  for (std::size_t k = 0; k < scene.planes.size(); ++k) {
    if (!scene.planes[k].isWall()) continue;
    scene::Scene one;
    one.planes = {scene.planes[k]};
    one.planes.front().name = fmt::format("plane{}", k);
    walls.push_back(surfacesOf(one).front());
    walls.back().number = k, walls.back().place = scene.placeOf("plane", k);
  }
  return walls;
}

} // namespace

std::vector<coupling::SurfaceSetup> surfacesAtRest(const scene::Scene& scene) {
  std::vector<coupling::SurfaceSetup> all;
  for (const SceneSurface& s : surfacesOf(scene))
    if (!s.moves) all.push_back(s);
  for (const SceneSurface& wall : wallsOf(scene)) all.push_back(wall);
  return all;
}

std::vector<coupling::Obstacle> obstaclesOf(const scene::Scene& scene) {
  std::vector<coupling::Obstacle> all;
  if (!scene.vehicle && !scene.mechanism.touches() && !scene.fluid) return all;
  const std::optional<VehicleSurface> own = vehicleSurface(scene);
  const auto add = [&](const coupling::SurfaceSetup& s, std::optional<std::size_t> place) {
    double friction = 0; // bodies use a FoundationTable
    if (scene.vehicle)
      friction = own ? own->friction : pairLaw(scene, scene.vehicle->material, s.material, {}).friction;
    all.push_back({s, friction, place});
  };
  const std::vector<SceneSurface> surfaces = surfacesOf(scene);
  for (std::size_t i = 0; i < surfaces.size(); ++i)
    if (!surfaces[i].moves) add(surfaces[i], i);
  for (const SceneSurface& wall : wallsOf(scene)) add(wall, {});
  return all;
}

bool hullTouches(const scene::Scene& scene) {
  if (!scene.vehicle) return false;
  if (scene.vehicle->hullTouches) return *scene.vehicle->hullTouches;
  const auto rests = [](const auto& surfaces) {
    return std::any_of(surfaces.begin(), surfaces.end(), [](const scene::SurfaceSection& s) { return !s.moves(); });
  };
  return (scene.terrain && !scene.terrain->granular()) || rests(scene.planes) || rests(scene.boxes) ||
         rests(scene.cylinders) || rests(scene.meshes);
}

} // namespace grouser::setup
