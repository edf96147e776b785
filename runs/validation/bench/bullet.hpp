// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/vec.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace grouser::bench {

/// Time that Bullet needs on one core to find the contacts of equal spheres.
struct BulletFigures {
  std::int64_t contacts = 0; ///< overlapping pairs, each once
  double setUpSeconds = 0;   ///< time to create the world with all spheres
  double coldSeconds = 0;    ///< time of the first detection, including the broad phase
  double warmSeconds = 0;    ///< median time of later detections, with kept pairs and spheres at rest
};

/// Version of Bullet; empty if grouser was built without Bullet.
std::string bulletVersion();

/// Times collision detection by btCollisionWorld with a btDbvtBroadphase, in one thread and in single precision.
/// `positions` and `diameter`: in the same unit. Throws base::InputError if grouser was built without Bullet.
BulletFigures benchBullet(const std::vector<base::Vec3f>& positions, float diameter, int repeats);

} // namespace grouser::bench
