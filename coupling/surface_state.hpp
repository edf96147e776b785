// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/vec.hpp"
#include "contact/saved_contacts.hpp"

#include <cstdint>
#include <cstring>
#include <vector>

namespace grouser::coupling {

/// State of a rigid surface in addition to its prescribed motion.
struct SurfaceState {
  double offset{}, speed{};            ///< displacement and speed of a force-driven surface along its axis [m], [m/s]
  double work{};                       ///< cumulative work of its drive [J]
  double turnover{};                   ///< cumulative absolute work per step of a force-driven surface [J]
  base::Vec3d impulse, angularImpulse; ///< cumulative, on the grains [N s], [N m s about the world origin]
  base::Vec3d force, torque;           ///< sums over the steps since the last output row [N], [N m]
  base::Vec3d pivotTorque;             ///< sum of the torque about the pivot since the last output row [N m]
  double power{};                      ///< sum of the drive power since the last output row [W]
};

/// States of all surfaces of a scene.
struct SurfaceStates {
  std::vector<SurfaceState> surfaces;
  std::int64_t meanSteps{};           ///< number of steps in those sums
  contact::SavedGrainPatches patches; ///< contacts of grains with meshes

  /// Words of the state hash: the data that the next step depends on.
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
