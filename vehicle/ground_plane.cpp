// SPDX-License-Identifier: BSD-3-Clause
#include "vehicle/ground_plane.hpp"

#include <algorithm>
#include <cmath>

namespace grouser::vehicle {

GroundPlane groundPlane(const VehicleSpec& spec, double x, double y, double c, double s, const SurfaceHeight& surface) {
  // The grid is symmetric, so that both slopes are independent. Heights are relative to the height of the first point;
  // level ground then has exactly zero slope.
  constexpr int kAlong = 40, kAcross = 2;
  constexpr double kLevel = 1e-9; // [-]
  const double first = spec.roadWheel.firstX - 0.2;
  const double last = spec.roadWheel.firstX + spec.roadWheel.spacing * (spec.roadWheel.count - 1) + 0.2;
  const double middle = 0.5 * (first + last);
  struct Point {
    double ahead, left, height;
  };
  std::vector<Point> points;
  for (const double side : {-1.0, 1.0})
    for (int i = 0; i <= kAlong; ++i)
      for (int j = -kAcross; j <= kAcross; ++j) {
        const double px = first + (last - first) * i / kAlong;
        const double py = side * spec.trackOffset + 0.5 * j * spec.shoe.padHalfWidth;
        points.push_back({px - middle, py, surface(x + c * px - s * py, y + s * px + c * py)});
      }
  const double zero = points.front().height;
  double mean = 0, ahead = 0, left = 0, aheads = 0, lefts = 0;
  for (const Point& p : points) {
    const double h = p.height - zero;
    mean += h, ahead += p.ahead * h, left += p.left * h, aheads += p.ahead * p.ahead, lefts += p.left * p.left;
  }
  mean /= static_cast<double>(points.size()), ahead /= aheads, left /= lefts;
  if (std::fabs(ahead) < kLevel && std::fabs(left) < kLevel) ahead = left = 0;
  GroundPlane plane{ahead, left, zero + mean - ahead * middle, -1e300, -1e300};
  for (const Point& p : points) {
    plane.highest = std::max(plane.highest, p.height - zero - (mean + ahead * p.ahead + left * p.left));
    plane.top = std::max(plane.top, p.height);
  }
  return plane;
}

} // namespace grouser::vehicle
