// SPDX-License-Identifier: BSD-3-Clause
#include "terrain/height_field.hpp"

#include "base/error.hpp"
#include "terrain/node_slopes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>

namespace grouser::terrain {

namespace {

using base::InputError;

/// Control points of the cubic between the second and third of four nodes (Hermite to Bezier).
std::array<double, 4> controlPoints(const std::array<double, 4>& h) {
  return {h[1], h[1] + (h[2] - h[0]) / 6, h[2] - (h[3] - h[1]) / 6, h[2]};
}

using Net = std::array<std::array<double, 4>, 4>; ///< [along y][along x]

/// Control net of the bicubic cell with lower left node (i, j); nodes beyond the border are extrapolated linearly.
Net controlNet(const std::vector<double>& heights, int columns, int rows, int i, int j) {
  const auto node = [&](int a, int b) { return heights[static_cast<std::size_t>(b) * columns + a]; };
  const auto inRow = [&](int a, int b) {
    if (a < 0) return 2 * node(0, b) - node(1, b);
    if (a >= columns) return 2 * node(columns - 1, b) - node(columns - 2, b);
    return node(a, b);
  };
  const auto anywhere = [&](int a, int b) {
    if (b < 0) return 2 * inRow(a, 0) - inRow(a, 1);
    if (b >= rows) return 2 * inRow(a, rows - 1) - inRow(a, rows - 2);
    return inRow(a, b);
  };
  Net alongX;
  for (int b = 0; b < 4; ++b)
    alongX[b] = controlPoints(
        {anywhere(i - 1, j - 1 + b), anywhere(i, j - 1 + b), anywhere(i + 1, j - 1 + b), anywhere(i + 2, j - 1 + b)});
  Net net;
  for (int a = 0; a < 4; ++a) {
    const auto column = controlPoints({alongX[0][a], alongX[1][a], alongX[2][a], alongX[3][a]});
    for (int b = 0; b < 4; ++b) net[b][a] = column[b];
  }
  return net;
}

/// Control net of a cell from values and slopes of its nodes; without slopes, the net of the bilinear patch.
Net controlNetOf(const HeightFieldView& v, int i, int j) {
  Net net;
  for (int b = 0; b < 2; ++b)
    for (int a = 0; a < 2; ++a) {
      const auto node = static_cast<std::size_t>(j + b) * v.columns + i + a;
      NodeSlopes m = v.slopes ? v.slopes[node] : NodeSlopes{};
      if (!v.slopes) {
        const auto h = [&](int da, int db) { return v.heights[static_cast<std::size_t>(j + db) * v.columns + i + da]; };
        m = {h(1, b) - h(0, b), h(a, 1) - h(a, 0), h(1, 1) - h(1, 0) - h(0, 1) + h(0, 0)};
      }
      const double sx = a == 0 ? 1 : -1, sy = b == 0 ? 1 : -1, h = v.heights[node];
      const int x = 3 * a, y = 3 * b, xIn = 1 + a, yIn = 1 + b;
      net[y][x] = h, net[y][xIn] = h + sx * m.x / 3, net[yIn][x] = h + sy * m.y / 3;
      net[yIn][xIn] = h + (sx * m.x + sy * m.y) / 3 + sx * sy * m.xy / 9;
    }
  return net;
}

/// True if the surface of bilinear cells is concave inside a cell or along its edges.
bool isCreased(const HeightFieldView& v, int i, int j) {
  const auto h = [&](int a, int b) { return v.heights[static_cast<std::size_t>(b) * v.columns + a]; };
  const double dx = h(i + 1, j) - h(i, j), dy = h(i, j + 1) - h(i, j);
  const double size = std::fabs(h(i, j)) + std::fabs(dx) + std::fabs(dy);
  for (int b = std::max(0, j - 1); b <= std::min(v.rows - 1, j + 2); ++b)
    for (int a = std::max(0, i - 1); a <= std::min(v.columns - 1, i + 2); ++a)
      if (std::fabs(h(i, j) + dx * (a - i) + dy * (b - j) - h(a, b)) > 1e-13 * size) return true;
  return false;
}

/// Widens `bounds` by one cell. A Bezier patch and its derivatives stay within the range of their control nets.
void include(HeightFieldBounds& bounds, const Net& net, double dx, double dy) {
  double hx = 0, hy = 0, hxx = 0, hyy = 0, hxy = 0;
  for (int b = 0; b < 4; ++b)
    for (int a = 0; a < 4; ++a) {
      bounds.lowest = std::min(bounds.lowest, net[b][a]);
      bounds.highest = std::max(bounds.highest, net[b][a]);
      if (a < 3) hx = std::max(hx, std::fabs(3 * (net[b][a + 1] - net[b][a]) / dx));
      if (b < 3) hy = std::max(hy, std::fabs(3 * (net[b + 1][a] - net[b][a]) / dy));
      if (a < 2) hxx = std::max(hxx, 6 * (net[b][a + 2] - 2 * net[b][a + 1] + net[b][a]) / (dx * dx));
      if (b < 2) hyy = std::max(hyy, 6 * (net[b + 2][a] - 2 * net[b + 1][a] + net[b][a]) / (dy * dy));
      if (a < 3 && b < 3)
        hxy = std::max(hxy, std::fabs(9 * (net[b + 1][a + 1] - net[b + 1][a] - net[b][a + 1] + net[b][a]) / (dx * dy)));
    }
  bounds.slope = std::max(bounds.slope, std::sqrt(hx * hx + hy * hy));
  // Gershgorin's bound of the Hessian's largest eigenvalue; the tilt of the surface only lowers a normal curvature.
  bounds.valleyCurvature = std::max(bounds.valleyCurvature, std::max(hxx, hyy) + hxy);
}

} // namespace

HeightField::HeightField(const Rectangle& area, int columns, int rows, std::vector<double> heights,
                         Interpolation interpolation)
    : area_(area), columns_(columns), rows_(rows), heights_(std::move(heights)), interpolation_(interpolation) {
  if (columns < 2 || rows < 2 || heights_.size() != static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows))
    throw InputError(
        fmt::format("height field: {} x {} nodes with {} heights; at least 2 x 2 nodes, each with a height, are needed",
                    columns, rows, heights_.size()));
  if (!(area.width() > 0 && area.length() > 0 && std::isfinite(area.width()) && std::isfinite(area.length())))
    throw InputError(fmt::format("height field: size {} x {} m; both sides must be positive and finite", area.width(),
                                 area.length()));
  const auto bad = std::find_if_not(heights_.begin(), heights_.end(), [](double h) { return std::isfinite(h); });
  if (bad != heights_.end()) {
    const auto index = bad - heights_.begin();
    throw InputError(fmt::format("height field: the height of node column {}, row {} is {}; it must be finite",
                                 index % columns, index / columns, *bad));
  }
  isPlane_ = terrain::isPlane(heights_, columns, rows);
  if (isPlane_) interpolation_ = Interpolation::smooth;
  if (interpolation_ == Interpolation::monotone) slopes_ = monotoneSlopes(heights_, columns, rows);
  bounds_ = boundsOver(area);
}

HeightFieldBounds HeightField::boundsOfCell(int i, int j) const {
  const HeightFieldView v = view();
  HeightFieldBounds bounds;
  bounds.lowest = bounds.highest = heights_[static_cast<std::size_t>(j) * columns_ + i];
  const bool smooth = interpolation_ == Interpolation::smooth;
  include(bounds, smooth ? controlNet(heights_, columns_, rows_, i, j) : controlNetOf(v, i, j), v.dx, v.dy);
  if (interpolation_ == Interpolation::bilinear && isCreased(v, i, j))
    bounds.valleyCurvature = std::numeric_limits<double>::infinity();
  return bounds;
}

HeightFieldBounds HeightField::boundsOver(const Rectangle& part) const {
  const HeightFieldView v = view();
  const auto cell = [](double p, double from, double d, int n) {
    return static_cast<int>(std::clamp(std::floor((p - from) / d), 0.0, double(n - 2)));
  };
  const int i0 = cell(part.xMin, v.xMin, v.dx, columns_), i1 = cell(part.xMax, v.xMin, v.dx, columns_);
  const int j0 = cell(part.yMin, v.yMin, v.dy, rows_), j1 = cell(part.yMax, v.yMin, v.dy, rows_);
  HeightFieldBounds bounds;
  bounds.lowest = bounds.highest = heights_[static_cast<std::size_t>(j0) * columns_ + i0];
  for (int j = j0; j <= j1; ++j)
    for (int i = i0; i <= i1; ++i) {
      const HeightFieldBounds one = boundsOfCell(i, j);
      bounds.lowest = std::min(bounds.lowest, one.lowest), bounds.highest = std::max(bounds.highest, one.highest);
      bounds.slope = std::max(bounds.slope, one.slope);
      bounds.valleyCurvature = std::max(bounds.valleyCurvature, one.valleyCurvature);
    }
  return bounds;
}

HeightField HeightField::flat(const Rectangle& area, double z) { return plane(area, z, 0, 0); }

HeightField HeightField::plane(const Rectangle& area, double z, double slopeX, double slopeY) {
  return sample(area, 2, 2, [=](double x, double y) { return z + slopeX * x + slopeY * y; });
}

HeightField HeightField::raised(double dz) const {
  std::vector<double> heights = heights_;
  for (double& h : heights) h += dz;
  return HeightField(area_, columns_, rows_, std::move(heights), interpolation_);
}

HeightFieldView HeightField::view() const {
  return {.heights = heights_.data(),
          .slopes = slopes_.empty() ? nullptr : slopes_.data(),
          .columns = columns_,
          .rows = rows_,
          .xMin = area_.xMin,
          .yMin = area_.yMin,
          .dx = area_.width() / (columns_ - 1),
          .dy = area_.length() / (rows_ - 1),
          .slopeBound = bounds_.slope,
          .interpolation = interpolation_};
}

} // namespace grouser::terrain
