// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Bearing capacity of cohesionless soil under a plate, from the formulas of foundation engineering.
namespace grouser::virtual_tests {

/// Factors of Terzaghi's superposition, q = c N_c + gamma z N_q + gamma B N_gamma / 2.
struct BearingFactors {
  double nq = 1, nc = 0, ngamma = 0; ///< [-]
};

/// N_q = exp(pi tan phi) tan2(45 deg + phi/2) and N_c = (N_q - 1) cot phi (Prandtl 1921, Reissner 1924), N_gamma =
/// 2 (N_q + 1) tan phi (Vesic 1973, J. Soil Mech. Found. Div. 99:45). `angle`: phi, the angle of internal friction
/// [rad], in [0, pi/2).
BearingFactors bearingFactors(double angle);

enum class PlateShape { strip, circular };

/// Bearing capacity of cohesionless soil [Pa], at sinkage `depth` [m] of a plate of `breadth` [m] (diameter if
/// circular), with `unitWeight` [N/m3] = bulk density times gravity. The soil beside the plate counts as surcharge; its
/// strength is neglected. Shape factors of a circle: s_q = 1 + tan phi, s_gamma = 0.6 (Vesic 1973, after De Beer 1970).
double bearingPressure(PlateShape shape, double angle, double unitWeight, double breadth, double depth);

/// Angle of internal friction [rad] in [0, 60 deg] for which bearingPressure() equals `pressure`.
double bearingAngle(PlateShape shape, double pressure, double unitWeight, double breadth, double depth);

} // namespace grouser::virtual_tests
