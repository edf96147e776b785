// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace grouser::test {

/// A scene with all sections, for tests that break one line of it.
inline std::string wholeScene() {
  return R"(version = 1
[run]
duration = 2
time_step = 1e-4
[material.soil]
stiffness = 1e6
[material.steel]
density = 7800
stiffness = 1e7
friction = 0.8
[contact."soil|steel"]
friction = 0.7
[terrain]
heightmap = "heightmaps/hills.png"
size = [6, 4]
height_range = [0, 0.3]
material = "soil"
ground_material = "steel"
grain_radius = 0.05
layers = 2
arrangement = "lattice"
floor_grains = false
wall_friction = 0.5
[vehicle]
spec = "vehicles/light_tracked.toml"
position = [1.5, 0]
material = "steel"
[driver]
sprocket_speed = 1
[output]
pictures = false
)";
}

/// `text` with the first `from` replaced by `to`.
inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  return at == std::string::npos ? "" : text.replace(at, from.size(), to);
}

/// The valid scene.
inline std::string goodScene() { return replaced(wholeScene(), "pictures = false", "picture = false"); }

} // namespace grouser::test
