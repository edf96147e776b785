// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/support/soil_use.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace grouser::scene {
struct Scene;
} // namespace grouser::scene

namespace grouser::setup {

/// Where a setup comes from: for results, checkpoints and messages.
struct Provenance {
  std::filesystem::path file; ///< of the scene
  std::vector<std::string> overrides;
  std::string resolved; ///< the scene with every default filled in, as TOML
  std::string inputs;   ///< see inputsOf()
  std::vector<support::SoilUse> soils{};
};
Provenance provenanceOf(const scene::Scene& scene);

/// A line for each file that the scene names: its key and a hash of its bytes. Throws InputError where one cannot be
/// read.
std::string inputsOf(const scene::Scene& scene);

/// Everything that makes the bits of a settled bed, as text: the parts of the scene that have a share in it with all
/// their values, the bytes of the height-map, the time step, and the running program. The program is known by a hash
/// of its file, since neither a version nor a commit tells of changes that are not committed, or of a compiler.
std::string bedOrigin(const scene::Scene& scene, double timeStep);

} // namespace grouser::setup
