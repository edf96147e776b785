// SPDX-License-Identifier: BSD-3-Clause
#include "runs/virtual_tests/curve_search.hpp"

#include "base/math.hpp"

#include <Eigen/Dense>
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace grouser::virtual_tests {

namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

// Distances between trials are in fractions of the parameter ranges.
constexpr double kFirstStep = 0.15, kMaxStep = 0.25;
constexpr double kNear = 0.25;  // distance from the best trial at which the weight of a trial is 1/2
constexpr double kSame = 0.01;  // trials at a smaller distance count as equal
constexpr double kRidge = 1e-3; // limits the slopes over parameters that hardly vary between trials
constexpr double kMinDamping = 1e-6, kMoreDamping = 2;
constexpr double kMinSaving = 1;        // minimum reduction of the sum of squares by a step,
constexpr double kMinShareSaved = 1e-3; // plus this fraction of the sum

/// residuals = intercept + slopes * (x - x of the best trial).
struct LinearModel {
  VectorXd intercept;
  MatrixXd slopes;
};

VectorXd vectorOf(const std::vector<double>& v) {
  return Eigen::Map<const VectorXd>(v.data(), static_cast<Eigen::Index>(v.size()));
}

LinearModel fitModel(const std::vector<CurveSearch::Trial>& trials, const CurveSearch::Trial& best) {
  const auto n = static_cast<Eigen::Index>(trials.size()), k = static_cast<Eigen::Index>(best.scaled.size()),
             m = static_cast<Eigen::Index>(best.residuals.size());
  MatrixXd x(n, k + 1), y(n, m);
  VectorXd weight(n);
  for (Eigen::Index row = 0; row < n; ++row) {
    const CurveSearch::Trial& trial = trials[static_cast<std::size_t>(row)];
    const VectorXd away = vectorOf(trial.scaled) - vectorOf(best.scaled);
    x(row, 0) = 1, x.row(row).tail(k) = away.transpose();
    y.row(row) = vectorOf(trial.residuals).transpose();
    weight(row) = 1 / (1 + away.squaredNorm() / (kNear * kNear));
  }
  MatrixXd normal = x.transpose() * weight.asDiagonal() * x;
  for (Eigen::Index j = 1; j <= k; ++j) normal(j, j) += kRidge;
  const MatrixXd solved = normal.ldlt().solve(x.transpose() * weight.asDiagonal() * y);
  return {solved.row(0).transpose(), solved.bottomRows(k).transpose()};
}

/// Minimises |intercept + slopes s|^2 + damping |s|^2 with at + s in [0, 1]. Fixes parameters that reach a bound, and
/// solves again for the other parameters.
VectorXd boundedStep(const LinearModel& model, const VectorXd& at, double damping) {
  const Eigen::Index k = at.size();
  VectorXd step = VectorXd::Zero(k);
  std::vector<bool> isHeld(static_cast<std::size_t>(k), false);
  for (Eigen::Index round = 0; round <= k; ++round) {
    MatrixXd normal = model.slopes.transpose() * model.slopes;
    VectorXd right = -model.slopes.transpose() * model.intercept;
    normal.diagonal().array() += damping;
    for (Eigen::Index j = 0; j < k; ++j) {
      if (!isHeld[static_cast<std::size_t>(j)]) continue;
      right -= step(j) * normal.col(j);
      normal.row(j).setZero(), normal.col(j).setZero();
      normal(j, j) = 1, right(j) = step(j);
    }
    const VectorXd free = normal.ldlt().solve(right);
    for (Eigen::Index j = 0; j < k; ++j)
      if (!isHeld[static_cast<std::size_t>(j)]) step(j) = free(j);
    bool isInside = true;
    for (Eigen::Index j = 0; j < k; ++j) {
      const double bounded = std::clamp(at(j) + step(j), 0.0, 1.0) - at(j);
      if (bounded == step(j)) continue;
      step(j) = bounded, isHeld[static_cast<std::size_t>(j)] = true, isInside = false;
    }
    if (isInside) break;
  }
  return step;
}

double squares(const VectorXd& v) { return v.squaredNorm(); }

} // namespace

double fourDigits(double value) {
  const std::string text = fmt::format("{:.3e}", value);
  double rounded = value;
  std::from_chars(text.data(), text.data() + text.size(), rounded);
  return rounded;
}

double CurveSearch::Trial::misfit() const {
  double sum = 0;
  for (const double r : residuals) sum += r * r;
  return std::sqrt(sum / static_cast<double>(residuals.size()));
}

CurveSearch::CurveSearch(std::vector<SearchRange> ranges, const std::vector<double>& start, std::size_t maxTrials)
    : ranges_(std::move(ranges)), most_(maxTrials), next_(start) {}

std::vector<double> CurveSearch::scaledOf(const std::vector<double>& values) const {
  std::vector<double> scaled;
  for (std::size_t k = 0; k < ranges_.size(); ++k) {
    const SearchRange& r = ranges_[k];
    scaled.push_back(r.isLogarithmic ? base::log(values[k] / r.low) / base::log(r.high / r.low)
                                     : (values[k] - r.low) / (r.high - r.low));
  }
  return scaled;
}

void CurveSearch::goTo(std::vector<double> scaled) {
  for (std::size_t k = 0; k < ranges_.size(); ++k) {
    const SearchRange& r = ranges_[k];
    const double share = std::clamp(scaled[k], 0.0, 1.0);
    const double value =
        r.isLogarithmic ? r.low * base::exp(share * base::log(r.high / r.low)) : r.low + share * (r.high - r.low);
    next_[k] = std::clamp(fourDigits(value), r.low, r.high);
  }
}

std::size_t CurveSearch::nearest() const {
  const auto less = [](const Trial& a, const Trial& b) { return a.misfit() < b.misfit(); };
  return static_cast<std::size_t>(std::min_element(trials_.begin(), trials_.end(), less) - trials_.begin());
}

std::vector<double> CurveSearch::stepFrom(const Trial& best) const {
  const LinearModel model = fitModel(trials_, best);
  const VectorXd at = vectorOf(best.scaled);
  double damping = kMinDamping;
  VectorXd step = boundedStep(model, at, damping);
  while (step.lpNorm<Eigen::Infinity>() > kMaxStep) step = boundedStep(model, at, damping *= kMoreDamping);
  const double now = squares(model.intercept), then = squares(model.intercept + model.slopes * step);
  if (now - then < kMinSaving + kMinShareSaved * now) return {};
  const VectorXd to = at + step;
  return {to.data(), to.data() + to.size()};
}

bool CurveSearch::tried(const std::vector<double>& residuals) {
  trials_.push_back({next_, scaledOf(next_), residuals});
  if (trials_.size() >= most_) return false;
  const Trial& first = trials_.front();
  if (trials_.size() <= ranges_.size()) {
    std::vector<double> to = first.scaled;
    double& moved = to[trials_.size() - 1];
    moved += moved + kFirstStep <= 1 ? kFirstStep : -kFirstStep;
    goTo(std::move(to));
    return true;
  }
  std::vector<double> to = stepFrom(trials_[nearest()]);
  if (to.empty()) return false;
  goTo(std::move(to));
  const std::vector<double> scaled = scaledOf(next_);
  const auto isThere = [&](const Trial& trial) {
    double away = 0;
    for (std::size_t k = 0; k < scaled.size(); ++k) away = std::max(away, std::fabs(scaled[k] - trial.scaled[k]));
    return away < kSame;
  };
  return std::none_of(trials_.begin(), trials_.end(), isThere);
}

} // namespace grouser::virtual_tests
