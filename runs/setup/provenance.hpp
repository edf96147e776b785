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

/// One line per file that the scene names, with key and hash of the bytes. Throws InputError if a file cannot be read.
std::string inputsOf(const scene::Scene& scene);

/// Everything that determines the bits of a settled bed, as text: all values of the relevant parts of the scene, the
/// bytes of the height-map, the time step, and a hash of the program file (version and commit do not reflect
/// uncommitted changes and the compiler).
std::string bedOrigin(const scene::Scene& scene, double timeStep);

} // namespace grouser::setup
