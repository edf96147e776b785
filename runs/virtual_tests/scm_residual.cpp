// SPDX-License-Identifier: BSD-3-Clause
#include "runs/virtual_tests/scm_residual.hpp"

#include "base/math.hpp"

#include <algorithm>
#include <cmath>

namespace grouser::virtual_tests {

namespace {

constexpr int kPlaces = 50; // number of points of the mean curve

std::size_t firstCounted(const FittedCurve& c) {
  const double least = kCountedFrom * *std::max_element(c.measured.begin(), c.measured.end());
  std::size_t i = 0;
  while (i < c.way.size() && !(c.fitted[i] > 0 && c.fitted[i] >= least)) ++i;
  return i;
}

/// Sinkage or displacement of the first point above kCountedFrom [m].
double firstWay(const FittedCurve& c) {
  const std::size_t first = firstCounted(c);
  if (first == c.way.size()) return base::kInfinity;
  return c.way[first];
}

/// Deviation at a sinkage or displacement, by linear interpolation.
double deviationAt(const FittedCurve& c, double way) {
  const auto above = static_cast<std::size_t>(std::upper_bound(c.way.begin(), c.way.end(), way) - c.way.begin());
  const std::size_t i = std::clamp<std::size_t>(above, 1, c.way.size() - 1);
  const double share = (way - c.way[i - 1]) / (c.way[i] - c.way[i - 1]);
  return (1 - share) * c.deviationAt(i - 1) + share * c.deviationAt(i);
}

/// Adds model error and scatter over the range that all tests have in common.
void addMeanCurve(const std::vector<FittedCurve>& tests, GroupResidual& r) {
  double from = -base::kInfinity, to = base::kInfinity;
  for (const FittedCurve& c : tests) from = std::max(from, firstWay(c)), to = std::min(to, c.way.back());
  r.model = r.scatter = base::kNaN;
  if (!(from < to)) return;
  const auto n = static_cast<double>(tests.size());
  double ofMean = 0, ofTests = 0; // sums of squares over the points
  for (int k = 0; k < kPlaces; ++k) {
    const double way = from + (to - from) * k / (kPlaces - 1);
    double sum = 0, squares = 0;
    for (const FittedCurve& c : tests) sum += deviationAt(c, way);
    for (const FittedCurve& c : tests) squares += std::pow(deviationAt(c, way) - sum / n, 2);
    ofMean += sum / n * (sum / n), ofTests += squares;
  }
  const double variance = tests.size() > 1 ? ofTests / (n - 1) / kPlaces : 0;
  if (tests.size() > 1) r.scatter = std::sqrt(variance);
  r.model = std::sqrt(std::max(0.0, ofMean / kPlaces - variance / n));
}

} // namespace

TestResidual residualOf(const FittedCurve& curve) {
  TestResidual r;
  double squares = 0;
  for (std::size_t i = firstCounted(curve); i < curve.way.size(); ++i) {
    const double deviation = curve.deviationAt(i);
    squares += deviation * deviation, ++r.points;
    if (std::fabs(deviation) > std::fabs(r.largest)) r.largest = deviation, r.largestAt = curve.way[i];
  }
  r.rms = std::sqrt(squares / r.points);
  return r;
}

GroupResidual residualOf(const std::vector<FittedCurve>& tests) {
  GroupResidual r;
  double squares = 0, points = 0;
  for (const FittedCurve& c : tests) {
    const TestResidual one = residualOf(c);
    squares += one.rms * one.rms * one.points, points += one.points;
    if (std::fabs(one.largest) > std::fabs(r.largest)) r.largest = one.largest;
  }
  r.rms = std::sqrt(squares / points);
  addMeanCurve(tests, r);
  return r;
}

} // namespace grouser::virtual_tests
