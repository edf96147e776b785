// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "terrain/node_weights.hpp"

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
  double distance{}; ///< signed [m], positive above; a sphere of radius R centred there has the overlap R - distance
};

/// Rigid surface z = h(x, y) through heights on a grid: tensor product of Catmull-Rom cubics (Catmull, Rom 1974), of
/// cubics with limited slopes, or bilinear. Non-owning view of plain pointers and scalars, passed to kernels by value;
/// the data must outlive it. Beyond the border the surface is extrapolated along its tangent.
struct HeightFieldView {
  const double* heights{};    ///< [columns * rows] [m], row by row, row 0 at the smallest y
  const NodeSlopes* slopes{}; ///< [columns * rows] for monotone interpolation; else null
  int columns{}, rows{};      ///< >= 2
  double xMin{}, yMin{};      ///< position of heights[0] [m]
  double dx{}, dy{};          ///< spacing [m]
  double slopeBound{};        ///< upper bound of |gradient| within the grid [-]
  Interpolation interpolation{Interpolation::smooth};
  /// [(columns - 1) * (rows - 1)] for FeetSearch; null if no hollow is tighter than the spheres in use.
  const std::uint8_t* marks{};
  const double* tops{}; ///< [(columns - 1) * (rows - 1)] upper bound of the height of each cell [m]

  static constexpr int kFootIterations = 16; ///< maximum; usually 2 or 3

  GROUSER_HD SurfaceJet jet(double x, double y) const {
    if (interpolation != Interpolation::smooth) return jetInCell(cellX(x), cellY(y), x, y);
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
    return perMetre(s);
  }

  /// Height of the surface [m]; bitwise equal to jet().h.
  GROUSER_HD double height(double x, double y) const {
    if (interpolation != Interpolation::smooth) return jet(x, y).h;
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

  /// Index of the cell that contains a coordinate, or of the nearest cell.
  GROUSER_HD int cellX(double x) const { return cellAt((x - xMin) / dx, columns - 1); }
  GROUSER_HD int cellY(double y) const { return cellAt((y - yMin) / dy, rows - 1); }

  /// Jet of the patch of cell (i, j), also valid beyond the cell; not for smooth interpolation.
  GROUSER_HD SurfaceJet jetInCell(int i, int j, double x, double y) const {
    const double u = (x - xMin) / dx, v = (y - yMin) / dy;
    const CellWeights cx = slopes ? hermiteWeights(u, i, columns - 1) : lineWeights(u, i);
    const CellWeights cy = slopes ? hermiteWeights(v, j, rows - 1) : lineWeights(v, j);
    SurfaceJet s;
    for (int b = 0; b < 2; ++b) {
      // Along the row: interpolate the heights, and the slopes across it.
      double w = 0, d = 0, dd = 0, wAcross = 0, dAcross = 0, ddAcross = 0;
      for (int a = 0; a < 2; ++a) {
        const std::int64_t node = static_cast<std::int64_t>(cy.first + b) * columns + cx.first + a;
        const double z = heights[node];
        const NodeSlopes m = slopes ? slopes[node] : NodeSlopes{};
        w += cx.v[a] * z + cx.s[a] * m.x, wAcross += cx.v[a] * m.y + cx.s[a] * m.xy;
        d += cx.dv[a] * z + cx.ds[a] * m.x, dAcross += cx.dv[a] * m.y + cx.ds[a] * m.xy;
        dd += cx.ddv[a] * z + cx.dds[a] * m.x, ddAcross += cx.ddv[a] * m.y + cx.dds[a] * m.xy;
      }
      s.h += cy.v[b] * w + cy.s[b] * wAcross;
      s.hx += cy.v[b] * d + cy.s[b] * dAcross, s.hy += cy.dv[b] * w + cy.ds[b] * wAcross;
      s.hxx += cy.v[b] * dd + cy.s[b] * ddAcross, s.hxy += cy.dv[b] * d + cy.ds[b] * dAcross;
      s.hyy += cy.ddv[b] * w + cy.dds[b] * wAcross;
    }
    return perMetre(s);
  }

  /// Conservative test that a sphere of `radius` [m] at `p` does not touch the surface: one look-up instead of a
  /// search. A point is at least (p.z - h) / sqrt(1 + L^2) from a surface of maximum slope L; not used near the border.
  GROUSER_HD bool clearOf(const Vec3d& p, double radius) const {
    const bool inside = p.x - radius >= xMin && p.x + radius <= xMin + (columns - 1) * dx && p.y - radius >= yMin &&
                        p.y + radius <= yMin + (rows - 1) * dy;
    return inside && p.z - height(p.x, p.y) > radius * sqrt(1 + slopeBound * slopeBound);
  }

  /// Foot point of `p`: a local minimum of the distance, found by descent from the point below (or above) `p`. It is
  /// the global minimum if |distance| is less than the smallest radius of curvature on the side of `p`.
  ///
  /// Minimises q = |(x, y, h(x, y)) - p|^2 / 2 by damped Newton steps; the gradient of q is
  ///   (x - px + e hx, y - py + e hy), e = h - pz, and its Hessian I + grad h grad h^T + e hess h.
  /// The last term is omitted if it would make the Hessian indefinite (Gauss-Newton). A step that does not reduce q
  /// is quartered. A step below 1e-6 of a cell is the last one and is linearised, since its effect on q is
  /// negligible. The error of `distance` is of second order in the error of the foot point. On ground too rough for
  /// the search (hollows tighter than |distance|) `distance` still has the correct sign and never exceeds the height
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

    // A gap that is not perpendicular to the surface, or on its wrong side: this is only the nearest point found.
    const double length = base::norm(gap);
    if (length > 10 * converged && side * foot.distance < 0.9 * length) {
      foot.distance = side * length;
      foot.normal = gap * (1 / foot.distance);
    }
    return foot;
  }

private:
  GROUSER_HD static int clamp(int i, int n) { return i < 0 ? 0 : i < n ? i : n - 1; }
  /// Clamps first, since values beyond the integer range, or NaN, must not be converted.
  GROUSER_HD static int cellAt(double u, int cells) {
    return !(u > 0) ? 0 : u < cells ? static_cast<int>(u) : cells - 1;
  }
  /// Converts derivatives per cell to derivatives per metre.
  GROUSER_HD SurfaceJet perMetre(SurfaceJet s) const {
    s.hx /= dx, s.hy /= dy;
    s.hxx /= dx * dx, s.hxy /= dx * dy, s.hyy /= dy * dy;
    return s;
  }
  GROUSER_HD static double squaredDistance(const Vec3d& p, double x, double y, double z) {
    return (x - p.x) * (x - p.x) + (y - p.y) * (y - p.y) + (z - p.z) * (z - p.z);
  }
};

/// Bounds of a height field over its grid, from the control net of each bicubic cell. They are never too small. They
/// are too large by 5 (slope) to 20 (curvature) per cent on smooth ground, and by up to a factor of three on noise. The
/// tangent extrapolation beyond the border is not included.
struct HeightFieldBounds {
  double lowest{}, highest{}; ///< [m]
  double slope{};             ///< |gradient| [-]
  /// Maximum curvature of the hollows [1/m]; spheres larger than its inverse may have several contacts. Infinite at
  /// creases of bilinear ground, concave or not.
  double valleyCurvature{};
};

/// Immutable height field over a rectangle.
class HeightField {
public:
  /// `heights`: columns x rows, row by row, row 0 at `area.yMin` [m]; the border nodes are on the sides of the
  /// rectangle. Throws InputError for fewer than 2 nodes per side, an empty rectangle, or a height that is not finite.
  /// If all heights are in one plane, all interpolations coincide and the smooth one is used.
  HeightField(const Rectangle& area, int columns, int rows, std::vector<double> heights,
              Interpolation interpolation = Interpolation::smooth);

  /// Level surface at `z` [m].
  static HeightField flat(const Rectangle& area, double z);
  /// Plane h = z + slopeX x + slopeY y, with x = y = 0 at the world origin.
  static HeightField plane(const Rectangle& area, double z, double slopeX, double slopeY);
  /// Samples the nodes from a function h(x, y) [m].
  template <class F> static HeightField sample(const Rectangle& area, int columns, int rows, F&& h) {
    std::vector<double> heights;
    for (int j = 0; j < rows; ++j)
      for (int i = 0; i < columns; ++i)
        heights.push_back(h(area.xMin + area.width() * i / (columns - 1), area.yMin + area.length() * j / (rows - 1)));
    return HeightField(area, columns, rows, std::move(heights));
  }

  /// Returns the same surface raised by `dz` [m].
  HeightField raised(double dz) const;

  /// View for kernels; valid while this object exists and is not moved from.
  HeightFieldView view() const;
  const Rectangle& area() const { return area_; }
  int columns() const { return columns_; }
  int rows() const { return rows_; }
  const std::vector<double>& heights() const { return heights_; }
  Interpolation interpolation() const { return interpolation_; }    ///< smooth if all nodes are in one plane
  bool isPlane() const { return isPlane_; }                         ///< true if all nodes lie in one plane
  const std::vector<NodeSlopes>& slopes() const { return slopes_; } ///< empty unless monotone
  const HeightFieldBounds& bounds() const { return bounds_; }
  /// Returns the bounds of one cell.
  HeightFieldBounds boundsOfCell(int i, int j) const;
  /// Returns the bounds over all cells that overlap `part`.
  HeightFieldBounds boundsOver(const Rectangle& part) const;

  double height(double x, double y) const { return view().height(x, y); }
  FootPoint closestPoint(const Vec3d& p) const { return view().closestPoint(p); }

private:
  Rectangle area_;
  int columns_, rows_;
  std::vector<double> heights_;
  Interpolation interpolation_;
  bool isPlane_;
  std::vector<NodeSlopes> slopes_;
  HeightFieldBounds bounds_;
};

} // namespace grouser::terrain
