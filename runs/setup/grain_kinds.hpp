// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/scene/scene.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace grouser::setup {

/// What grains a scene has: those of [[grain]] and [[grains]], the bed's, and those that sources bring.
struct GrainKinds {
  double largest = 0, smallest = 0;  ///< radii [m]; 0 without grains
  std::vector<std::string> material; ///< those that occur, in the order of the file
  struct Kind {
    std::string material;
    double smallest, largest; ///< radii of that material [m]
  };
  std::vector<Kind> kinds; ///< one a material

  bool any() const { return !material.empty(); }
  bool manyRadii() const { return smallest != largest; }
  bool manyMaterials() const { return material.size() > 1; }
  bool many() const { return manyRadii() || manyMaterials(); }
  int indexOf(const std::string& name) const;
};
GrainKinds grainKinds(const scene::Scene& scene);
/// Whether grains crush against parts of a vehicle or meshes.
bool crushes(const scene::Scene& scene, const GrainKinds& kinds);

/// The single grains and those of blocks, in the order of the file: their place is their id. Reads the files that
/// blocks name. Throws InputError: no room for all, a broken line.
std::vector<scene::Grain> placedGrains(const scene::Scene& scene);
/// How many those are, without placing them.
std::int64_t placedCount(const scene::Scene& scene);
std::int64_t placedCount(const scene::GrainFill& block);

} // namespace grouser::setup
