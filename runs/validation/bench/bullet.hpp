// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/vec.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace grouser::bench {

/// Time of sequential Bullet to find the contacts of equal spheres.
struct BulletFigures {
  std::int64_t contacts = 0; ///< overlapping pairs, each once
  double setUpSeconds = 0;   ///< creation of the world with all spheres
  double coldSeconds = 0;    ///< first detection, including the broad phase
  double warmSeconds = 0;    ///< later detection with kept pairs and fixed spheres; median
};

/// Empty if built without Bullet.
std::string bulletVersion();

/// Collision detection by btCollisionWorld with a btDbvtBroadphase, one thread, single precision. `positions` and
/// `diameter` in any unit. Throws base::InputError if built without Bullet.
BulletFigures benchBullet(const std::vector<base::Vec3f>& positions, float diameter, int repeats);

} // namespace grouser::bench
