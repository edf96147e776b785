// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/support/line_fit.hpp"

#include <cstdint>
#include <functional>
#include <vector>

/// Intervals of what is fitted to whole tests, by resampling the tests.
namespace grouser::virtual_tests {

/// How often each test counts: [group][test]. In the data themselves all are 1.
using TestCounts = std::vector<std::vector<int>>;

/// 95 % intervals of `statistic`, several numbers of all tests. Tests of one group are alike and independent (seeds of
/// one plate); groups are independent of each other.
///
/// Each group is resampled by itself, whole tests with replacement (Efron 1979), the others as they are. The variance
/// of what comes out, times n / (n - 1), is the group's part of the variance; its half width is the root of that times
/// Student's quantile of n - 1 degrees of freedom, and half widths add up in squares. (A
/// plain bootstrap of three tests would claim far too much.) A group of one test makes every interval infinite.
/// Random numbers are those of `seed`: the same tests give the same intervals. What is no number in a resample is left
/// out of it.
std::vector<support::Estimate> intervalsOfTests(const std::vector<int>& groupSizes,
                                                const std::function<std::vector<double>(const TestCounts&)>& statistic,
                                                std::uint64_t seed = 1, int resamples = 400);

} // namespace grouser::virtual_tests
