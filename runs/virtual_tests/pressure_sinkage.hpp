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
  std::vector<double> pressure; ///< [Pa] at each sinkage
};

/// Curve corrected for bedding of the plate into protruding grains, as in ASTM D1883 for curves that are concave upward
/// at the start: the steepest straight line replaces the start, and its zero becomes the origin of the sinkage. The
/// candidates are least-squares lines over 20 % of the greatest pressure. They start between 2 and 60 % of it, at most
/// `room` [m] below the sinkage at 2 %. The correction reduces exponents above 1: 1.27 becomes 1.11 if `room` is 1/6 of
/// the sinkage.
struct BeddedCurve {
  SinkageCurve curve;
  double origin = 0; ///< [m] measured sinkage at the new origin
  double begins = 0; ///< pressure at the start of the line / greatest pressure; below it, n is 1 by construction
};
/// Returns a curve without such a line unchanged.
BeddedCurve correctedForBedding(const SinkageCurve& measured, double room);
/// Curve without this correction: sinkage from the point where the plate first carries 2 % of the greatest pressure.
SinkageCurve fromFirstContact(const SinkageCurve& measured);
/// Curve from the first row with at least this pressure [Pa]; this row gets the sinkage `at` [m]. Empty if there is
/// none.
SinkageCurve fromContactPressure(const SinkageCurve& measured, double pressure, double at = 0);
/// Sinkage of the first row with at least this pressure [m]; NaN if there is none.
double contactSinkage(const SinkageCurve& measured, double pressure);

/// Breadth of a plate, and the curves of its tests.
struct PlateTests {
  double breadth = 0; ///< [m]
  std::vector<SinkageCurve> curves;
};

/// Mean pressure [Pa] of the rows with a sinkage in (from, to] [m]; NaN if there are no such rows.
double meanPressureBetween(const SinkageCurve& curve, double from, double to);

struct BekkerFit {
  double n = 0;                     ///< [-] common to both breadths
  double kc = 0, kphi = 0;          ///< [N/m^(n+1)], [N/m^(n+2)]; kc may have either sign
  std::array<double, 2> k{};        ///< [N/m^(n+2)] of each breadth
  std::array<double, 2> ownN{};     ///< [-] n fitted to each breadth separately
  std::array<double, 2> goodness{}; ///< [-] Wong's, 1 - sqrt(sum (p - p_fit)^2 / (N - 2)) / mean p
  double kAt(double breadth) const { return kc / breadth + kphi; } ///< [N/m^(n+2)]
  double sinkageAt(double pressure, double breadth) const;         ///< [m]; NaN if kAt() is not positive
};

/// Least squares of ln p = ln k + n ln z with the weights p^2 (Wong 1980). All tests have a common n, and each its own
/// k; the k of a breadth is the mean over its tests. Tests of a breadth have equal weight, and so do both breadths.
/// k_c = (k1 - k2) b1 b2 / (b2 - b1), k_phi = (k2 b2 - k1 b1) / (b2 - b1). Excludes points without sinkage or pressure.
/// `counts`: multiplicity of each curve; empty: 1. `givenN` replaces the fitted n, because k_c and k_phi are comparable
/// only at equal n. NaN if a breadth has fewer than two points.
BekkerFit fitBekker(const std::array<PlateTests, 2>& plates, const std::vector<std::vector<int>>& counts = {},
                    std::optional<double> givenN = {});

/// Fit of a single plate: its n and k are in element [0]; all other values are NaN.
BekkerFit fitOnePlate(const PlateTests& plate, const std::vector<int>& counts = {}, std::optional<double> givenN = {});

} // namespace grouser::virtual_tests
