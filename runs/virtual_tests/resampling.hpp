// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/support/line_fit.hpp"

#include <cstdint>
#include <functional>
#include <vector>

/// Intervals of fitted constants by resampling whole tests.
namespace grouser::virtual_tests {

/// Multiplicity of each test in a resample: [group][test]; 1 in the original data.
using TestCounts = std::vector<std::vector<int>>;

/// 95 % intervals of `statistic`, a vector computed from all tests. Tests of a group (e.g. seeds of one plate) are
/// independent and identically distributed; groups are independent.
///
/// Each group of n tests is resampled separately with replacement (Efron 1979). The
/// variance over the resamples, times n / (n - 1), is the group's part of the variance; the square root of this part,
/// times Student's quantile for n - 1 degrees of freedom, is the group's half width. The squares of the half widths are
/// summed. (The intervals of a plain bootstrap of three tests are far too narrow.) A group of one test makes every
/// interval infinite. Equal tests and an equal `seed` result in equal intervals. Excludes non-finite statistics.
std::vector<support::Estimate> intervalsOfTests(const std::vector<int>& groupSizes,
                                                const std::function<std::vector<double>(const TestCounts&)>& statistic,
                                                std::uint64_t seed = 1, int resamples = 400);

} // namespace grouser::virtual_tests
