// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <vector>

/// Least squares with few trials, each of them expensive and noisy.
namespace grouser::virtual_tests {

/// Rounds to four significant digits, which keeps soil files readable; trials scatter by far more.
double fourDigits(double value);

/// A parameter to fit and its range.
struct SearchRange {
  std::string key; ///< "friction", "porosity"
  double low = 0, high = 0;
  bool isLogarithmic = false; ///< the search works with its logarithm
};

/// Gauss-Newton method. The Jacobian is a linear regression over all trials, weighted by their distance from the best;
/// Levenberg-Marquardt damping limits a step to a quarter of the ranges (Nocedal and Wright 2006, Numerical
/// Optimization, section 10.3). The first trials are the start and one step along each parameter.
class CurveSearch {
public:
  CurveSearch(std::vector<SearchRange> ranges, const std::vector<double>& start, std::size_t mostTrials);

  /// Values of the next trial, in the order of the ranges, rounded to four digits.
  const std::vector<double>& at() const { return next_; }
  /// Adds the residuals [standard deviations] of the trial at(); their number is constant. Returns whether another
  /// trial is worthwhile.
  bool tried(const std::vector<double>& residuals);

  struct Trial {
    std::vector<double> values, scaled; ///< in the parameters' units, in [0, 1]
    std::vector<double> residuals;
    double misfit() const; ///< root mean square of the residuals
  };
  const std::vector<Trial>& trials() const { return trials_; }
  std::size_t nearest() const; ///< index of the trial of least misfit

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
