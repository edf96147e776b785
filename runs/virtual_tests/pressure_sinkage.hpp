// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>
#include <vector>

/// Bekker's pressure-sinkage relation, p = (k_c / b + k_phi) z^n, fitted to plates of two breadths b.
namespace grouser::virtual_tests {

/// Loading curve of one plate.
struct SinkageCurve {
  std::vector<double> sinkage;  ///< [m]
  std::vector<double> pressure; ///< [Pa], one for each sinkage
};

/// Curve corrected for bedding of the plate into protruding grains, as ASTM D1883 does for curves that start concave
/// upward: the start is replaced by the steepest straight line, whose zero becomes the origin of sinkage. Steepest: of
/// the least-squares lines over a fifth of the greatest pressure that start between 2 and 60 % of it and at most `room`
/// [m] below the sinkage at 2 %. Exponents above 1 are reduced by that: 1.27 becomes 1.11 if the room is a sixth of the
/// sinkage.
struct BeddedCurve {
  SinkageCurve curve;
  double origin = 0; ///< [m] in the measured sinkage
  double begins = 0; ///< start of the line over the greatest pressure: below it n is 1 by construction
};
/// A curve without such a line is unchanged.
BeddedCurve correctedForBedding(const SinkageCurve& measured, double room);
/// Without correction: sinkage from the point at which the plate first carries 2 % of the greatest pressure.
SinkageCurve fromFirstContact(const SinkageCurve& measured);
/// The same from the first row with this pressure [Pa], which gets the sinkage `at` [m]; empty if there is none.
SinkageCurve fromContactPressure(const SinkageCurve& measured, double pressure, double at = 0);
/// Sinkage of that row [m]; NaN if there is none.
double contactSinkage(const SinkageCurve& measured, double pressure);

/// Breadth and tests of a plate.
struct PlateTests {
  double breadth = 0; ///< [m]
  std::vector<SinkageCurve> curves;
};

/// Mean pressure [Pa] of the rows with a sinkage in (from, to] [m]; NaN without such rows.
double meanPressureBetween(const SinkageCurve& curve, double from, double to);

struct BekkerFit {
  double n = 0;                     ///< [-] common to both breadths
  double kc = 0, kphi = 0;          ///< [N/m^(n+1)], [N/m^(n+2)]; kc may have either sign
  std::array<double, 2> k{};        ///< [N/m^(n+2)] of each breadth
  std::array<double, 2> ownN{};     ///< [-] of each breadth alone
  std::array<double, 2> goodness{}; ///< [-] Wong's, 1 - sqrt(sum (p - p_fit)^2 / (N - 2)) / mean p
  double kAt(double breadth) const { return kc / breadth + kphi; } ///< [N/m^(n+2)]
  double sinkageAt(double pressure, double breadth) const;         ///< [m]; NaN if kAt() is not positive
};

/// Least squares of ln p = ln k + n ln z with Wong's weights p^2 (Wong 1980): a common n of all tests, each with its
/// own k, whose mean is the k of the breadth; tests of a breadth, and breadths, have equal weight; k_c = (k1 - k2) b1
/// b2 / (b2 - b1), k_phi = (k2 b2 - k1 b1) / (b2 - b1). Excludes points without sinkage or pressure. `counts`:
/// multiplicity of each curve; empty: 1. `givenN`: instead of the fitted n, as k_c and k_phi are comparable at equal n
/// only. NaN without two points of a breadth.
BekkerFit fitBekker(const std::array<PlateTests, 2>& plates, const std::vector<std::vector<int>>& counts = {},
                    std::optional<double> givenN = {});

/// The same with one plate: n and k of a breadth in [0]; the rest is NaN.
BekkerFit fitOnePlate(const PlateTests& plate, const std::vector<int>& counts = {}, std::optional<double> givenN = {});

} // namespace grouser::virtual_tests
