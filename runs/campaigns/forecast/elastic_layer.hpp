// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

/// How deep a bed has to be for its floor not to matter: an elastic solid of one modulus, as a measure for soil that is
/// alike at all depths. Tracks are long, so that what they press reaches far down.
namespace grouser::forecast {

/// A rectangle on the surface that carries an even pressure, its sides along x and y.
struct LoadedRectangle {
  double x{}, y{};      ///< its middle [m]
  double halfLength{};  ///< along x [m], above 0
  double halfBreadth{}; ///< along y [m], above 0
};

/// Mean settlement of all `loads` under one pressure, times the solid's modulus over that pressure [m]. By Steinbrenner
/// (1934): a layer settles by what a half-space does between its surface and `depth` [m], which may be infinite;
/// that a stiff floor draws stress to itself is neglected. `poisson` is the solid's ratio [-].
double layerSettlement(const std::vector<LoadedRectangle>& loads, double depth, double poisson);

} // namespace grouser::forecast
