// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/vec.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace grouser::bench {

/// What sequential Bullet needs to find the contacts of equal spheres.
struct BulletFigures {
  std::int64_t contacts = 0; ///< pairs of spheres whose surfaces cross, each once
  double setUpSeconds = 0;   ///< to make its world and put the spheres into it
  double coldSeconds = 0;    ///< of the first detection, which finds the pairs of boxes
  double warmSeconds = 0;    ///< of a later one of spheres that have not moved, whose pairs are kept; median
};

/// Empty where this program was built without Bullet.
std::string bulletVersion();

/// Collision detection by btCollisionWorld with a btDbvtBroadphase, one thread, single precision. `positions` and
/// `diameter` in any unit. Throws base::InputError where there is no Bullet.
BulletFigures benchBullet(const std::vector<base::Vec3f>& positions, float diameter, int repeats);

} // namespace grouser::bench
