// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/vec.hpp"

namespace grouser::terrain {

/// Weights of four consecutive nodes for value, slope and second derivative of a cubic along one axis, in cell units.
struct CubicWeights {
  int first{}; ///< node index of w[0]; may be -1, with zero weight
  double w[4]{}, d[4]{}, dd[4]{};
};

/// Catmull-Rom weights at `u` [cells] among `n` >= 2 nodes. Missing nodes beyond either end are extrapolated linearly
/// from the last two; outside [0, n - 1] the curve follows its end tangent. Value and slope are continuous; linear data
/// are reproduced exactly.
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

/// Interpolation between the nodes of a height map.
enum class Interpolation {
  monotone, ///< cubic with limited slopes: within the minimum and maximum of the four nodes of a cell
  smooth,   ///< Catmull-Rom: overshoots by up to 7 per cent of the step between nodes
  bilinear  ///< linear between nodes; the normal jumps at cell edges
};

/// Slopes at a node for monotone interpolation [m per cell].
struct NodeSlopes {
  double x{}, y{}, xy{};
};

/// Weights of the two nodes of cell `first` at `t` cells from its lower node, for values, slopes, and their
/// derivatives. Hermite cubic, or linear; before the first cell and beyond the last one the tangent continues.
struct CellWeights {
  int first{};
  double v[2]{}, s[2]{}, dv[2]{}, ds[2]{}, ddv[2]{}, dds[2]{};
};

GROUSER_HD CellWeights lineWeights(double u, int cell) {
  CellWeights c;
  const double t = u - cell;
  c.first = cell;
  c.v[0] = 1 - t, c.v[1] = t;
  c.dv[0] = -1, c.dv[1] = 1;
  return c;
}

/// Hermite weights along an axis of `cells` >= 1 cells.
GROUSER_HD CellWeights hermiteWeights(double u, int cell, int cells) {
  CellWeights c;
  const double t = u - cell;
  c.first = cell;
  if ((t < 0 && cell == 0) || (t > 1 && cell == cells - 1)) {
    const int end = t < 0 ? 0 : 1;
    c.v[end] = 1, c.s[end] = t - end, c.ds[end] = 1;
    return c;
  }
  c.v[0] = (1 + 2 * t) * (1 - t) * (1 - t), c.v[1] = t * t * (3 - 2 * t);
  c.s[0] = t * (1 - t) * (1 - t), c.s[1] = t * t * (t - 1);
  c.dv[0] = 6 * t * (t - 1), c.dv[1] = 6 * t * (1 - t);
  c.ds[0] = (1 - t) * (1 - 3 * t), c.ds[1] = t * (3 * t - 2);
  c.ddv[0] = 12 * t - 6, c.ddv[1] = 6 - 12 * t;
  c.dds[0] = 6 * t - 4, c.dds[1] = 6 * t - 2;
  return c;
}

} // namespace grouser::terrain
