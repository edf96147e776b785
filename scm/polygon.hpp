// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/vec.hpp"

#include <cmath>
#include <cstddef>
#include <vector>

namespace grouser::scm {

/// Convex polygon over a plane, with a linear quantity: x and y are the place, z is the quantity.
using Polygon = std::vector<base::Vec3d>;

/// Part of a polygon where `value` >= 0; `value` must be linear.
template <class Value> void clip(const Polygon& from, const Value& value, Polygon& to) {
  to.clear();
  for (std::size_t k = 0; k < from.size(); ++k) {
    const base::Vec3d &a = from[k], &b = from[k + 1 < from.size() ? k + 1 : 0];
    const double at = value(a), next = value(b);
    if (at >= 0) to.push_back(a);
    if ((at >= 0) != (next >= 0)) to.push_back(a + (b - a) * (at / (at - next)));
  }
}

/// Area of a polygon, and the mean of its points.
struct PolygonMean {
  double area{};
  base::Vec3d mean;
};

/// Calls look(area, a, b, c) for the triangles of a polygon; area >= 0.
template <class Look> void forEachTriangle(const Polygon& polygon, const Look& look) {
  for (std::size_t k = 1; k + 1 < polygon.size(); ++k) {
    const base::Vec3d &a = polygon[0], &b = polygon[k], &c = polygon[k + 1];
    look(0.5 * std::fabs((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x)), a, b, c);
  }
}

inline PolygonMean meanOf(const Polygon& polygon) {
  PolygonMean m;
  forEachTriangle(polygon, [&](double area, const base::Vec3d& a, const base::Vec3d& b, const base::Vec3d& c) {
    m.area += area, m.mean += (a + b + c) * (area / 3);
  });
  if (m.area > 0) m.mean *= 1 / m.area;
  return m;
}

} // namespace grouser::scm
