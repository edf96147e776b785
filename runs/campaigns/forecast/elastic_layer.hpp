// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

/// Settlement of an elastic layer, a model of uniform soil: estimates the bed depth that avoids a floor effect. The
/// stress below long tracks reaches great depths.
namespace grouser::forecast {

/// Rectangle on the surface with uniform pressure, sides along x and y.
struct LoadedRectangle {
  double x{}, y{};      ///< centre of the rectangle [m]
  double halfLength{};  ///< along x [m], above 0
  double halfBreadth{}; ///< along y [m], above 0
};

/// Mean settlement of all `loads` under equal pressure, times Young's modulus / pressure [m]. Steinbrenner (1934): the
/// settlement of a layer equals that of a half-space between its surface and `depth` [m], which may be infinite; this
/// neglects stress concentration at a stiff floor. `poisson`: Poisson's ratio [-].
double layerSettlement(const std::vector<LoadedRectangle>& loads, double depth, double poisson);

} // namespace grouser::forecast
