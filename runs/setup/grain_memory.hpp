// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/setup/contact_pairs.hpp"
#include "terrain/grain_model.hpp"

namespace grouser::setup {

/// Device memory per grain of a scene by purpose [bytes]: fields of terrain::GrainFields, and lists of a settled bed.
/// Known before any memory is allocated.
struct GrainMemory {
  double state{};      ///< grain fields: positions, velocities and spins of this step and the next, and others
  double lists{};      ///< neighbour lists
  double history{};    ///< springs and rolling angles of contacts between grains
  double boundaries{}; ///< contacts with planes and floor, and their history
  double rebuild{};    ///< additional memory while the lists are rebuilt
  double total() const { return state + lists + history + boundaries; }
  double most() const { return total() + rebuild; }
};

/// Traits that select the kernels of grains: terrain::stepKernel(), boundaryKernel().
struct KernelTraits {
  unsigned features; ///< features of laws, grains and boundaries, and loads on rigid parts
  terrain::GrainModel model;
};
/// Traits of the grains of a scene, which must have grains.
KernelTraits kernelTraits(const scene::Scene& scene, const ContactPairs& pairs);

/// Memory per grain of `scene`. Grains of very different radii have more neighbours and need more.
GrainMemory grainMemory(const scene::Scene& scene);

} // namespace grouser::setup
