// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "contact/patch_lanes.hpp"
#include "terrain/height_field.hpp"

#include <vector>

namespace grouser::terrain {

/// Foot point search on a smooth or monotone height field for eight spheres at a time. Results agree with
/// HeightFieldView::closestPoint() to rounding.
class FootLanes {
public:
  /// Height [m] and slopes per cell [m] of a node, adjacent in memory.
  struct Node {
    double h, x, y, xy;
  };

  FootLanes() = default;
  /// Copies the nodes of `view`; its marks must outlive this object.
  explicit FootLanes(const HeightFieldView& view);

  /// Finds outward normals and overlaps [m] of spheres at `centre` [m] with `radius` [m]; an overlap <= 0 means no
  /// contact. Returns the bit mask of solved lanes. Other lanes need the scalar search: near hollows, at the border,
  /// and where the iteration fails.
  unsigned find(const contact::Vec3P& centre, const contact::PointLanes& radius, contact::Vec3P& normal,
                contact::PointLanes& overlap) const;

private:
  HeightFieldView view_;
  std::vector<Node> nodes_; ///< [row][column]; empty for bilinear fields
};

} // namespace grouser::terrain
