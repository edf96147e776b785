// SPDX-License-Identifier: BSD-3-Clause
#include "runs/jobs/estimate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

namespace grouser::jobs {

namespace {

/// Mean, and variance of the mean.
struct Moments {
  double mean = 0, variance = 0;
  int freedom = 0;
};

Moments momentsOf(std::span<const double> values) {
  Moments m;
  const double n = static_cast<double>(values.size());
  for (const double v : values) m.mean += v / n;
  for (const double v : values) m.variance += (v - m.mean) * (v - m.mean);
  m.freedom = static_cast<int>(values.size()) - 1;
  m.variance = m.freedom > 0 ? m.variance / m.freedom / n : std::numeric_limits<double>::infinity();
  return m;
}

} // namespace

support::Estimate interval(std::span<const double> values, double miss) {
  const Moments m = momentsOf(values);
  if (m.freedom < 1) return {m.mean, std::numeric_limits<double>::infinity()};
  return {m.mean, support::student(m.freedom, miss) * std::sqrt(m.variance)};
}

support::Estimate predictionInterval(std::span<const double> values, double miss) {
  support::Estimate estimate = interval(values, miss);
  estimate.halfWidth *= std::sqrt(static_cast<double>(values.size()) + 1);
  return estimate;
}

support::Estimate interval95(std::span<const double> values) { return interval(values, 0.05); }

support::Estimate unpairedChange(std::span<const double> a, std::span<const double> b) {
  const Moments ma = momentsOf(a), mb = momentsOf(b);
  const double apart = mb.mean - ma.mean, variance = ma.variance + mb.variance;
  if (ma.freedom < 1 || mb.freedom < 1) return {apart, std::numeric_limits<double>::infinity()};
  if (variance == 0) return {apart, 0};
  const double freedom =
      variance * variance / (ma.variance * ma.variance / ma.freedom + mb.variance * mb.variance / mb.freedom);
  return {apart, support::student95(std::max(1, static_cast<int>(freedom + 1e-9))) * std::sqrt(variance)};
}

support::Estimate relativeDifference(std::span<const double> a, std::span<const double> b) {
  const support::Estimate d = unpairedChange(a, b);
  const double mean = momentsOf(a).mean;
  return {d.value / mean, d.halfWidth / std::fabs(mean)};
}

support::Estimate pairedChange(std::span<const double> a, std::span<const double> b) {
  if (a.size() != b.size()) throw std::invalid_argument("pairedChange: samples of different size");
  std::vector<double> changes;
  for (std::size_t i = 0; i < a.size(); ++i) changes.push_back(b[i] - a[i]);
  return interval95(changes);
}

support::Estimate pairedDifference(std::span<const double> a, std::span<const double> b) {
  const support::Estimate d = pairedChange(a, b);
  const double mean = momentsOf(a).mean;
  return {d.value / mean, d.halfWidth / std::fabs(mean)};
}

Verdict judge(const support::Estimate& difference, double bar) {
  const double size = std::fabs(difference.value);
  if (size + difference.halfWidth <= bar) return Verdict::equal;
  return size - difference.halfWidth > bar ? Verdict::differs : Verdict::inconclusive;
}

std::string verdictText(Verdict verdict) {
  switch (verdict) {
  case Verdict::equal:
    return "equal";
  case Verdict::differs:
    return "differs";
  default:
    return "inconclusive";
  }
}

namespace {

/// Returns true if all seeds agree up to rounding; then no interval is printed.
bool isExact(const support::Estimate& e) { return e.halfWidth <= 1e-9 * std::fabs(e.value); }

} // namespace

std::string plusMinus(const support::Estimate& estimate, int digits) {
  if (isExact(estimate)) return fmt::format("{:.{}f}", estimate.value, digits);
  if (!std::isfinite(estimate.halfWidth)) return fmt::format("{:.{}f} (no interval)", estimate.value, digits);
  return fmt::format("{:.{}f} +- {:.{}f}", estimate.value, digits, estimate.halfWidth, digits);
}

bool isInconclusive(const support::Estimate& e) {
  return std::isfinite(e.halfWidth) && e.halfWidth > std::fabs(e.value);
}

std::string valueText(const support::Estimate& estimate) {
  if (!std::isfinite(estimate.value)) return "-";
  const support::Estimate e{estimate.value, isExact(estimate) ? 0 : estimate.halfWidth};
  const bool hasWidth = std::isfinite(e.halfWidth) && e.halfWidth > 0;
  const double scale = hasWidth ? e.halfWidth : 0.001 * std::fabs(e.value);
  const double size = std::max(std::fabs(e.value), scale);
  const int last = scale > 0 ? static_cast<int>(std::floor(std::log10(scale))) - 1 : -3; // power of the last digit
  constexpr int kMaxDigits = 9;
  if (size >= 1e6 || (size > 0 && size < 1e-3) || -last > kMaxDigits) { // one power of ten for both
    const int power = static_cast<int>(std::floor(std::log10(size)));
    const double unit = std::pow(10.0, power);
    const int digits = std::clamp(power - last, 0, 11);
    const std::string text = fmt::format("{:.{}f}", e.value / unit, digits);
    return e.halfWidth == 0             ? fmt::format("{}e{}", text, power)
           : std::isfinite(e.halfWidth) ? fmt::format("({} +- {:.{}f})e{}", text, e.halfWidth / unit, digits, power)
                                        : fmt::format("{}e{} (no interval)", text, power);
  }
  const int digits = std::clamp(-last, 0, kMaxDigits);
  if (e.halfWidth == 0) return fmt::format("{:.{}f}", e.value, digits);
  return plusMinus(e, digits);
}

std::string percent(const support::Estimate& estimate, int digits) {
  if (!std::isfinite(estimate.halfWidth)) return fmt::format("{:.{}f} % (no interval)", 100 * estimate.value, digits);
  return plusMinus({100 * estimate.value, 100 * estimate.halfWidth}, digits) + " %";
}

} // namespace grouser::jobs
