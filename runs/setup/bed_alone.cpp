// SPDX-License-Identifier: BSD-3-Clause
#include "runs/setup/bed_alone.hpp"

#include "runs/scene/scene.hpp"
#include "runs/setup/complementarity_setup.hpp"
#include "runs/setup/provenance.hpp"
#include "runs/setup/scene_surfaces.hpp"
#include "runs/setup/step_limit.hpp"
#include "runs/setup/vehicle_setup.hpp"

#include <algorithm>

namespace grouser::setup {

namespace {

/// True if the scene adds grains or surfaces to the settled bed.
bool hasMoreThanBed(const scene::Scene& scene) {
  if (!scene.grains.empty() || !scene.fills.empty()) return true;
  const std::vector<SceneSurface> surfaces = surfacesOf(scene);
  return std::any_of(surfaces.begin(), surfaces.end(), [](const SceneSurface& s) { return s.placedLater; });
}

} // namespace

bool isPutOnBed(const scene::Scene& scene) {
  if (!scene.terrain || !scene.terrain->granular()) return false;
  return hasComplementarity(scene) || hasMoreThanBed(scene); // beds settle with penalty contacts
}

scene::Scene sceneOfBed(scene::Scene scene) {
  if (hasComplementarity(scene)) {
    scene.run.contact = scene::ContactMethod::penalty, scene.run.timeStep.reset(), scene.run.residual.reset();
    scene.complementarity.reset();
    if (!hasMoreThanBed(scene)) return scene;
  }
  const std::vector<SceneSurface> surfaces = surfacesOf(scene);
  const auto removeLater = [&](coupling::SurfaceKind kind, auto& sections) {
    for (std::size_t k = surfaces.size(); k-- > 0;) // in reverse order, so that the remaining indices stay valid
      if (const SceneSurface& s = surfaces[k]; s.kind == kind && s.placedLater)
        sections.erase(sections.begin() + static_cast<std::ptrdiff_t>(s.number));
  };
  removeLater(coupling::SurfaceKind::plane, scene.planes), removeLater(coupling::SurfaceKind::box, scene.boxes);
  removeLater(coupling::SurfaceKind::cylinder, scene.cylinders), removeLater(coupling::SurfaceKind::mesh, scene.meshes);
  scene.grains.clear(), scene.fills.clear(), scene.sources.clear();
  removeVehicle(scene), scene.mechanism = {};
  return scene;
}

std::string originOfBed(const scene::Scene& scene) {
  if (!scene.terrain || !scene.terrain->granular() || !scene.terrain->cache || scene.terrain->settleTimeLimit <= 0)
    return "";
  if (!isPutOnBed(scene)) return bedOrigin(scene, chooseTimeStep(scene));
  const scene::Scene bed = sceneOfBed(scene);
  return bedOrigin(bed, chooseTimeStep(bed));
}

} // namespace grouser::setup
