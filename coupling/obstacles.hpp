// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "coupling/surface_setup.hpp"

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

namespace grouser::coupling {

/// A surface at rest as the parts of a vehicle and bodies meet it.
struct Obstacle {
  SurfaceSetup surface;
  double friction{};                        ///< [-] of shoes, wheels and hull on it; bodies have a FoundationTable
  std::optional<std::size_t> amongSurfaces; ///< its place among surfacesOf(); empty: a plane that is a wall to grains
};

/// Height of the upper side of a plane, box, solid cylinder or mesh over (x, y) [m]; -infinity beside it, and of hollow
/// cylinders and planes that look down or aside.
double topOf(const SurfaceSetup& surface, double x, double y);

/// Heights of a ground with the tops of those obstacles that stand on it or in it: their lowest point lies no more than
/// 5 cm above the ground at their middle. What hangs or spans higher is no ground.
std::function<double(double, double)> withObstacles(const std::function<double(double, double)>& ground,
                                                    const std::vector<Obstacle>& obstacles);

} // namespace grouser::coupling
