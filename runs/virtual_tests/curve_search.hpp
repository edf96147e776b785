// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <vector>

/// Least squares over a few trials that are dear and scatter.
namespace grouser::virtual_tests {

/// To four significant digits, as people read them in a soil's file: far nearer than trials scatter.
double fourDigits(double value);

/// A parameter that is sought, and where.
struct SearchRange {
  std::string key; ///< "friction", "porosity"
  double low = 0, high = 0;
  bool isLogarithmic = false; ///< steps are of its logarithm
};

/// Gauss-Newton steps whose slopes come from a linear regression over all trials, in which those far from the best
/// count less; Levenberg and Marquardt's damping keeps a step within a quarter of the ranges (Nocedal and Wright 2006,
/// Numerical Optimization, section 10.3). First come the start and a step along each parameter.
class CurveSearch {
public:
  CurveSearch(std::vector<SearchRange> ranges, const std::vector<double>& start, std::size_t mostTrials);

  /// The values to try, in the order of the ranges, to four digits.
  const std::vector<double>& at() const { return next_; }
  /// Residuals [standard deviations] of the trial at(), as many each time. Returns whether another trial is worthwhile.
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
