// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/commands/counted_grains.hpp"
#include "runs/scene/scene.hpp"

#include <cstdint>
#include <string>

namespace grouser::commands {

/// What the scene switches on and leaves out, its size, time step, memory and cost. Reads height-map and vehicle spec.
/// `counted`: its grains, where they have been counted; null: about as many as their volume tells.
std::string planText(const scene::Scene& scene, const CountedGrains* counted = nullptr);

/// A part of it: every pair of materials that can meet, with the values that act between them, and a note where a value
/// of one material does nothing. Empty where nothing can touch.
std::string pairsText(const scene::Scene& scene);

/// What one rank does, from `grouser bench bed`: the figures that expectations rest on.
struct RankSpeed {
  const char* name;
  double grainSteps;    ///< particle-steps a second of one rank alone, for grains of one radius and linear springs
  double shareOfSoil;   ///< of that speed, for grains of many radii, fixed ones, Hertz contacts, rolling resistance [-]
  double shareOfOthers; ///< for grains of what is rarer still [-]
  double latency;       ///< of one step's messages and sums [s]
  double bytesPerSecond;
};
inline constexpr RankSpeed kRankSpeeds[] = {{"a CPU core", 1.7e7, 0.8, 0.3, 20e-6, 2e9},
                                            {"an H200", 4.4e9, 0.7, 0.7, 100e-6, 5e10}};

/// How `ranks` ranks would share the scene's grains: lattice, ghosts, memory, and the efficiency to expect from the
/// stated speeds. Empty for a scene without grains.
std::string sharePlan(const scene::Scene& scene, int ranks);

} // namespace grouser::commands
