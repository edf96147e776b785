// SPDX-License-Identifier: BSD-3-Clause
#include "runs/setup/grain_kinds.hpp"

#include "runs/scene/scene.hpp"
#include "runs/setup/bed_options.hpp"

#include <algorithm>

namespace grouser::setup {

namespace {

void include(GrainKinds& all, const std::string& material, double smallest, double largest) {
  if (!all.any()) all.smallest = smallest, all.largest = largest;
  all.smallest = std::min(all.smallest, smallest), all.largest = std::max(all.largest, largest);
  const int index = all.indexOf(material);
  if (index < 0) {
    all.material.push_back(material);
    all.kinds.push_back({material, smallest, largest});
    return;
  }
  GrainKinds::Kind& kind = all.kinds[static_cast<std::size_t>(index)];
  kind.smallest = std::min(kind.smallest, smallest), kind.largest = std::max(kind.largest, largest);
}

} // namespace

int GrainKinds::indexOf(const std::string& name) const {
  const auto at = std::find(material.begin(), material.end(), name);
  return at == material.end() ? -1 : static_cast<int>(at - material.begin());
}

GrainKinds grainKinds(const scene::Scene& scene) {
  GrainKinds kinds;
  for (const scene::Grain& g : scene.grains) include(kinds, g.material, g.radius, g.radius);
  for (const scene::GrainFill& b : scene.fills) include(kinds, b.material, b.smallestRadius(), b.largestRadius());
  if (scene.terrain && scene.terrain->granular()) {
    const terrain::BedOptions bed = bedOptions(scene);
    include(kinds, scene.terrain->material, bed.smallestRadius(), bed.largestRadius());
  }
  for (const scene::Source& s : scene.sources) include(kinds, s.material, s.radius, s.radius);
  return kinds;
}

bool crushes(const scene::Scene& scene, const GrainKinds& kinds) {
  if (!scene.vehicle && scene.meshes.empty() && !scene.mechanism.touches()) return false;
  return std::any_of(kinds.material.begin(), kinds.material.end(),
                     [&](const std::string& name) { return scene.material(name).crushingStrength.has_value(); });
}

} // namespace grouser::setup
