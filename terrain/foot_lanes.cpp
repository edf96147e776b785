// SPDX-License-Identifier: BSD-3-Clause
#include "terrain/foot_lanes.hpp"

#include "base/math.hpp"
#include "terrain/feet_search.hpp"

#include <algorithm>
#include <cmath>

namespace grouser::terrain {

using base::squareRoot;
using contact::allLanes;
using contact::kPointLanes;
using contact::PointLanes;
using contact::Vec3P;

namespace {

constexpr unsigned kAll = (1u << kPointLanes) - 1;
constexpr int kIterations = 5;

/// Catmull-Rom slope per cell at node `k` of `n`, `stride` apart; one-sided at the ends.
double slopeAt(const double* values, int k, int n, std::ptrdiff_t stride) {
  if (k == 0) return values[stride] - values[0];
  const double* at = values + k * stride;
  return k == n - 1 ? at[0] - at[-stride] : 0.5 * (at[stride] - at[-stride]);
}

/// Hermite weights of the lower [0] and upper [1] node of a cell, of values and slopes, with two derivatives.
struct Weights {
  PointLanes v[2], s[2], dv[2], ds[2], ddv[2], dds[2];

  GROUSER_SIMD explicit Weights(const PointLanes& t) {
    const PointLanes r = 1.0 - t;
    v[0] = (t * 2.0 + 1.0) * r * r, v[1] = t * t * (3.0 - t * 2.0);
    s[0] = t * r * r, s[1] = -(t * t * r);
    dv[1] = t * r * 6.0, dv[0] = -dv[1];
    ds[0] = r * (1.0 - t * 3.0), ds[1] = t * (t * 3.0 - 2.0);
    ddv[0] = t * 12.0 - 6.0, ddv[1] = -ddv[0];
    dds[0] = t * 6.0 - 4.0, dds[1] = t * 6.0 - 2.0;
  }
};

using Mask = decltype(PointLanes{} > PointLanes{});
struct Jet {
  PointLanes h, hx, hy, hxx, hxy, hyy;
};

/// Sets `failed` in lanes beyond the border or near a hollow.
GROUSER_SIMD Jet jetOf(const HeightFieldView& view, const FootLanes::Node* nodes, const PointLanes& x,
                       const PointLanes& y, Mask& failed) {
  const double inverseDx = 1 / view.dx, inverseDy = 1 / view.dy;
  const PointLanes u = (x - view.xMin) * inverseDx, v = (y - view.yMin) * inverseDy;
  const int cellsX = view.columns - 1, cellsY = view.rows - 1;
  PointLanes tx = u, ty = v, n[2][2][4]; // [upper in y][upper in x][quantity]
  for (int l = 0; l < kPointLanes; ++l) {
    if (!(u[l] >= 0 && v[l] >= 0 && u[l] <= cellsX && v[l] <= cellsY)) failed[l] = -1;
    const int i = u[l] > 0 ? std::min(static_cast<int>(std::min(u[l], 1e9)), cellsX - 1) : 0;
    const int j = v[l] > 0 ? std::min(static_cast<int>(std::min(v[l], 1e9)), cellsY - 1) : 0;
    if (view.marks && view.marks[static_cast<std::int64_t>(j) * cellsX + i] & kNearHollow) failed[l] = -1;
    tx[l] = u[l] - i, ty[l] = v[l] - j;
    const FootLanes::Node* const lower = nodes + static_cast<std::ptrdiff_t>(j) * view.columns + i;
    for (int b = 0; b < 2; ++b)
      for (int a = 0; a < 2; ++a) {
        const FootLanes::Node& node = lower[b * view.columns + a];
        n[b][a][0][l] = node.h, n[b][a][1][l] = node.x, n[b][a][2][l] = node.y, n[b][a][3][l] = node.xy;
      }
  }
  const Weights wx(tx), wy(ty);
  Jet s;
  s.h = s.hx = s.hy = s.hxx = s.hxy = s.hyy = allLanes(0);
  for (int b = 0; b < 2; ++b) {
    const auto along = [&](const PointLanes(&value)[2], const PointLanes(&slope)[2], int of) {
      return value[0] * n[b][0][of] + slope[0] * n[b][0][of + 1] +
             (value[1] * n[b][1][of] + slope[1] * n[b][1][of + 1]);
    };
    const PointLanes w = along(wx.v, wx.s, 0), d = along(wx.dv, wx.ds, 0), dd = along(wx.ddv, wx.dds, 0);
    const PointLanes wAcross = along(wx.v, wx.s, 2), dAcross = along(wx.dv, wx.ds, 2),
                     ddAcross = along(wx.ddv, wx.dds, 2);
    s.h += wy.v[b] * w + wy.s[b] * wAcross;
    s.hx += wy.v[b] * d + wy.s[b] * dAcross, s.hy += wy.dv[b] * w + wy.ds[b] * wAcross;
    s.hxx += wy.v[b] * dd + wy.s[b] * ddAcross, s.hxy += wy.dv[b] * d + wy.ds[b] * dAcross;
    s.hyy += wy.ddv[b] * w + wy.dds[b] * wAcross;
  }
  s.hx *= inverseDx, s.hy *= inverseDy;
  s.hxx *= inverseDx * inverseDx, s.hxy *= inverseDx * inverseDy, s.hyy *= inverseDy * inverseDy;
  return s;
}

} // namespace

FootLanes::FootLanes(const HeightFieldView& view) : view_(view) {
  if (view.interpolation == Interpolation::bilinear) return;
  const int columns = view.columns, rows = view.rows;
  const auto n = static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
  std::vector<double> across(view.slopes ? 0 : n); // slopes along y
  for (int j = 0; j < rows && !view.slopes; ++j)
    for (int i = 0; i < columns; ++i)
      across[static_cast<std::size_t>(j) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(i)] =
          slopeAt(view.heights + i, j, rows, columns);
  nodes_.reserve(n);
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      const std::ptrdiff_t row = static_cast<std::ptrdiff_t>(j) * columns, k = row + i;
      if (view.slopes)
        nodes_.push_back({view.heights[k], view.slopes[k].x, view.slopes[k].y, view.slopes[k].xy});
      else
        nodes_.push_back({view.heights[k], slopeAt(view.heights + row, i, columns, 1),
                          across[static_cast<std::size_t>(k)], slopeAt(across.data() + row, i, columns, 1)});
    }
}

GROUSER_SIMD_CLONES unsigned FootLanes::find(const Vec3P& p, const PointLanes& radius, Vec3P& normal,
                                             PointLanes& overlap) const {
  overlap = allLanes(0), normal = allLanes(Vec3d{});
  if (nodes_.empty()) return 0;
  const PointLanes none = allLanes(0);
  const double shorter = std::min(view_.dx, view_.dy), converged = 1e-12 * shorter * shorter;
  // Beyond the border the field is extrapolated along its tangents; their slope is unbounded.
  const double xMax = view_.xMin + (view_.columns - 1) * view_.dx, yMax = view_.yMin + (view_.rows - 1) * view_.dy;
  const Mask border = ~((p.x - radius >= none + view_.xMin) & (p.x + radius <= none + xMax) &
                        (p.y - radius >= none + view_.yMin) & (p.y + radius <= none + yMax));
  Mask failed = border;
  PointLanes x = p.x, y = p.y;
  Jet s = jetOf(view_, nodes_.data(), x, y, failed);
  // A sphere high enough above the surface under its centre cannot touch a surface of bounded slope.
  const Mask near = p.z - s.h <= radius * std::sqrt(1 + view_.slopeBound * view_.slopeBound);
  const Mask below = p.z < s.h;
  Mask open = near & ~failed;
  PointLanes squared = (s.h - p.z) * (s.h - p.z);
  // Newton iteration of HeightFieldView::closestPoint(), undamped.
  for (int k = 0; k < kIterations && base::any(open); ++k) {
    const PointLanes e = s.h - p.z, gx = x - p.x + e * s.hx, gy = y - p.y + e * s.hy;
    const PointLanes a = s.hx * s.hx + e * s.hxx + 1.0, b = s.hx * s.hy + e * s.hxy, c = s.hy * s.hy + e * s.hyy + 1.0;
    const PointLanes det = a * c - b * b;
    const Mask convex = (a > none) & (det > none + 0.05);
    failed |= open & ~convex, open &= convex;
    const PointLanes inverse = 1.0 / (convex ? det : none + 1.0);
    const PointLanes dx = open ? (b * gy - c * gx) * inverse : none, dy = open ? (b * gx - a * gy) * inverse : none;
    // The last step is linearised.
    const Mask last = open & (dx * dx + dy * dy <= none + converged);
    x += dx, y += dy;
    s.h = last ? s.h + s.hx * dx + s.hy * dy : s.h;
    const PointLanes hx = s.hx + s.hxx * dx + s.hxy * dy, hy = s.hy + s.hxy * dx + s.hyy * dy;
    s.hx = last ? hx : s.hx, s.hy = last ? hy : s.hy;
    open &= ~last;
    if (!base::any(open)) break;
    Mask left{};
    const Jet next = jetOf(view_, nodes_.data(), x, y, left);
    const PointLanes ax = x - p.x, ay = y - p.y, az = next.h - p.z, now = ax * ax + ay * ay + az * az;
    const Mask lost = open & (left | ~(now < squared));
    failed |= lost;
    squared = now;
    s.h = open ? next.h : s.h, s.hx = open ? next.hx : s.hx, s.hy = open ? next.hy : s.hy;
    s.hxx = open ? next.hxx : s.hxx, s.hxy = open ? next.hxy : s.hxy, s.hyy = open ? next.hyy : s.hyy;
    open &= ~lost;
  }
  failed |= open;
  const PointLanes inverse = 1.0 / squareRoot(s.hx * s.hx + s.hy * s.hy + 1.0);
  normal = {-s.hx * inverse, -s.hy * inverse, inverse};
  const Vec3P gap{p.x - x, p.y - y, p.z - s.h};
  const PointLanes distance = dot(gap, normal);
  failed |= below ^ (distance < none); // the foot is on the other side of a crest
  overlap = near ? radius - distance : none;
  return ~base::laneBits((failed & near) | border) & kAll;
}

} // namespace grouser::terrain
