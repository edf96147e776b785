// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

/// Mohr-Coulomb strength, tau = c + sigma tan phi, and its mobilisation by Janosi and Hanamoto, 1 - exp(-j / K).
namespace grouser::virtual_tests {

/// One sample sheared under one load.
struct ShearCurve {
  std::vector<double> displacement;  ///< j [m], rising
  std::vector<double> shear, normal; ///< tau, sigma [Pa], one for each displacement
};

/// Strength of one curve: residual stresses are means over the second half, the peak that of the 5 % of the
/// displacement with the greatest tau over sigma.
struct CurveStrength {
  double residualShear = 0, residualNormal = 0, peakShear = 0, peakNormal = 0; ///< [Pa]
  double hump() const {
    return peakShear / peakNormal / (residualShear / residualNormal);
  } ///< [-] about 1 without peak
};
CurveStrength strengthOf(const ShearCurve& curve);

struct ShearFit {
  double cohesion = 0, peakCohesion = 0; ///< [Pa]
  double angle = 0, peakAngle = 0;       ///< [deg]
  double shearModulus = 0;               ///< K [m]
  double hump = 0;                       ///< [-] mean of peak over residual strength
  double misfit = 0;                     ///< [-] root mean square of tau / tau_residual - (1 - exp(-j / K))
};

/// Fits all curves together: lines by least squares through residual and peak stresses of all of them, with
/// weights 1 / sigma^2; K by least squares of tau / tau_residual over all their points. `tests`: [test][load], a test
/// is a seed under all loads. `counts`: multiplicity of each test; empty: 1. With a single load the lines go through
/// the origin.
ShearFit fitShear(const std::vector<std::vector<ShearCurve>>& tests, const std::vector<int>& counts = {});

} // namespace grouser::virtual_tests
