// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "contact/part_motion.hpp"
#include "contact/surface_geometry.hpp"

#include <functional>
#include <optional>

namespace grouser::scm {

using base::Vec3d;

/// Rigid body described by the distance to its surface.
struct Solid {
  int part{};     ///< index of its part
  Vec3d half;     ///< half size of its bounding box, centred at the origin of the part's frame [m]
  bool isRound{}; ///< true: body of revolution about the z axis
  bool isBall{};  ///< true: sphere, with a round contact area in every orientation
  /// Gap from a point in the part frame to the surface; its distance must not exceed the true distance.
  std::function<contact::SurfaceGap(const Vec3d& p_P)> gap{};
};

/// Downward-facing point of a body.
struct Underside {
  double z{};   ///< [m]
  Vec3d normal; ///< outward normal, world
};

/// Width b of Bekker's relation in the current orientation [m]: smaller horizontal side, or radius of a round area.
double breadthOf(const Solid& solid, const contact::PartMotion& motion);

/// Lowest points of a body on vertical lines, by sphere tracing. Error: below 1e-9 of its size. Both constructor
/// arguments must outlive it.
class Undersides {
public:
  Undersides(const Solid& solid, const contact::PartMotion& motion);

  /// Returns the lowest point below `ceiling` [m]; empty if the line misses the body. `clearance` receives a lower
  /// bound of the distance between line and body below the ceiling [m].
  std::optional<Underside> lowestAt(double x, double y, double ceiling, double* clearance = nullptr) const;
  const Vec3d& half() const { return half_; } ///< half extents of the bounding box along the world's axes [m]

private:
  const Solid& solid_;
  const contact::PartMotion& motion_;
  Vec3d half_, up_; ///< up: vertical in the part frame
  double near_;     ///< [m] distance that counts as contact
};

} // namespace grouser::scm
