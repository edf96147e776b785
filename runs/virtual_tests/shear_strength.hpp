// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

/// Mohr and Coulomb's strength, tau = c + sigma tan phi, and Janosi and Hanamoto's way to it, 1 - exp(-j / K).
namespace grouser::virtual_tests {

/// One sample sheared under one load.
struct ShearCurve {
  std::vector<double> displacement;  ///< j [m], rising
  std::vector<double> shear, normal; ///< tau, sigma [Pa], one for each displacement
};

/// What one curve says: residual stresses are means over the second half of the way, the peak that of the twentieth of
/// it in which tau over sigma is greatest.
struct CurveStrength {
  double residualShear = 0, residualNormal = 0, peakShear = 0, peakNormal = 0;              ///< [Pa]
  double hump() const { return peakShear / peakNormal / (residualShear / residualNormal); } ///< [-], about 1: none
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
/// is a seed under all loads. `counts`: how often each test counts; empty: once. Where all loads are alike the lines go
/// through the origin.
ShearFit fitShear(const std::vector<std::vector<ShearCurve>>& tests, const std::vector<int>& counts = {});

} // namespace grouser::virtual_tests
