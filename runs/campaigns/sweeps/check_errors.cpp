// SPDX-License-Identifier: BSD-3-Clause
#include "runs/campaigns/sweeps/check_errors.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace grouser::sweeps {

namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr double kSafety = 1.25;                 // Roache's factor for three grids or more
constexpr double kMinOrder = 0.5, kMaxOrder = 8; // the RATTLE scheme has orders up to 8
constexpr double kMinLeft = 0.25;                // share of C h in the bar without an observed order
constexpr double kAgree = 0.5;                   // maximum difference of successive orders

/// log2(a / b) if a and b have the same sign and the order is plausible.
std::optional<double> orderOf(double a, double b) {
  if (!(a * b > 0)) return std::nullopt;
  const double order = std::log2(a / b);
  return order >= kMinOrder && order <= kMaxOrder ? std::optional(order) : std::nullopt;
}

/// Order of the last three differences.
std::optional<double> orderSeen(std::span<const double> values) {
  const std::size_t n = values.size();
  if (n < 4) return std::nullopt;
  const auto difference = [&](std::size_t i) { return values[i + 1] - values[i]; };
  const std::optional<double> last = orderOf(difference(n - 3), difference(n - 2)),
                              before = orderOf(difference(n - 4), difference(n - 3));
  return last && before && std::fabs(*last - *before) <= kAgree ? last : std::nullopt;
}

} // namespace

StepError stepError(std::span<const double> values) {
  if (values.size() < 2) return {0, kInfinite, std::nullopt};
  const double finest = values.back();
  StepError error{finest - values.front(), 0, orderSeen(values)};
  if (error.order) {
    const double rest = (finest - values[values.size() - 2]) / (std::exp2(*error.order) - 1);
    error.change += rest;
    error.bar = kSafety * std::fabs(error.change);
    return error;
  }
  // Largest error over its step, in units of the first step.
  double most = 0;
  for (std::size_t i = 0; i + 1 < values.size(); ++i)
    most = std::max(most, std::ldexp(std::fabs(finest - values[i]), static_cast<int>(i)));
  // Error of the finest value for first-order convergence.
  const double left = 1 / (std::ldexp(1.0, static_cast<int>(values.size()) - 1) - 1);
  error.bar = std::fabs(error.change) + std::max(kMinLeft, left) * most;
  return error;
}

ScatteredStepError scatteredStepError(std::span<const double> fine, std::span<const double> coarse, double miss) {
  ScatteredStepError error{jobs::interval(fine, miss), std::nullopt, 0};
  error.bar = kStepUnseen * (std::fabs(error.change.value) + error.change.halfWidth);
  if (coarse.size() != fine.size() || std::fabs(error.change.value) <= error.change.halfWidth) return error;
  const support::Estimate before = jobs::interval(coarse, miss);
  if (std::fabs(before.value) <= before.halfWidth) return error;
  const double f = error.change.value, c = before.value;
  error.order = orderOf(c, f);
  if (!error.order) return error;
  // f c / (c - f), and its derivatives by f and c.
  const double byFine = c * c / ((c - f) * (c - f)), byCoarse = -f * f / ((c - f) * (c - f));
  std::vector<double> linear;
  for (std::size_t i = 0; i < fine.size(); ++i) linear.push_back(byFine * fine[i] + byCoarse * coarse[i]);
  error.change = {f * c / (c - f), jobs::interval(linear, miss).halfWidth};
  error.bar = std::fabs(error.change.value) + error.change.halfWidth;
  return error;
}

jobs::Verdict judgeSeeds(const support::Estimate& difference, double bar, int seeds) {
  constexpr int kEnough = 8;
  const jobs::Verdict verdict = jobs::judge(difference, bar);
  const bool few = seeds < kEnough && difference.halfWidth > 0.5 * bar;
  return few && verdict == jobs::Verdict::equal ? jobs::Verdict::inconclusive : verdict;
}

double totalBar(double seedsHalfWidth, std::span<const double> bars) {
  double squares = seedsHalfWidth * seedsHalfWidth;
  for (const double bar : bars) squares += bar * bar;
  return std::sqrt(squares);
}

int seedsFor(double bar, double halfWidth, int seeds, double miss) {
  if (seeds < 2 || !std::isfinite(halfWidth)) return 0;
  const double deviation = halfWidth * std::sqrt(static_cast<double>(seeds)) / support::student(seeds - 1, miss);
  constexpr int kMax = 1000;
  const auto isEnough = [&](int n) {
    return support::student(n - 1, miss) * deviation <= bar * std::sqrt(static_cast<double>(n));
  };
  if (!isEnough(kMax)) return 0;
  int low = 1, high = kMax; // too few, enough
  while (high - low > 1) {
    const int middle = (low + high) / 2;
    (isEnough(middle) ? high : low) = middle;
  }
  return high;
}

} // namespace grouser::sweeps
