// SPDX-License-Identifier: BSD-3-Clause
#include "runs/setup/grain_memory.hpp"

#include "runs/setup/laws.hpp"
#include "runs/setup/scene_surfaces.hpp"
#include "terrain/grains.hpp"

namespace grouser::setup {

unsigned grainFeatures(const scene::Scene& scene, const GrainKinds& kinds) {
  unsigned features = terrain::kLedger;
  const auto add = [&](const std::string& a, const std::string& b) { features |= pairLaw(scene, a, b, 1).features(); };
  for (const std::string& a : kinds.material) {
    for (const std::string& b : kinds.material) add(a, b);
    for (const scene::Plane& p : scene.planes) add(a, p.material);
    for (const SceneSurface& surface : surfacesOf(scene)) add(a, surface.section.material);
    if (scene.terrain) add(a, scene.terrain->granular() ? scene.terrain->groundMaterial : scene.terrain->material);
  }
  if (!scene.planes.empty() || scene.terrain) features |= terrain::kBoundaries;
  if (surfacesOf(scene).size() > scene.meshes.size()) features |= terrain::kBoundaries | terrain::kSurfaces;
  if (!scene.meshes.empty()) features |= terrain::kLoads;
  if (scene.run.periodic[0] || scene.run.periodic[1]) features |= terrain::kPeriodic;
  if (kinds.many()) features |= terrain::kManyRadii;
  if (kinds.manyMaterials()) features |= terrain::kManyMaterials;
  return scene.vehicle ? features | terrain::kLoads : features;
}

GrainMemory grainMemory(const scene::Scene& scene) {
  // Neighbours listed of a grain in a settled bed, at the skin that scenes begin with, and what lists leave free; and
  // those of them that touch.
  constexpr double kPlaces = 8, kContacts = 4;
  constexpr double kWord = sizeof(std::uint32_t), kMask = sizeof(std::uint64_t);
  const unsigned features = grainFeatures(scene, grainKinds(scene));
  const double width = contact::historyWidth(features);
  const bool walls = scene.terrain && scene.terrain->granular() && scene.terrain->walls;
  const auto boundaries = static_cast<double>(scene.planes.size() + scene.boxes.size() + scene.cylinders.size() +
                                              (scene.terrain ? 1 : 0) + (walls ? 4 : 0));
  const double history = width * sizeof(float);
  GrainMemory m;
  m.state = 2 * (sizeof(base::Position) + 2 * sizeof(terrain::Vec4f)) + sizeof(terrain::Remainders) + kWord;
  // Count, start, mask, id and order of a row; three words of the place at the rebuild.
  m.lists = 4 * kWord + kMask + kPlaces * kWord + 3 * kWord;
  m.history = kPlaces * history;
  if (boundaries > 0) m.boundaries = 2 * kWord + boundaries * history;
  if (features & terrain::kLedger) m.ledger = sizeof(double);
  // Contacts that are set aside, with a start, and one cell of the grid.
  m.rebuild = kContacts * (kWord + history) + 2 * kWord;
  return m;
}

} // namespace grouser::setup
