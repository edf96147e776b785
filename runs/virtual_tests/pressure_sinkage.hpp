// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>
#include <vector>

/// Bekker's relation of pressure and sinkage, p = (k_c / b + k_phi) z^n, fitted to plates of two breadths b.
namespace grouser::virtual_tests {

/// Points of one plate while it is loaded.
struct SinkageCurve {
  std::vector<double> sinkage;  ///< [m]
  std::vector<double> pressure; ///< [Pa], one for each sinkage
};

/// A curve whose beginning, where a flat plate beds into grains that stand out of a rough surface, is replaced as ASTM
/// D1883 does where curves begin concave upward: by the steepest straight line through the curve, from where that line
/// comes to no pressure, which becomes the origin of sinkage. Steepest: of the least squares lines over a fifth of the
/// greatest pressure that begin between 2 and 60 % of it and no deeper than `room` [m] below where it carries 2 %. An
/// exponent above 1 is made less by that: 1.27 comes out as 1.11 where the room is a sixth of the whole sinkage.
struct BeddedCurve {
  SinkageCurve curve;
  double origin = 0; ///< [m] in the measured sinkage
  double begins = 0; ///< share of the greatest pressure at which the line begins: below it n is 1 by construction
};
/// A curve without such a line stays as it is.
BeddedCurve correctedForBedding(const SinkageCurve& measured, double room);
/// Instead: sinkage counts from where the plate first carries 2 % of the greatest pressure, and nothing is replaced.
SinkageCurve fromFirstContact(const SinkageCurve& measured);
/// The same from the first row with this pressure [Pa], which comes to the sinkage `at` [m]; empty if there is none.
SinkageCurve fromContactPressure(const SinkageCurve& measured, double pressure, double at = 0);
/// Sinkage of that row [m]; NaN if there is none.
double contactSinkage(const SinkageCurve& measured, double pressure);

/// A plate's breadth, and all of its tests.
struct PlateTests {
  double breadth = 0; ///< [m]
  std::vector<SinkageCurve> curves;
};

/// Mean pressure [Pa] of the rows with a sinkage in (from, to] [m]; NaN without such rows.
double meanPressureBetween(const SinkageCurve& curve, double from, double to);

struct BekkerFit {
  double n = 0;                     ///< [-] the same for both breadths
  double kc = 0, kphi = 0;          ///< [N/m^(n+1)], [N/m^(n+2)]; kc may have either sign
  std::array<double, 2> k{};        ///< [N/m^(n+2)] of each breadth
  std::array<double, 2> ownN{};     ///< [-] that each breadth alone would give
  std::array<double, 2> goodness{}; ///< [-] Wong's, 1 - sqrt(sum (p - p_fit)^2 / (N - 2)) / mean p
  double kAt(double breadth) const { return kc / breadth + kphi; } ///< [N/m^(n+2)]
  double sinkageAt(double pressure, double breadth) const;         ///< [m]; no number where kAt() is not positive
};

/// Least squares of ln p = ln k + n ln z with Wong's weights p^2 (Wong 1980): one n for all tests, each with a k of its
/// own, whose mean is its breadth's; each test of a breadth counts as much as the others, and each breadth as the
/// other; k_c = (k1 - k2) b1 b2 / (b2 - b1), k_phi = (k2 b2 - k1 b1) / (b2 - b1). Points without sinkage or pressure
/// are left out. `counts`: how often each curve counts; empty: once. `givenN`: instead of the n that fits best, for
/// k_c and k_phi of two soils compare at one n only. A fit without two points of a breadth holds no numbers.
BekkerFit fitBekker(const std::array<PlateTests, 2>& plates, const std::vector<std::vector<int>>& counts = {},
                    std::optional<double> givenN = {});

/// The same with one plate: n and k of a breadth; [0] is filled, the rest holds no numbers.
BekkerFit fitOnePlate(const PlateTests& plate, const std::vector<int>& counts = {}, std::optional<double> givenN = {});

} // namespace grouser::virtual_tests
