// SPDX-License-Identifier: BSD-3-Clause
#include "spheredecomp/detail/polygon.hpp"

#include <algorithm>
#include <cmath>

namespace grouser::spheredecomp::detail {
namespace {

using base::Vec3d;

/// Maximum number of corners up to which ears are compared; the cost of the comparison is cubic.
constexpr std::size_t kMaxCompared = 64;

struct Point {
  double x, y;
  bool operator==(const Point&) const = default;
};

/// Twice the signed area of abc, positive for a left turn.
double turn(const Point& a, const Point& b, const Point& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}
double length2(const Point& a, const Point& b) { return (b.x - a.x) * (b.x - a.x) + (b.y - a.y) * (b.y - a.y); }

/// Twice the vector area (Newell); a normal of the face, also if it is not convex.
Vec3d vectorArea(const std::vector<Vec3d>& corners) {
  Vec3d sum;
  for (std::size_t k = 1; k + 1 < corners.size(); ++k)
    sum += cross(corners[k] - corners[0], corners[k + 1] - corners[0]);
  return sum;
}

/// Projects the outline, anticlockwise, along the axis nearest to its normal. Coordinates are not changed, so that
/// corners on a straight side are found exactly.
std::vector<Point> projected(const std::vector<Vec3d>& corners) {
  const Vec3d n = vectorArea(corners);
  const int axis = std::fabs(n.x) >= std::fabs(n.y) && std::fabs(n.x) >= std::fabs(n.z) ? 0
                   : std::fabs(n.y) >= std::fabs(n.z)                                   ? 1
                                                                                        : 2;
  int u = (axis + 1) % 3, v = (axis + 2) % 3;
  if (n[axis] < 0) std::swap(u, v);
  std::vector<Point> points;
  for (const Vec3d& c : corners) points.push_back({c[u], c[v]});
  return points;
}

class EarClipper {
public:
  explicit EarClipper(std::vector<Point> points) : points_(std::move(points)) {
    double size2 = 0;
    for (std::uint32_t k = 0; k < points_.size(); ++k) {
      left_.push_back(k);
      size2 = std::max(size2, length2(points_[0], points_[k]));
    }
    // A corner that deviates from a straight side by the rounding of the file counts as a corner on the side.
    flat_ = 1e-7 * std::sqrt(size2);
  }

  bool clipAll() {
    while (left_.size() > 3) {
      const std::size_t best = bestEar();
      if (best == left_.size()) return false;
      clip(best);
    }
    clip(1);
    return true;
  }
  double clippedArea() const { return area_; }
  const std::vector<std::array<std::uint32_t, 3>>& triangles() const { return triangles_; }

private:
  const Point& at(std::size_t k) const { return points_[left_[k % left_.size()]]; }

  /// Minimum height of a triangle [m].
  double height(const Point& a, const Point& b, const Point& c) const {
    const double longest2 = std::max({length2(a, b), length2(b, c), length2(c, a)});
    return longest2 > 0 ? turn(a, b, c) / std::sqrt(longest2) : 0;
  }

  /// True if a point is on the line from a to b or to the left of it.
  bool isLeftOf(const Point& a, const Point& b, const Point& p) const {
    return turn(a, b, p) >= -flat_ * std::sqrt(length2(a, b));
  }

  /// True if the ear at b can be clipped: no other corner is in the triangle or on its sides, except their ends.
  bool isFree(std::size_t ear) const {
    const std::size_t n = left_.size();
    const Point &a = at(ear + n - 1), &b = at(ear), &c = at(ear + 1);
    for (std::size_t k = 2; k + 1 < n; ++k) {
      const Point& p = at(ear + k);
      if (p == a || p == b || p == c) {
        // A corner at the end of a bridge occurs twice: no other side may enter the ear from this corner.
        if (leadsInto(ear + k, a, b, c)) return false;
        continue;
      }
      if (isLeftOf(a, b, p) && isLeftOf(b, c, p) && isLeftOf(c, a, p)) return false;
    }
    return true;
  }
  bool leadsInto(std::size_t k, const Point& a, const Point& b, const Point& c) const {
    // A point is strictly inside if it is not on or to the left of any reversed side.
    const auto inside = [&](const Point& p) { return !isLeftOf(b, a, p) && !isLeftOf(c, b, p) && !isLeftOf(a, c, p); };
    const Point& from = at(k);
    const auto beginsInside = [&](const Point& end) { // a short step along the side
      return inside({from.x + 0.01 * (end.x - from.x), from.y + 0.01 * (end.y - from.y)});
    };
    return beginsInside(at(k + left_.size() - 1)) || beginsInside(at(k + 1));
  }

  /// Returns the ear with the largest minimum height, or for very large faces the first ear; a degenerate ear only if
  /// no other remains, as for collinear corners. Returns left_.size() if there is no ear.
  std::size_t bestEar() const {
    const std::size_t n = left_.size();
    std::size_t best = n, empty = n;
    double bestHeight = flat_;
    for (std::size_t k = 0; k < n; ++k) {
      const Point &a = at(k + n - 1), &b = at(k), &c = at(k + 1);
      const double h = height(a, b, c);
      if (h > bestHeight && isFree(k)) best = k, bestHeight = h;
      if (best < n && n > kMaxCompared) break;
      if (std::fabs(h) <= flat_ && empty == n) empty = k;
    }
    return best < n ? best : empty;
  }

  void clip(std::size_t ear) {
    const std::size_t n = left_.size();
    triangles_.push_back({left_[(ear + n - 1) % n], left_[ear], left_[(ear + 1) % n]});
    area_ += std::fabs(turn(at(ear + n - 1), at(ear), at(ear + 1)));
    left_.erase(left_.begin() + static_cast<std::ptrdiff_t>(ear));
  }

  std::vector<Point> points_;
  std::vector<std::uint32_t> left_; ///< corners not yet clipped, in order
  std::vector<std::array<std::uint32_t, 3>> triangles_;
  double flat_{}, area_{};
};

} // namespace

bool isConvex(const std::vector<Vec3d>& corners) {
  const std::vector<Point> points = projected(corners);
  const std::size_t n = points.size();
  double size2 = 0;
  for (const Point& p : points) size2 = std::max(size2, length2(points[0], p));
  const double rounding = 1e-7 * size2; // rounding of float coordinates
  // A polygon with left turns only may wind twice, like a pentagram; then a triangle of the fan has negative area.
  for (std::size_t k = 0; k < n; ++k)
    if (!(turn(points[k], points[(k + 1) % n], points[(k + 2) % n]) > rounding)) return false;
  for (std::size_t k = 1; k + 1 < n; ++k)
    if (!(turn(points[0], points[k], points[k + 1]) > 0)) return false;
  return true;
}

std::vector<std::array<std::uint32_t, 3>> triangulate(const std::vector<Vec3d>& corners) {
  if (corners.size() < 3) return {};
  if (corners.size() == 3) return {{0, 1, 2}};
  const std::vector<Point> points = projected(corners);
  EarClipper clipper(points);
  if (!clipper.clipAll()) return {};
  double area = 0, size2 = 0;
  for (std::size_t k = 1; k + 1 < points.size(); ++k) {
    area += turn(points[0], points[k], points[k + 1]);
    size2 = std::max({size2, length2(points[0], points[k]), length2(points[0], points[k + 1])});
  }
  // Overlapping triangles have a larger total area than the outline.
  const double rounding = 1e-6 * size2;
  return std::fabs(clipper.clippedArea() - area) <= rounding ? clipper.triangles()
                                                             : std::vector<std::array<std::uint32_t, 3>>{};
}

} // namespace grouser::spheredecomp::detail
