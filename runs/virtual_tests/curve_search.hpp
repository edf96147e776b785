// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <vector>

/// Least-squares fit for expensive and noisy trials: uses few of them.
namespace grouser::virtual_tests {

/// Rounds to four significant digits, to keep soil files readable. Trials scatter far more than this rounding.
double fourDigits(double value);

/// A parameter to fit and its range.
struct SearchRange {
  std::string key; ///< "friction", "porosity"
  double low = 0, high = 0;
  bool isLogarithmic = false; ///< the search uses the logarithm of the parameter
};

/// Gauss-Newton method. The Jacobian comes from a linear regression over all trials with weights that decrease with the
/// distance from the best trial. Levenberg-Marquardt damping limits a step to a quarter of the ranges (Nocedal and
/// Wright 2006, Numerical Optimization, section 10.3). The first trials: the start, and a step along each parameter.
class CurveSearch {
public:
  CurveSearch(std::vector<SearchRange> ranges, const std::vector<double>& start, std::size_t maxTrials);

  /// Values of the next trial, in the order of the ranges, rounded to four digits.
  const std::vector<double>& at() const { return next_; }
  /// Adds the residuals [standard deviations] of the trial at(). Every trial has the same number of residuals. Returns
  /// true if another trial is worthwhile.
  bool tried(const std::vector<double>& residuals);

  struct Trial {
    std::vector<double> values, scaled; ///< `values` in the units of the parameters, `scaled` in [0, 1]
    std::vector<double> residuals;
    double misfit() const; ///< root mean square of the residuals
  };
  const std::vector<Trial>& trials() const { return trials_; }
  std::size_t nearest() const; ///< index of the trial with the smallest misfit

private:
  std::vector<double> scaledOf(const std::vector<double>& values) const;
  void goTo(std::vector<double> scaled);
  std::vector<double> stepFrom(const Trial& best) const;

  std::vector<SearchRange> ranges_;
  std::size_t most_;
  std::vector<double> next_;
  std::vector<Trial> trials_;
};

} // namespace grouser::virtual_tests
