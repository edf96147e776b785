// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

/// Mohr-Coulomb strength tau = c + sigma tan phi, and its mobilisation 1 - exp(-j / K) (Janosi and Hanamoto).
namespace grouser::virtual_tests {

/// One sample sheared under one load.
struct ShearCurve {
  std::vector<double> displacement;  ///< j [m], ascending
  std::vector<double> shear, normal; ///< tau and sigma [Pa] at each displacement
};

/// Strength of one curve. Residual stresses are means over the second half. Peak stresses are means over a window of
/// 5 % of the displacement, where tau / sigma is greatest.
struct CurveStrength {
  double residualShear = 0, residualNormal = 0, peakShear = 0, peakNormal = 0; ///< [Pa]
  double hump() const {
    return peakShear / peakNormal / (residualShear / residualNormal);
  } ///< [-] peak / residual strength; about 1 without a peak
};
CurveStrength strengthOf(const ShearCurve& curve);

struct ShearFit {
  double cohesion = 0, peakCohesion = 0; ///< [Pa]
  double angle = 0, peakAngle = 0;       ///< [deg]
  double shearModulus = 0;               ///< K [m]
  double hump = 0;                       ///< [-] mean of peak / residual strength
  double misfit = 0;                     ///< [-] root mean square of tau / tau_residual - (1 - exp(-j / K))
};

/// Fits all curves together: least-squares lines through the residual and through the peak stresses of all curves, with
/// the weights 1 / sigma^2; and K by least squares of tau / tau_residual over all points. `tests`: [test][load]; a test
/// is one seed under all loads. `counts`: multiplicity of each test; empty: 1. With a single load, c is 0 (the lines
/// pass through the origin).
ShearFit fitShear(const std::vector<std::vector<ShearCurve>>& tests, const std::vector<int>& counts = {});

} // namespace grouser::virtual_tests
