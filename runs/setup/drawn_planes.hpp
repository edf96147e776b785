// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/vec.hpp"

#include <vector>

namespace grouser::scene {
struct Scene;
} // namespace grouser::scene

namespace grouser::setup {

/// The (unbounded) planes of a scene, and the box to which pictures clip them.
struct DrawnPlanes {
  struct Plane {
    base::Vec3d normal; ///< unit
    double offset{};    ///< normal . x for points x of the plane [m]
    bool wall{};        ///< fixed, without a name
  };
  std::vector<Plane> planes; ///< in the order of the file
  base::Vec3d low, high;     ///< [m]
};
DrawnPlanes drawnPlanes(const scene::Scene& scene);

} // namespace grouser::setup
