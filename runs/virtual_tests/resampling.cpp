// SPDX-License-Identifier: BSD-3-Clause
#include "runs/virtual_tests/resampling.hpp"

#include "base/random.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace grouser::virtual_tests {

namespace {

/// Variance of a statistic over the resamples of a group.
struct Spread {
  double sum = 0, squares = 0;
  int count = 0;

  void add(double x) {
    if (!std::isfinite(x)) return;
    sum += x, squares += x * x, ++count;
  }
  double variance() const {
    if (count < 2) return 0;
    const double mean = sum / count;
    return std::max(0.0, (squares / count - mean * mean) * count / (count - 1));
  }
};

/// Draws `tests` tests with replacement.
std::vector<int> drawn(int tests, std::uint64_t seed, std::uint64_t group, int resample) {
  constexpr std::uint64_t kPurpose = base::purpose("bevameter.resample");
  std::vector<int> counts(static_cast<std::size_t>(tests));
  for (int k = 0; k < tests; ++k) {
    const double u = base::uniform(seed, kPurpose, (group << 32) + static_cast<std::uint64_t>(resample),
                                   static_cast<std::uint64_t>(k));
    ++counts[static_cast<std::size_t>(u * tests)];
  }
  return counts;
}

} // namespace

std::vector<support::Estimate> intervalsOfTests(const std::vector<int>& groupSizes,
                                                const std::function<std::vector<double>(const TestCounts&)>& statistic,
                                                std::uint64_t seed, int resamples) {
  TestCounts all;
  for (const int size : groupSizes) all.emplace_back(static_cast<std::size_t>(size), 1);
  const std::vector<double> values = statistic(all);
  std::vector<double> squares(values.size()); // squared half widths
  bool single = groupSizes.empty();
  for (std::size_t g = 0; g < groupSizes.size(); ++g) {
    const int n = groupSizes[g];
    single = single || n < 2;
    if (n < 2) continue;
    // Deviations from the value of all tests, to avoid cancellation.
    std::vector<Spread> spreads(values.size());
    TestCounts counts = all;
    for (int r = 0; r < resamples; ++r) {
      counts[g] = drawn(n, seed, g, r);
      const std::vector<double> again = statistic(counts);
      for (std::size_t i = 0; i < values.size(); ++i) spreads[i].add(again[i] - values[i]);
    }
    for (std::size_t i = 0; i < values.size(); ++i) {
      const double part = spreads[i].variance() * n / (n - 1);
      const double quantile = support::student95(n - 1);
      squares[i] += quantile * quantile * part;
    }
  }
  std::vector<support::Estimate> estimates;
  for (std::size_t i = 0; i < values.size(); ++i)
    estimates.push_back({values[i], single ? std::numeric_limits<double>::infinity() : std::sqrt(squares[i])});
  return estimates;
}

} // namespace grouser::virtual_tests
