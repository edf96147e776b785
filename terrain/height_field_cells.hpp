// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "terrain/height_field.hpp"

#include <cstdint>
#include <vector>

namespace grouser::terrain {

/// Plane normal . x = height.
struct Plane {
  Vec3d normal;  ///< unit, outward
  double height; ///< [m]
};

/// Height bounds and planes of the cells of a height field, for box tests on the host.
class HeightFieldCells {
public:
  HeightFieldCells() = default;
  explicit HeightFieldCells(const HeightField& field);

  /// True if a box in world axes may reach below the height bounds of the cells under it. Always true beyond the
  /// border, where the height field is extrapolated along its slope, and for a box over many cells that is not above
  /// the highest of them.
  bool near(const Vec3d& low, const Vec3d& high) const;

  struct Under {
    const Plane* plane; ///< contains the nearest surface points of all points in the box; null: no such plane
    double curvature;   ///< upper bound of the largest eigenvalue of the height's Hessian under the box, >= 0 [1/m]
  };
  /// Returns the plane and curvature bound of the surface under a box in world axes.
  Under under(const Vec3d& low, const Vec3d& high) const;

private:
  struct Range {
    int i0, i1, j0, j1;

    int cells() const { return (i1 - i0 + 1) * (j1 - j0 + 1); }
  };
  std::int32_t listed(const Vec3d& corner, double hx, double hy);
  bool contains(double x0, double x1, double y0, double y1) const;
  Range rangeOf(double x0, double x1, double y0, double y1) const;
  /// Index of the plane common to all cells; -1 if there is none.
  std::int32_t commonPlane(const Range& r) const;
  std::size_t cell(int i, int j) const {
    return static_cast<std::size_t>(j) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(i);
  }

  Rectangle area_;
  int columns_{}, rows_{};            ///< number of cells along x and y
  std::vector<double> tops_;          ///< [cell] upper bound of the height [m]
  std::vector<double> curvatures_;    ///< [cell] as Under::curvature [1/m]
  std::vector<std::int32_t> planeOf_; ///< [cell] plane index of a planar cell; -1: curved, or no listed plane
  std::vector<Plane> planes_;
  double highest_{0};                ///< upper bound of all heights [m]
  double inverseDx_{}, inverseDy_{}; ///< [1/m]
};

} // namespace grouser::terrain
