// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "contact/part_motion.hpp"
#include "contact/surface_geometry.hpp"

#include <functional>
#include <optional>

namespace grouser::scm {

using base::Vec3d;

/// A rigid body by the distance from its surface.
struct Solid {
  int part{};     ///< index of its part
  Vec3d half;     ///< of its bounding box, centred at the origin of the part's frame [m]
  bool isRound{}; ///< about the z axis
  /// Gap from a point in the part's frame to the surface; its distance is at most the true one.
  std::function<contact::SurfaceGap(const Vec3d& p_P)> gap{};
};

/// A point of a body that faces downwards.
struct Underside {
  double z{};   ///< [m]
  Vec3d normal; ///< out of the body, world
};

/// b of Bekker's relation in the present orientation [m]: the smaller horizontal side, or the radius of a round area.
double breadthOf(const Solid& solid, const contact::PartMotion& motion);

/// Lowest points of a body on vertical lines, by steps of the distance to the surface (sphere tracing). Error: below
/// 1e-9 of its size. Both arguments outlive it.
class Undersides {
public:
  Undersides(const Solid& solid, const contact::PartMotion& motion);

  /// Below `ceiling` [m]; empty where the line misses the body. `clearance` receives a lower bound of the distance of
  /// the line from the body below the ceiling [m].
  std::optional<Underside> lowestAt(double x, double y, double ceiling, double* clearance = nullptr) const;
  const Vec3d& half() const { return half_; } ///< half extents of the bounding box along the world's axes [m]

private:
  const Solid& solid_;
  const contact::PartMotion& motion_;
  Vec3d half_, up_; ///< up: the vertical in the part's frame
  double near_;     ///< [m] distance that counts as contact
};

} // namespace grouser::scm
