// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/vec.hpp"
#include "contact/saved_contacts.hpp"

#include <cstdint>
#include <cstring>
#include <vector>

namespace grouser::coupling {

/// What a rigid surface must remember beyond its law of motion.
struct SurfaceState {
  double offset{}, speed{};            ///< of one that forces move, along its axis [m], [m/s]
  double work{};                       ///< since the start, by what moves it [J]
  double turnover{};                   ///< of one that forces move: its absolute work in each step, since the start [J]
  base::Vec3d impulse, angularImpulse; ///< on the grains since the start [N s], [N m s about the origin of the world]
  base::Vec3d force, torque;           ///< sums over the steps since the last row [N], [N m]
  base::Vec3d pivotTorque;             ///< the same of the torque about the pivot [N m]
  double power{};                      ///< the same [W]
};

/// All surfaces of a scene.
struct SurfaceStates {
  std::vector<SurfaceState> surfaces;
  std::int64_t meanSteps{};           ///< that those sums are over
  contact::SavedGrainPatches patches; ///< of grains on meshes

  /// For the hash: what the next step depends on.
  std::vector<std::uint32_t> words() const {
    std::vector<std::uint32_t> words;
    for (const SurfaceState& s : surfaces)
      for (const double number : {s.offset, s.speed}) {
        std::uint32_t raw[2];
        std::memcpy(raw, &number, sizeof raw);
        words.insert(words.end(), raw, raw + 2);
      }
    const std::vector<std::uint32_t> onMeshes = patches.words();
    words.insert(words.end(), onMeshes.begin(), onMeshes.end());
    return words;
  }
};

} // namespace grouser::coupling
