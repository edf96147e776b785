// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/vec.hpp"

#include <cstdint>
#include <utility>
#include <vector>

namespace grouser::terrain {

using base::Vec3d;

/// Axis-parallel rectangle in the plane [m].
struct Rectangle {
  double xMin{}, xMax{}, yMin{}, yMax{};

  double width() const { return xMax - xMin; }  ///< along x [m]
  double length() const { return yMax - yMin; } ///< along y [m]
};

/// Height and its derivatives at one (x, y).
struct SurfaceJet {
  double h{};                 ///< [m]
  double hx{}, hy{};          ///< [-]
  double hxx{}, hxy{}, hyy{}; ///< [1/m]
};

/// Point of a surface closest to a given point.
struct FootPoint {
  Vec3d point;       ///< on the surface [m]
  Vec3d normal;      ///< unit, outward (up) at `point`
  double distance{}; ///< signed [m], positive above; a sphere of radius R there has the overlap R - distance
};

/// Weights of four consecutive nodes for value, slope and second derivative of a cubic along one axis [cells].
struct CubicWeights {
  int first{}; ///< index of the node that w[0] belongs to; may be -1, with zero weight
  double w[4]{}, d[4]{}, dd[4]{};
};

/// Catmull-Rom weights at `u` [cells] among `n` >= 2 nodes. The missing node beyond either end continues the last two
/// linearly; outside [0, n - 1] the curve is its end tangent. Continuous with its slope everywhere, exact on lines.
GROUSER_HD CubicWeights cubicWeights(double u, int n) {
  CubicWeights c;
  if (!(u >= 0) || u > n - 1) {
    c.first = !(u >= 0) ? -1 : n - 3;
    const double t = u - (c.first + 1);
    c.w[1] = 1 - t, c.w[2] = t;
    c.d[1] = -1, c.d[2] = 1;
    return c;
  }
  const int below = static_cast<int>(u);
  const int i = below < n - 2 ? below : n - 2;
  const double t = u - i;
  c.first = i - 1;
  c.w[0] = 0.5 * t * (t * (2 - t) - 1), c.w[1] = 0.5 * (t * t * (3 * t - 5) + 2);
  c.w[2] = 0.5 * t * (t * (4 - 3 * t) + 1), c.w[3] = 0.5 * t * t * (t - 1);
  c.d[0] = 0.5 * (t * (4 - 3 * t) - 1), c.d[1] = 0.5 * t * (9 * t - 10);
  c.d[2] = 0.5 * (t * (8 - 9 * t) + 1), c.d[3] = 0.5 * t * (3 * t - 2);
  c.dd[0] = 2 - 3 * t, c.dd[1] = 9 * t - 5, c.dd[2] = 4 - 9 * t, c.dd[3] = 3 * t - 1;
  if (i == 0) {
    c.w[1] += 2 * c.w[0], c.w[2] -= c.w[0], c.w[0] = 0;
    c.d[1] += 2 * c.d[0], c.d[2] -= c.d[0], c.d[0] = 0;
    c.dd[1] += 2 * c.dd[0], c.dd[2] -= c.dd[0], c.dd[0] = 0;
  }
  if (i == n - 2) {
    c.w[2] += 2 * c.w[3], c.w[1] -= c.w[3], c.w[3] = 0;
    c.d[2] += 2 * c.d[3], c.d[1] -= c.d[3], c.d[3] = 0;
    c.dd[2] += 2 * c.dd[3], c.dd[1] -= c.dd[3], c.dd[3] = 0;
  }
  return c;
}

/// A smooth rigid surface z = h(x, y) through heights on a grid: tensor product of Catmull-Rom cubics (Catmull, Rom
/// 1974). Plain pointers and scalars, to be passed to kernels by value; `heights` must outlive it. Beyond the border
/// the surface goes on along its tangent.
struct HeightFieldView {
  const double* heights{}; ///< [columns * rows] [m], row by row, row 0 at the smallest y
  int columns{}, rows{};   ///< >= 2
  double xMin{}, yMin{};   ///< position of heights[0] [m]
  double dx{}, dy{};       ///< spacing [m]
  double slopeBound{};     ///< largest |gradient| within the grid, from above [-]

  static constexpr int kFootIterations = 16; ///< at most; 2 or 3 are usual

  GROUSER_HD SurfaceJet jet(double x, double y) const {
    const CubicWeights cx = cubicWeights((x - xMin) / dx, columns);
    const CubicWeights cy = cubicWeights((y - yMin) / dy, rows);
    SurfaceJet s;
    for (int b = 0; b < 4; ++b) {
      const double* row = heights + static_cast<std::int64_t>(clamp(cy.first + b, rows)) * columns;
      double w = 0, d = 0, dd = 0;
      for (int a = 0; a < 4; ++a) {
        const double z = row[clamp(cx.first + a, columns)];
        w += cx.w[a] * z, d += cx.d[a] * z, dd += cx.dd[a] * z;
      }
      s.h += cy.w[b] * w;
      s.hx += cy.w[b] * d, s.hy += cy.d[b] * w;
      s.hxx += cy.w[b] * dd, s.hxy += cy.d[b] * d, s.hyy += cy.dd[b] * w;
    }
    s.hx /= dx, s.hy /= dy;
    s.hxx /= dx * dx, s.hxy /= dx * dy, s.hyy /= dy * dy;
    return s;
  }

  /// Height of the surface [m]; the same bits as jet().h.
  GROUSER_HD double height(double x, double y) const {
    const CubicWeights cx = cubicWeights((x - xMin) / dx, columns);
    const CubicWeights cy = cubicWeights((y - yMin) / dy, rows);
    double h = 0;
    for (int b = 0; b < 4; ++b) {
      const double* row = heights + static_cast<std::int64_t>(clamp(cy.first + b, rows)) * columns;
      double w = 0;
      for (int a = 0; a < 4; ++a) w += cx.w[a] * row[clamp(cx.first + a, columns)];
      h += cy.w[b] * w;
    }
    return h;
  }

  /// True when a sphere of `radius` [m] about `p` surely does not touch the surface: one look-up instead of the search.
  /// A surface no steeper than L keeps the distance (p.z - h) / sqrt(1 + L^2); near the border the bound is not used.
  GROUSER_HD bool clearOf(const Vec3d& p, double radius) const {
    const bool inside = p.x - radius >= xMin && p.x + radius <= xMin + (columns - 1) * dx && p.y - radius >= yMin &&
                        p.y + radius <= yMin + (rows - 1) * dy;
    return inside && p.z - height(p.x, p.y) > radius * sqrt(1 + slopeBound * slopeBound);
  }

  /// The foot point of `p`: a minimum of the distance, reached downhill from the point below (or above) `p`. It is the
  /// nearest point of all while |distance| is less than the surface's smallest radius of curvature on the side of `p`.
  ///
  /// Minimises q = |(x, y, h(x, y)) - p|^2 / 2 by damped Newton steps; the gradient of q is
  ///   (x - px + e hx, y - py + e hy), e = h - pz, and its Hessian I + grad h grad h^T + e hess h.
  /// Its last term is left out where it would spoil positive definiteness (Gauss-Newton). A step that does not lower q
  /// is quartered. A step below 1e-6 of a cell is the last, and taken along the derivatives at hand: q no longer feels
  /// it. The error of `distance` is of second order in the error of the foot. On ground too rough for the search
  /// (hollows tighter than |distance|) `distance` still has the right sign and is never more than the height
  /// difference.
  GROUSER_HD FootPoint closestPoint(const Vec3d& p) const {
    const double converged = 1e-6 * (dx < dy ? dx : dy);
    double x = p.x, y = p.y, stepX = 0, stepY = 0;
    SurfaceJet s = jet(x, y);
    const double side = p.z < s.h ? -1 : 1;
    bool fresh = true;
    for (int k = 0; k < kFootIterations; ++k) {
      const double e = s.h - p.z;
      if (fresh) {
        const double gx = x - p.x + e * s.hx, gy = y - p.y + e * s.hy;
        double a = 1 + s.hx * s.hx + e * s.hxx, b = s.hx * s.hy + e * s.hxy, c = 1 + s.hy * s.hy + e * s.hyy;
        if (!(a > 0 && a * c - b * b > 0.05)) a = 1 + s.hx * s.hx, b = s.hx * s.hy, c = 1 + s.hy * s.hy;
        const double det = a * c - b * b;
        stepX = (b * gy - c * gx) / det, stepY = (b * gx - a * gy) / det;
      }
      if (stepX * stepX + stepY * stepY <= converged * converged) {
        x += stepX, y += stepY;
        s.h += s.hx * stepX + s.hy * stepY;
        s.hx += s.hxx * stepX + s.hxy * stepY, s.hy += s.hxy * stepX + s.hyy * stepY;
        break;
      }
      const SurfaceJet trial = jet(x + stepX, y + stepY);
      fresh = squaredDistance(p, x + stepX, y + stepY, trial.h) < squaredDistance(p, x, y, s.h);
      if (fresh)
        x += stepX, y += stepY, s = trial;
      else
        stepX *= 0.25, stepY *= 0.25;
    }
    FootPoint foot;
    foot.point = {x, y, s.h};
    foot.normal = base::normalized(Vec3d{-s.hx, -s.hy, 1.0});
    const Vec3d gap = p - foot.point;
    foot.distance = base::dot(gap, foot.normal);

    // Not perpendicular, or on the wrong side: no foot point, but the nearest that was found.
    const double length = base::norm(gap);
    if (length > 10 * converged && side * foot.distance < 0.9 * length) {
      foot.distance = side * length;
      foot.normal = gap * (1 / foot.distance);
    }
    return foot;
  }

private:
  GROUSER_HD static int clamp(int i, int n) { return i < 0 ? 0 : i < n ? i : n - 1; }
  GROUSER_HD static double squaredDistance(const Vec3d& p, double x, double y, double z) {
    return (x - p.x) * (x - p.x) + (y - p.y) * (y - p.y) + (z - p.z) * (z - p.z);
  }
};

/// Bounds of a height field over its grid, from the control net of each bicubic cell: never too small; on smooth ground
/// too large by 5 (slope) to 20 (curvature) per cent, on noise up to threefold. The tangent continuation beyond the
/// border is not included. The surface may swing beyond its nodes' range by some per cent of a step between them.
struct HeightFieldBounds {
  double lowest{}, highest{}; ///< [m]
  double slope{};             ///< |gradient| [-]
  double valleyCurvature{};   ///< of the hollows [1/m]; a sphere larger than 1 / this may touch twice
};

/// Owner of the heights of a surface over a rectangle. Immutable.
class HeightField {
public:
  /// `heights`: columns x rows, row by row, row 0 at `area.yMin` [m]; the nodes of the border lie on the rectangle's
  /// sides. InputError: fewer than 2 nodes a side, a rectangle without area, a height that is no finite number.
  HeightField(const Rectangle& area, int columns, int rows, std::vector<double> heights);

  /// Level surface at `z` [m].
  static HeightField flat(const Rectangle& area, double z);
  /// Plane h = z + slopeX x + slopeY y, where x = y = 0 is the world's origin.
  static HeightField plane(const Rectangle& area, double z, double slopeX, double slopeY);
  /// Nodes from a function h(x, y) [m].
  template <class F> static HeightField sample(const Rectangle& area, int columns, int rows, F&& h) {
    std::vector<double> heights;
    for (int j = 0; j < rows; ++j)
      for (int i = 0; i < columns; ++i)
        heights.push_back(h(area.xMin + area.width() * i / (columns - 1), area.yMin + area.length() * j / (rows - 1)));
    return HeightField(area, columns, rows, std::move(heights));
  }

  /// The same surface, `dz` [m] higher.
  HeightField raised(double dz) const;

  /// For kernels; valid while this object lives and is not moved from.
  HeightFieldView view() const;
  const Rectangle& area() const { return area_; }
  int columns() const { return columns_; }
  int rows() const { return rows_; }
  const std::vector<double>& heights() const { return heights_; }
  const HeightFieldBounds& bounds() const { return bounds_; }
  /// Bounds over the cells that `part` touches.
  HeightFieldBounds boundsOver(const Rectangle& part) const;

  double height(double x, double y) const { return view().height(x, y); }
  FootPoint closestPoint(const Vec3d& p) const { return view().closestPoint(p); }

private:
  Rectangle area_;
  int columns_, rows_;
  std::vector<double> heights_;
  HeightFieldBounds bounds_;
};

} // namespace grouser::terrain
