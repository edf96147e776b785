// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

/// Deviation of measured stress curves from those of the soil contact model.
namespace grouser::virtual_tests {

/// Deviations count where the fit exceeds this share of the maximum measured stress, as relative deviations are
/// meaningless near 0.
inline constexpr double kCountedFrom = 0.1;

/// One test and the curve of the model.
struct FittedCurve {
  std::string test;                     ///< "small_seed1"
  std::vector<double> way;              ///< sinkage or shear displacement [m], rising
  std::vector<double> measured, fitted; ///< [Pa], one for each way; fitted > 0
  double deviationAt(std::size_t i) const { return measured[i] / fitted[i] - 1; }
};

struct TestResidual {
  double rms = 0, largest = 0; ///< deviation measured / fitted - 1 [-]; the largest with its sign
  double largestAt = 0;        ///< way [m]
  int points = 0;
};
/// Residual over the points above kCountedFrom.
TestResidual residualOf(const FittedCurve& curve);

/// Residual of tests that differ only in their seed.
struct GroupResidual {
  double rms = 0, largest = 0; ///< over all tests [-]
  double model = 0;   ///< model error: rms deviation of the mean curve, less the contribution of seed scatter [-]
  double scatter = 0; ///< standard deviation of a test from the mean curve, rms over the way; NaN for one test [-]
};
/// The mean curve covers the range in which all tests have points that count. NaN if there is none.
GroupResidual residualOf(const std::vector<FittedCurve>& tests);

} // namespace grouser::virtual_tests
