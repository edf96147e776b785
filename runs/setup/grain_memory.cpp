// SPDX-License-Identifier: BSD-3-Clause
#include "runs/setup/grain_memory.hpp"

#include "runs/scene/scene.hpp"
#include "runs/setup/bed_options.hpp"
#include "runs/setup/grain_model.hpp"
#include "runs/setup/placement.hpp"
#include "terrain/grains.hpp"

#include <algorithm>

namespace grouser::setup {

namespace {

/// Traits of the scene's grains. They do not depend on the positions of walls and floor.
struct Traits {
  unsigned features; ///< features of laws, grains and boundaries
  terrain::GrainLayout layout;
  terrain::GrainModel model;
};
Traits traitsOf(const scene::Scene& scene, const ContactPairs& pairs,
                const std::optional<terrain::HeightField>& floor) {
  const terrain::Rectangle area = terrainArea(scene).value_or(terrain::Rectangle{});
  terrain::Boundaries boundaries;
  const terrain::GrainModel model =
      grainModel(scene, pairs.kinds, 0, surroundingsOf(scene, pairs, floor, area), boundaries);
  const unsigned features = terrain::featuresOf(model, boundaries, pairs.kinds.many());
  return {features,
          terrain::layoutOf(features, boundaries.count(model.radius), model.materials.count(),
                            boundaries.floorPlaces(model.radius)),
          model};
}

double fieldBytes(const terrain::GrainLayout& layout) {
  return static_cast<double>(terrain::GrainFields(layout).bytesPerGrain());
}

/// Fraction of the grains of a bed at its floor or walls: one layer of a diameter at each. 1 without a bed.
double shareAtBoundaries(const scene::Scene& scene) {
  if (!scene.terrain || !scene.terrain->granular()) return 1;
  const scene::Terrain& t = *scene.terrain;
  const double depth = t.depth ? *t.depth : t.layers.value_or(1) * *t.spacing * *t.grainRadius;
  double layers = 1 / depth; // per unit of length
  for (std::size_t a = 0; a < 2; ++a)
    if (t.walls && !scene.run.periodic[a]) layers += 2 / t.size[a];
  return std::min(1.0, 2 * *t.grainRadius * layers);
}

/// Bytes per grain that may touch a boundary: index, load, and springs.
double bytesAtBoundaries(const Traits& traits) {
  const auto springs =
      static_cast<double>(traits.layout.boundaries * traits.layout.historyWidth() + 3 * traits.layout.places);
  const double load = traits.model.precision == terrain::Precision::single ? sizeof(terrain::BoundaryLoad<float>)
                                                                           : sizeof(terrain::BoundaryLoad<double>);
  const double fromSurfaces = traits.features & terrain::kSurfaces ? sizeof(base::Vec3d) : 0;
  return sizeof(std::uint32_t) + load + springs * sizeof(float) + fromSurfaces;
}

} // namespace

KernelTraits kernelTraits(const scene::Scene& scene, const ContactPairs& pairs) {
  const bool parts = scene.vehicle || !scene.meshes.empty() || scene.mechanism.touches();
  std::optional<terrain::HeightField> anyFloor; // features do not depend on the shape of the floor
  if (scene.terrain) anyFloor = terrain::HeightField::flat({0, 1, 0, 1}, 0);
  const Traits traits = traitsOf(scene, pairs, anyFloor);
  return {traits.features | (parts ? terrain::kLoads : 0u), traits.model};
}

GrainMemory grainMemory(const scene::Scene& scene) {
  // Per grain in a settled bed at the default skin: listed neighbours with spare slots, and contacts.
  constexpr double kPlaces = 8, kContacts = 4;
  constexpr double kWord = sizeof(std::uint32_t), kMask = sizeof(std::uint64_t);
  const Traits traits = traitsOf(scene, ContactPairs(scene), floorShape(scene));
  const terrain::GrainLayout& layout = traits.layout;
  const double history = static_cast<double>(layout.historyWidth()) * sizeof(float);
  terrain::GrainLayout bare = layout; // without boundaries
  bare.boundaries = 0;
  GrainMemory m;
  m.state = fieldBytes(bare);
  m.boundaries = fieldBytes(layout) - fieldBytes(bare);
  if (layout.boundaries > 0) m.boundaries += shareAtBoundaries(scene) * bytesAtBoundaries(traits);
  // Count, start, mask and id of a row.
  m.lists = 3 * kWord + kMask + kPlaces * kWord * (layout.radii ? 2 : 1); // the slot, and the sum of radii
  m.history = kPlaces * history;
  // Saved contacts with a start, the order of the grains, one cell of the grid and on a GPU its contents; minus the
  // memory freed during the rebuild.
  const double rebuild = kContacts * (kWord + history) + 4 * kWord;
  m.rebuild = std::max(0.0, rebuild - static_cast<double>(terrain::GrainFields(layout).bytesMadeAnew()));
  return m;
}

} // namespace grouser::setup
