// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/setup/contact_pairs.hpp"

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

/// Features of the grains' step, loads of rigid parts among them, as the model of the scene will have them.
unsigned grainFeatures(const scene::Scene& scene, const ContactPairs& pairs);

/// Of the grains of `scene`. Those of very unlike radii have more neighbours, and take more.
GrainMemory grainMemory(const scene::Scene& scene);

} // namespace grouser::setup
