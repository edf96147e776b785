// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>

namespace grouser::support {

/// A number with the half width of its 95 % confidence interval.
struct Estimate {
  double value = 0, halfWidth = 0;
};

/// y = intercept + slope x by least squares, with the covariance of both: s^2 (X^T X)^-1, where s^2 is the sum of the
/// squared residuals over the degrees of freedom.
struct LineFit {
  int points = 0; ///< 0: no line; 2: line without an error
  double intercept = 0, slope = 0;
  double interceptVariance = 0, slopeVariance = 0, covariance = 0;

  bool hasError() const { return points >= 3; }
  /// Estimates with Student's distribution with points - 2 degrees of freedom. Only for lines with an error.
  Estimate slopeEstimate() const;
  Estimate interceptEstimate() const;
  /// Value of the line at `x`.
  Estimate at(double x) const;
  /// The slope as "1.02 +- 0.03", or "-".
  std::string slopeText() const;

private:
  Estimate withConfidence(double value, double variance) const;
};

/// `x` and `y` have the same length. No line if all x are equal, or for fewer than two points.
LineFit fitLine(std::span<const double> x, std::span<const double> y);
/// Line fit of the logarithms; omits points with a value of 0 or less. The slope is the exponent of a power law.
LineFit fitPower(std::span<const double> x, std::span<const double> y);

/// Two-sided 95 % quantile of Student's distribution, `freedom` >= 1.
double student95(int freedom);
/// The same for an interval that misses with probability `miss`, in (0, 1); student95() is student(freedom, 0.05).
double student(int freedom, double miss);

} // namespace grouser::support
