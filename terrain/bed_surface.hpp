// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "terrain/bed_tops.hpp"
#include "terrain/layers.hpp"

#include <span>
#include <vector>

namespace grouser::terrain {

/// Surface height of a bed of grains: the highest grain top within one grain diameter, smoothed.
///
/// On a grid of about one grain radius:
///  1. highest: the highest top (centre + radius) among grains whose centre lies within one diameter d in the plane;
///     the floor where there is none;
///  2. the lowest value of step 1 within one radius. Step 1 raises a slope by nearly a radius times its tangent
///     (grains lie a diameter apart, so the highest is rarely at the rim), and widens a lone stone to two diameters;
///     step 2 reverses both;
///  3. one pass of the binomial kernel (1 2 1)/4 in x and y, linear at the border.
/// Queries are bilinear between nodes and take the nearest border point outside.
///
/// Exact on a lattice of equal tops, level or inclined up to the unevenness of the lattice. On a bed whose tops scatter
/// it lies above the mean of the tops (tests/terrain/bed_surface_test.cpp measures by how much), like a straight-edge.
/// Grains in flight count as bed, so the bed must have settled. O(N), and independent of the order of grains.
class BedSurface {
public:
  /// `diameter` [m]: of the largest grain. The grid spans `area`. Grains outside it by more than a diameter do not
  /// count. InputError: `diameter` not positive, or a grain that is no finite number.
  BedSurface(std::span<const Seed> grains, const HeightFieldView& floor, const Rectangle& area, double diameter);
  /// Surface of the bed in a running simulation, from the grains on its device. With several ranks it covers the whole
  /// bed and is identical on all of them.
  BedSurface(const base::Exec& exec, const Grains& grains, const HeightFieldView& floor, const Rectangle& area);
  /// From the nodes of an earlier surface of the same area and diameter. InputError: their number does not fit.
  BedSurface(const Rectangle& area, double diameter, std::vector<double> heights);

  /// Surface height at (x, y) [m]; never NaN.
  double height(double x, double y) const;

  const Rectangle& area() const { return area_; }
  int columns() const { return columns_; }
  int rows() const { return rows_; }
  /// Nodes [columns * rows] [m], row by row, row 0 at the smallest y; for output and checkpoints.
  const std::vector<double>& heights() const { return heights_; }

private:
  void layGrid(double diameter);
  NodeGrid grid() const;
  void shape(std::vector<double> tops, const HeightFieldView& floor, double diameter);

  Rectangle area_;
  int columns_{}, rows_{};
  double dx_{}, dy_{};
  std::vector<double> heights_;
};

} // namespace grouser::terrain
