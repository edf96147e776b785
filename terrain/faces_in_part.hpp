// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "contact/part_motion.hpp"
#include "contact/point_tree.hpp"
#include "terrain/height_field_cells.hpp"

#include <array>
#include <cmath>
#include <optional>

namespace grouser::terrain {

/// Transforms a world plane to the frame of a part.
inline Plane inPart(const Plane& plane, const contact::PartMotion& part) {
  return {transposedTimes(part.rotation, plane.normal), plane.height - dot(plane.normal, part.origin)};
}

/// True if the box of a node is above the plane. Both are in the part frame.
inline bool clearOf(const Plane& plane, const contact::PointTree::Node& node) {
  const Vec3d &n = plane.normal, &h = node.half;
  return dot(n, node.centre) - plane.height > std::fabs(n.x) * h.x + std::fabs(n.y) * h.y + std::fabs(n.z) * h.z;
}

/// A rigid box in the frame of a part.
class BoxInPart {
public:
  /// `half` edges of the box [m].
  BoxInPart(const Vec3d& half, const contact::PartMotion& box, const contact::PartMotion& part) : half_(half) {
    for (int k = 0; k < 3; ++k) {
      const Vec3d axis{box.rotation.m[0][k], box.rotation.m[1][k], box.rotation.m[2][k]};
      axes_[static_cast<std::size_t>(k)] = transposedTimes(part.rotation, axis);
      offset_[k] = dot(axis, part.origin - box.origin);
    }
  }

  bool clearOf(const contact::PointTree::Node& node) const {
    const auto [centre, extent] = place(node);
    for (int k = 0; k < 3; ++k)
      if (std::fabs(centre[k]) - extent[k] > half_[k]) return true;
    return false;
  }

  /// Returns the plane of a face if this face is the nearest one for all points of the node.
  std::optional<Plane> faceFor(const contact::PointTree::Node& node) const {
    const auto [centre, extent] = place(node);
    for (int k = 0; k < 3; ++k) {
      const double side = centre[k] < 0 ? -1 : 1, deepest = half_[k] - (std::fabs(centre[k]) - extent[k]);
      bool nearest = deepest < half_[k];
      for (int j = 0; j < 3; ++j)
        if (j != k) nearest = nearest && std::fabs(centre[j]) + extent[j] + std::fmax(deepest, 0) < half_[j];
      if (nearest) return Plane{axes_[static_cast<std::size_t>(k)] * side, half_[k] - side * offset_[k]};
    }
    return {};
  }

private:
  struct Place {
    Vec3d centre, extent;
  };
  /// Bounding box of a node along the axes of this box.
  Place place(const contact::PointTree::Node& node) const {
    Place p;
    for (int k = 0; k < 3; ++k) {
      const Vec3d& a = axes_[static_cast<std::size_t>(k)];
      p.centre[k] = offset_[k] + dot(a, node.centre);
      p.extent[k] = std::fabs(a.x) * node.half.x + std::fabs(a.y) * node.half.y + std::fabs(a.z) * node.half.z;
    }
    return p;
  }

  Vec3d half_, offset_;
  std::array<Vec3d, 3> axes_;
};

} // namespace grouser::terrain
