// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/vec.hpp"

#include <vector>

namespace grouser::scene {
struct Scene;
} // namespace grouser::scene

namespace grouser::setup {

/// The planes of a scene, which are unbounded, and the box in which pictures show them.
struct DrawnPlanes {
  struct Plane {
    base::Vec3d normal; ///< unit
    double offset{};    ///< normal . x on it [m]
    bool wall{};        ///< without motion and name
  };
  std::vector<Plane> planes; ///< in the order of the file
  base::Vec3d low, high;     ///< [m]
};
DrawnPlanes drawnPlanes(const scene::Scene& scene);

} // namespace grouser::setup
