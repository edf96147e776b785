// SPDX-License-Identifier: BSD-3-Clause
#include "runs/setup/grain_memory.hpp"

#include "runs/setup/grain_model.hpp"
#include "runs/setup/placement.hpp"
#include "terrain/grains.hpp"

namespace grouser::setup {

namespace {

/// As the grains of the scene will have them. Where walls and floor are is not known yet, and does not matter.
struct Traits {
  unsigned features; ///< of the laws, grains and boundaries
  terrain::GrainLayout layout;
};
Traits traitsOf(const scene::Scene& scene, const GrainKinds& kinds) {
  const terrain::Rectangle area = terrainArea(scene).value_or(terrain::Rectangle{});
  std::optional<terrain::HeightField> floor;
  if (scene.terrain) floor = terrain::HeightField::flat(area, 0);
  terrain::Boundaries boundaries;
  const terrain::GrainModel model = grainModel(scene, kinds, 0, surroundingsOf(scene, floor, area), boundaries);
  const unsigned features = terrain::featuresOf(model, boundaries, kinds.many());
  return {features, terrain::layoutOf(features, boundaries.count(), model.materials.count())};
}

double fieldBytes(const terrain::GrainLayout& layout) {
  return static_cast<double>(terrain::GrainFields(layout).bytesPerGrain());
}

} // namespace

unsigned grainFeatures(const scene::Scene& scene, const GrainKinds& kinds) {
  const bool parts = scene.vehicle || !scene.meshes.empty();
  return traitsOf(scene, kinds).features | (parts ? terrain::kLoads : 0u);
}

GrainMemory grainMemory(const scene::Scene& scene) {
  // Neighbours listed of a grain in a settled bed, at the skin that scenes begin with, and what lists leave free; and
  // those of them that touch.
  constexpr double kPlaces = 8, kContacts = 4;
  constexpr double kWord = sizeof(std::uint32_t), kMask = sizeof(std::uint64_t);
  const terrain::GrainLayout layout = traitsOf(scene, grainKinds(scene)).layout;
  const double history = static_cast<double>(layout.historyWidth()) * sizeof(float);
  terrain::GrainLayout bare = layout; // without boundaries
  bare.boundaries = 0;
  GrainMemory m;
  m.state = fieldBytes(bare);
  m.boundaries = fieldBytes(layout) - fieldBytes(bare);
  // Count, start, mask, id and order of a row.
  m.lists = 4 * kWord + kMask + kPlaces * kWord * (layout.radii ? 2 : 1); // the slot, and the sum of radii
  m.history = kPlaces * history;
  // Contacts that are set aside, with a start, and one cell of the grid.
  m.rebuild = kContacts * (kWord + history) + 3 * kWord; // and on a GPU what lies where in the cells
  return m;
}

} // namespace grouser::setup
