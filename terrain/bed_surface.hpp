// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "terrain/bed_tops.hpp"
#include "terrain/layers.hpp"

#include <span>
#include <vector>

namespace grouser::terrain {

/// Surface height of a bed of grains: the maximum grain top within one grain diameter, smoothed.
///
/// Algorithm, on a grid of about one grain radius:
///  1. highest top (centre + radius) of the grains with centres within one diameter d in the plane;
///     the floor if there are none;
///  2. minimum of step 1 within one radius. Step 1 raises a slope by nearly one radius times its tangent
///     (grains are a diameter apart, so the highest is rarely at the rim), and widens a single stone to two diameters;
///     step 2 reverses both effects;
///  3. one pass of the binomial kernel (1 2 1)/4 in x and y, linear at the border.
/// Queries interpolate bilinearly between nodes; outside the area they use the nearest border point.
///
/// The surface is exact for a lattice of equal grain tops, level or inclined up to the roughness of the lattice. If the
/// tops scatter, the surface is above their mean, like a straight-edge (tests/terrain/bed_surface_test.cpp measures the
/// difference). Flying grains count as bed, so the bed must be settled. Cost O(N), for any order of the grains.
class BedSurface {
public:
  /// `diameter`: largest grain diameter [m]. The grid covers `area`; grains more than one diameter outside are ignored.
  /// Throws InputError if `diameter` is not positive, or a position is not finite.
  BedSurface(std::span<const Seed> grains, const HeightFieldView& floor, const Rectangle& area, double diameter);
  /// Surface of the bed during a simulation, from the grains on their device. With several ranks it covers the whole
  /// bed and is identical on all ranks.
  BedSurface(const base::Exec& exec, const Grains& grains, const HeightFieldView& floor, const Rectangle& area);
  /// Restores the nodes of an earlier surface of the same area and diameter. Throws InputError if their number differs.
  BedSurface(const Rectangle& area, double diameter, std::vector<double> heights);

  /// Surface height at (x, y) [m]; never NaN.
  double height(double x, double y) const;

  const Rectangle& area() const { return area_; }
  int columns() const { return columns_; }
  int rows() const { return rows_; }
  /// Node heights [columns * rows] [m], row by row, row 0 at the smallest y; for output and checkpoints.
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
