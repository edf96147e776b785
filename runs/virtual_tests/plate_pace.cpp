// SPDX-License-Identifier: BSD-3-Clause
#include "runs/virtual_tests/plate_pace.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace grouser::virtual_tests {

namespace {

constexpr double kFaster = 1.5;     // maximum factor per adjustment, because acceleration causes waves
constexpr double kAboutRight = 0.2; // relative tolerance of the speed; no adjustment within it
constexpr double kSoftest = 1e-6;   // minimum modulus / firstModulus
constexpr double kThereAndBack = 2; // path of the waves / depth of the bed

double meanOf(std::span<const double> values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// Slope of the line through the means of the first and the second half of the rows.
double slopeOver(std::span<const double> sinkage, std::span<const double> pressure) {
  const std::size_t half = sinkage.size() / 2;
  const double way = std::fabs(meanOf(sinkage.last(half)) - meanOf(sinkage.first(half)));
  return way > 0 ? std::fabs(meanOf(pressure.last(half)) - meanOf(pressure.first(half))) / way : 0;
}

} // namespace

double PlatePace::speedAt(double modulus) const {
  return std::min(fastest, added / std::sqrt(density * std::max(modulus, kSoftest * firstModulus)));
}

double PlatePace::wavesBack(double modulus) const {
  return kThereAndBack * depth / std::sqrt(std::max(modulus, kSoftest * firstModulus) / density);
}

double PlatePace::next(double now, double modulus) const {
  const double wanted = std::min(speedAt(modulus), kFaster * now);
  return std::fabs(wanted - now) <= kAboutRight * now ? now : wanted;
}

double apparentModulus(std::span<const double> sinkage, std::span<const double> pressure, double breadth,
                       std::size_t last) {
  if (sinkage.size() < 2) return 0;
  const std::size_t n = std::min(last, sinkage.size());
  return breadth * std::max(slopeOver(sinkage, pressure), slopeOver(sinkage.last(n), pressure.last(n)));
}

} // namespace grouser::virtual_tests
