// SPDX-License-Identifier: BSD-3-Clause
#include "terrain/bed_surface.hpp"

#include "base/error.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace grouser::terrain {

namespace {

using base::InputError;

/// Computes the minimum within `reach` of each node; points outside the grid are ignored.
std::vector<double> lowestWithin(const NodeGrid& grid, const std::vector<double>& values, double reach) {
  std::vector<double> result(values.size());
  // Slightly larger than the reach, so that rounding does not decide about nodes at exactly that distance.
  const double slack = 1e-9 * reach;
  for (int j = 0; j < grid.rows; ++j)
    for (int i = 0; i < grid.columns; ++i) {
      double lowest = values[grid.index(i, j)];
      grid.forEachWithin(grid.x(i), grid.y(j), reach + slack,
                         [&](std::size_t node) { lowest = std::min(lowest, values[node]); });
      result[grid.index(i, j)] = lowest;
    }
  return result;
}

/// Applies (1 2 1)/4 along one axis; end nodes are unchanged, as for linear data.
void smooth(std::vector<double>& values, std::size_t lines, std::size_t lineStride, int n, std::size_t stride) {
  for (std::size_t l = 0; l < lines; ++l) {
    double* v = values.data() + l * lineStride;
    double before = v[0];
    for (int k = 1; k + 1 < n; ++k) {
      const double here = v[k * stride];
      v[k * stride] = 0.25 * (before + v[(k + 1) * stride]) + 0.5 * here;
      before = here;
    }
  }
}

} // namespace

void BedSurface::layGrid(double diameter) {
  if (!(diameter > 0 && std::isfinite(diameter)))
    throw InputError(fmt::format("surface of the bed: grain diameter = {} m must be positive", diameter));
  // Node spacing: one radius, or slightly less to match the border.
  columns_ = 1 + std::max(1, static_cast<int>(std::ceil(area_.width() / (diameter / 2))));
  rows_ = 1 + std::max(1, static_cast<int>(std::ceil(area_.length() / (diameter / 2))));
  dx_ = area_.width() / (columns_ - 1), dy_ = area_.length() / (rows_ - 1);
}

BedSurface::BedSurface(const Rectangle& area, double diameter, std::vector<double> heights)
    : area_(area), heights_(std::move(heights)) {
  layGrid(diameter);
  if (heights_.size() != static_cast<std::size_t>(columns_) * rows_)
    throw InputError(
        fmt::format("bed surface: got {} heights, but the grid has {} x {} nodes", heights_.size(), columns_, rows_));
}

BedSurface::BedSurface(std::span<const Seed> grains, const HeightFieldView& floor, const Rectangle& area,
                       double diameter)
    : area_(area) {
  layGrid(diameter);
  shape(highestTops(grains, grid(), diameter), floor, diameter);
}

BedSurface::BedSurface(const base::Exec& exec, const Grains& grains, const HeightFieldView& floor,
                       const Rectangle& area)
    : area_(area) {
  const double diameter = 2 * grains.model().radius;
  layGrid(diameter);
  shape(highestTops(exec, grains, grid(), diameter), floor, diameter);
}

NodeGrid BedSurface::grid() const { return {columns_, rows_, dx_, dy_, area_.xMin, area_.yMin}; }

void BedSurface::shape(std::vector<double> tops, const HeightFieldView& floor, double diameter) {
  const NodeGrid nodes = grid();
  for (int j = 0; j < rows_; ++j)
    for (int i = 0; i < columns_; ++i) {
      double& top = tops[nodes.index(i, j)];
      if (!std::isfinite(top)) top = floor.height(nodes.x(i), nodes.y(j));
    }
  heights_ = lowestWithin(nodes, tops, diameter / 2);
  smooth(heights_, rows_, columns_, columns_, 1);
  smooth(heights_, columns_, 1, rows_, columns_);
}

double BedSurface::height(double x, double y) const {
  // Maps NaN to the first node: the surface itself is defined everywhere.
  const auto locate = [](double v, double from, double d, int n, int& i) {
    const double u = (v - from) / d;
    const double inside = u > 0 ? std::min(u, double(n - 1)) : 0.0;
    i = std::min(static_cast<int>(inside), n - 2);
    return inside - i;
  };
  int i, j;
  const double s = locate(x, area_.xMin, dx_, columns_, i);
  const double t = locate(y, area_.yMin, dy_, rows_, j);
  const double* v = heights_.data() + static_cast<std::size_t>(j) * columns_ + i;
  return (1 - t) * ((1 - s) * v[0] + s * v[1]) + t * ((1 - s) * v[columns_] + s * v[columns_ + 1]);
}

} // namespace grouser::terrain
