// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <filesystem>

/// What a sweep writes beside the folders of its runs.
namespace grouser::sweeps {

inline constexpr const char *kSummaryFile = "summary.csv", *kSummaryPlot = "summary.png",
                            *kIntervalsFile = "intervals.csv";
inline constexpr std::array kSweepFiles = {kSummaryFile, kSummaryPlot, kIntervalsFile};

/// Throws InputError where the folder holds one of these that no sweep has written. Touches nothing.
void checkSweepFiles(const std::filesystem::path& folder);

} // namespace grouser::sweeps
