// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/support/line_fit.hpp"

#include <cstdint>
#include <functional>
#include <vector>

/// Intervals of fitted constants by resampling whole tests.
namespace grouser::virtual_tests {

/// Multiplicity of each test: [group][test]; 1 in the data.
using TestCounts = std::vector<std::vector<int>>;

/// 95 % intervals of `statistic`, a vector of all tests. Tests of a group are independent and identically distributed
/// (seeds of one plate); groups are independent.
///
/// Each group is resampled separately with replacement (Efron 1979). The
/// variance over the resamples, times n / (n - 1), is the group's part of the variance; its half width is the root of
/// that times Student's quantile of n - 1 degrees of freedom, and half widths add up in squares. (A plain bootstrap of
/// three tests is far too narrow.) A group of one test makes every interval infinite. Random numbers depend on `seed`:
/// the same tests have the same intervals. Excludes non-finite numbers.
std::vector<support::Estimate> intervalsOfTests(const std::vector<int>& groupSizes,
                                                const std::function<std::vector<double>(const TestCounts&)>& statistic,
                                                std::uint64_t seed = 1, int resamples = 400);

} // namespace grouser::virtual_tests
