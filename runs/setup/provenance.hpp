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

/// Origin of a setup, for results, checkpoints and messages.
struct Provenance {
  std::filesystem::path file; ///< scene file
  std::vector<std::string> overrides;
  std::string resolved; ///< the scene with every default filled in, as TOML
  std::string inputs;   ///< see inputsOf()
  std::vector<support::SoilUse> soils{};
};
Provenance provenanceOf(const scene::Scene& scene);

/// A line for each file that the scene names: its key and a hash of its bytes. Throws InputError if one cannot be read.
std::string inputsOf(const scene::Scene& scene);

/// Everything that determines the bits of a settled bed, as text: the parts of the scene that affect it with all their
/// values, the bytes of the height-map, the time step, and the running program. The program is identified by a hash of
/// its file, since version and commit do not include uncommitted changes and the compiler.
std::string bedOrigin(const scene::Scene& scene, double timeStep);

} // namespace grouser::setup
