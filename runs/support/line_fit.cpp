// SPDX-License-Identifier: BSD-3-Clause
#include "runs/support/line_fit.hpp"

#include "base/math.hpp"

#include <Eigen/Dense>

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace grouser::support {

namespace {

/// Probability that |t| < tan(angle) sqrt(freedom) for Student's distribution. Source: M. Abramowitz and I. Stegun,
/// Handbook of Mathematical Functions (1964), 26.7.3 and 26.7.4.
double studentWithin(int freedom, double angle) {
  const double c = base::cos(angle), s = base::sin(angle);
  const bool odd = freedom % 2 == 1;
  double sum = 0, term = odd ? c : 1;
  for (int k = odd ? 1 : 0; k < freedom - 1; k += 2) sum += term, term *= c * c * (k + 1) / (k + 2);
  return odd ? 2 / base::kPi * (angle + s * sum) : s * sum;
}

} // namespace

double student(int freedom, double miss) {
  constexpr int kBits = 60;
  if (miss == 0.05) return student95(freedom);
  double low = 0, high = 0.5 * base::kPi;
  for (int bit = 0; bit < kBits; ++bit) {
    const double middle = 0.5 * (low + high);
    (studentWithin(freedom, middle) < 1 - miss ? low : high) = middle;
  }
  return std::sqrt(static_cast<double>(freedom)) * base::sin(low) / base::cos(low);
}

double student95(int freedom) {
  constexpr std::array kQuantile = {12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306,
                                    2.262,  2.228, 2.201, 2.179, 2.160, 2.145, 2.131, 2.120};
  const auto place = static_cast<std::size_t>(freedom);
  return place <= kQuantile.size() ? kQuantile[place - 1] : 1.96 + 2.4 / freedom;
}

Estimate LineFit::withConfidence(double value, double variance) const {
  return {value, student95(points - 2) * std::sqrt(variance)};
}
Estimate LineFit::slopeEstimate() const { return withConfidence(slope, slopeVariance); }
Estimate LineFit::interceptEstimate() const { return withConfidence(intercept, interceptVariance); }
Estimate LineFit::at(double x) const {
  return withConfidence(intercept + slope * x, interceptVariance + 2 * x * covariance + x * x * slopeVariance);
}
std::string LineFit::slopeText() const {
  return hasError() ? fmt::format("{:.2f} +- {:.2f}", slope, slopeEstimate().halfWidth) : "-";
}

LineFit fitLine(std::span<const double> x, std::span<const double> y) {
  LineFit fit;
  const auto n = static_cast<Eigen::Index>(x.size());
  if (n < 2) return fit;
  const Eigen::Map<const Eigen::VectorXd> abscissa(x.data(), n), ordinate(y.data(), n);
  Eigen::MatrixX2d design(n, 2);
  design.col(0).setOnes();
  design.col(1) = abscissa;
  const Eigen::ColPivHouseholderQR<Eigen::MatrixX2d> qr(design);
  if (qr.rank() < 2) return fit;
  const Eigen::Vector2d coefficients = qr.solve(ordinate);
  fit.points = static_cast<int>(n);
  fit.intercept = coefficients[0], fit.slope = coefficients[1];
  if (!fit.hasError()) return fit;
  const double scatter = (ordinate - design * coefficients).squaredNorm() / static_cast<double>(n - 2);
  // X P = Q R, so (X^T X)^-1 = P (R^T R)^-1 P^T: the normal equations are not formed.
  const Eigen::Matrix2d inverseR =
      qr.matrixR().topRows<2>().triangularView<Eigen::Upper>().solve(Eigen::Matrix2d::Identity());
  const Eigen::Matrix2d half = qr.colsPermutation() * inverseR;
  const Eigen::Matrix2d covariance = scatter * half * half.transpose();
  fit.interceptVariance = covariance(0, 0), fit.slopeVariance = covariance(1, 1), fit.covariance = covariance(0, 1);
  return fit;
}

LineFit fitPower(std::span<const double> x, std::span<const double> y) {
  std::vector<double> logX, logY;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!(x[i] > 0 && y[i] > 0)) continue;
    logX.push_back(base::log(x[i])), logY.push_back(base::log(y[i]));
  }
  return fitLine(logX, logY);
}

} // namespace grouser::support
