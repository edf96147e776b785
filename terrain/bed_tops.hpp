// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/exec.hpp"
#include "base/host_device.hpp"
#include "terrain/grains.hpp"
#include "terrain/layers.hpp"

#include <cmath>
#include <span>
#include <vector>

namespace grouser::terrain {

/// Regular grid of nodes in plan view of a bed, row by row, row 0 at the smallest y.
struct NodeGrid {
  int columns{}, rows{};
  double dx{}, dy{}, xMin{}, yMin{}; ///< [m]

  GROUSER_HD std::size_t index(int i, int j) const { return static_cast<std::size_t>(j) * columns + i; }
  GROUSER_HD double x(int i) const { return xMin + i * dx; }
  GROUSER_HD double y(int j) const { return yMin + j * dy; }
  std::size_t size() const { return static_cast<std::size_t>(columns) * rows; }

  /// Calls f(node) for the nodes within the horizontal distance `reach` of (px, py).
  template <class F> GROUSER_HD void forEachWithin(double px, double py, double reach, F&& f) const {
    const int i0 = firstNode(px - reach, xMin, dx, columns), i1 = lastNode(px + reach, xMin, dx, columns);
    const int j0 = firstNode(py - reach, yMin, dy, rows), j1 = lastNode(py + reach, yMin, dy, rows);
    for (int j = j0; j <= j1; ++j)
      for (int i = i0; i <= i1; ++i) {
        const double ex = x(i) - px, ey = y(j) - py;
        if (ex * ex + ey * ey <= reach * reach) f(index(i, j));
      }
  }

private:
  GROUSER_HD static int firstNode(double v, double from, double d, int n) {
    const double k = ceil((v - from) / d - 1e-9);
    return k > 0 ? (k < n ? static_cast<int>(k) : n) : 0;
  }
  GROUSER_HD static int lastNode(double v, double from, double d, int n) {
    const double k = floor((v - from) / d + 1e-9);
    return k > -1 ? (k < n - 1 ? static_cast<int>(k) : n - 1) : -1;
  }
};

/// Highest grain top (centre + radius) [m] within `reach` of each node; minus infinity if there is none. Computed on
/// the grains' device; a maximum does not depend on the order. Includes the grains of all ranks.
std::vector<double> highestTops(const base::Exec& exec, const Grains& grains, const NodeGrid& grid, double reach);
/// Same for grains on the host. Throws InputError if a position is not finite.
std::vector<double> highestTops(std::span<const Seed> grains, const NodeGrid& grid, double reach);

} // namespace grouser::terrain
