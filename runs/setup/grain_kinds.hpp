// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/scene/scene.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace grouser::setup {

/// Grains of a scene: [[grain]], [[grains]], bed and sources.
struct GrainKinds {
  double largest = 0, smallest = 0;  ///< radii [m]; 0 without grains
  std::vector<std::string> material; ///< materials of grains, in the order of the file
  struct Kind {
    std::string material;
    double smallest, largest; ///< radii of grains of this material [m]
  };
  std::vector<Kind> kinds; ///< one per material

  bool any() const { return !material.empty(); }
  bool manyRadii() const { return smallest != largest; }
  bool manyMaterials() const { return material.size() > 1; }
  bool many() const { return manyRadii() || manyMaterials(); }
  int indexOf(const std::string& name) const;
};
GrainKinds grainKinds(const scene::Scene& scene);
/// Returns true if grains crush against parts of a vehicle or meshes.
bool crushes(const scene::Scene& scene, const GrainKinds& kinds);

/// Grains of [[grain]] and [[grains]] in the order of the file, which is the order of their ids. Throws InputError if a
/// random fill does not fit into its box.
std::vector<scene::Grain> placedGrains(const scene::Scene& scene);
/// Number of these grains, without placing them.
std::int64_t placedCount(const scene::Scene& scene);
std::int64_t placedCount(const scene::GrainFill& block);

} // namespace grouser::setup
