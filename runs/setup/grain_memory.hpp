// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/setup/contact_pairs.hpp"
#include "terrain/grain_model.hpp"

namespace grouser::setup {

/// Device memory that a grain of a scene will take, by what it is for [bytes]: of the fields that terrain::GrainFields
/// declares, and of the lists for the places of a settled bed, before anything is allocated.
struct GrainMemory {
  double state{};      ///< fields of grains alone: places, velocities, spins of this step and the next, and the like
  double lists{};      ///< neighbours
  double history{};    ///< springs and rolling angles of contacts between grains
  double boundaries{}; ///< touch with planes and floor, and history there
  double rebuild{};    ///< while the lists are made anew, on top of the others
  double total() const { return state + lists + history + boundaries; }
  double most() const { return total() + rebuild; }
};

/// What decides which kernels the grains take: terrain::stepKernel(), boundaryKernel().
struct KernelTraits {
  unsigned features; ///< of laws, grains and boundaries, and loads of rigid parts
  terrain::GrainModel model;
};
/// As the grains of the scene will have them, which must have some.
KernelTraits kernelTraits(const scene::Scene& scene, const ContactPairs& pairs);

/// Of the grains of `scene`. Those of very unlike radii have more neighbours, and take more.
GrainMemory grainMemory(const scene::Scene& scene);

} // namespace grouser::setup
