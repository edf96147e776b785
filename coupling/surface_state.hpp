// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/vec.hpp"
#include "contact/saved_contacts.hpp"

#include <cstdint>
#include <cstring>
#include <vector>

namespace grouser::coupling {

/// State of a rigid surface besides its prescribed motion.
struct SurfaceState {
  double offset{}, speed{}; ///< of a force-driven surface, along its axis [m], [m/s]
  double work{};            ///< of its drive, since the start [J]
  double turnover{};        ///< of a force-driven surface: sum of its absolute work per step, since the start [J]
  base::Vec3d impulse, angularImpulse; ///< on the grains since the start [N s], [N m s about the origin of the world]
  base::Vec3d force, torque;           ///< sums over the steps since the last row [N], [N m]
  base::Vec3d pivotTorque;             ///< the same of the torque about the pivot [N m]
  double power{};                      ///< the same [W]
};

/// All surfaces of a scene.
struct SurfaceStates {
  std::vector<SurfaceState> surfaces;
  std::int64_t meanSteps{};           ///< number of steps in those sums
  contact::SavedGrainPatches patches; ///< of grains on meshes

  /// For the hash: the data that the next step depends on.
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
