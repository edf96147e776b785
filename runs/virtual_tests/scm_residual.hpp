// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

/// Deviation of measured stress curves from the curves of the soil contact model.
namespace grouser::virtual_tests {

/// Only points where the fit exceeds this fraction of the maximum measured stress are used, because relative deviations
/// are meaningless near 0.
inline constexpr double kCountedFrom = 0.1;

/// One test and the curve of the model.
struct FittedCurve {
  std::string test;                     ///< "small_seed1"
  std::vector<double> way;              ///< sinkage or shear displacement [m], ascending
  std::vector<double> measured, fitted; ///< stresses [Pa] at `way`; fitted > 0
  double deviationAt(std::size_t i) const { return measured[i] / fitted[i] - 1; }
};

struct TestResidual {
  double rms = 0, largest = 0; ///< deviation measured / fitted - 1 [-]; `largest` keeps its sign
  double largestAt = 0;        ///< sinkage or displacement of the largest deviation [m]
  int points = 0;
};
/// Residual over the points above kCountedFrom.
TestResidual residualOf(const FittedCurve& curve);

/// Residual of tests that differ only in their seed.
struct GroupResidual {
  double rms = 0, largest = 0; ///< over all tests [-]
  double model = 0;   ///< model error: rms deviation of the mean curve without the contribution of seed scatter [-]
  double scatter = 0; ///< standard deviation of the tests from the mean curve, rms over `way`; NaN for one test [-]
};
/// The mean curve covers the range in which all tests have points above kCountedFrom; without such a range, `model` and
/// `scatter` are NaN.
GroupResidual residualOf(const std::vector<FittedCurve>& tests);

} // namespace grouser::virtual_tests
