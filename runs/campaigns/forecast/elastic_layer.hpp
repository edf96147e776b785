// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

/// Depth of a bed without floor effect, from a homogeneous elastic solid as a measure for uniform soil. The stress
/// below long tracks reaches deep.
namespace grouser::forecast {

/// Rectangle on the surface with uniform pressure, sides along x and y.
struct LoadedRectangle {
  double x{}, y{};      ///< its middle [m]
  double halfLength{};  ///< along x [m], above 0
  double halfBreadth{}; ///< along y [m], above 0
};

/// Mean settlement of all `loads` under one pressure, times the solid's modulus over that pressure [m]. By Steinbrenner
/// (1934): a layer settles by what a half-space does between its surface and `depth` [m], which may be infinite;
/// neglects stress concentration at a stiff floor. `poisson` is the solid's ratio [-].
double layerSettlement(const std::vector<LoadedRectangle>& loads, double depth, double poisson);

} // namespace grouser::forecast
