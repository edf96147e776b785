// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "coupling/surface_setup.hpp"

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

namespace grouser::coupling {

/// Surface at rest for contact with the parts of a vehicle and bodies.
struct Obstacle {
  SurfaceSetup surface;
  double friction{};                        ///< [-] with shoes, wheels and hull; bodies have a FoundationTable
  std::optional<std::size_t> amongSurfaces; ///< index in surfacesOf(); empty: a plane that is a wall for grains
};

/// Height of the upper side of a plane, box, solid cylinder or mesh over (x, y) [m]; -infinity beside it, and for
/// hollow cylinders and planes that do not face upward.
double topOf(const SurfaceSetup& surface, double x, double y);

/// Ground heights including the tops of obstacles that stand on or in the ground: those with their lowest point at most
/// 5 cm above the ground at their middle.
std::function<double(double, double)> withObstacles(const std::function<double(double, double)>& ground,
                                                    const std::vector<Obstacle>& obstacles);

} // namespace grouser::coupling
