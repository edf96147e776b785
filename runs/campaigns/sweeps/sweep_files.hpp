// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <filesystem>

/// Files of a sweep beside the folders of its runs.
namespace grouser::sweeps {

inline constexpr const char *kSummaryFile = "summary.csv", *kSummaryPlot = "summary.png",
                            *kIntervalsFile = "intervals.csv";
inline constexpr const char* kRunLog = "log.txt"; ///< printed output of a run, in its folder
inline constexpr std::array kSweepFiles = {kSummaryFile, kSummaryPlot, kIntervalsFile};

/// Throws InputError if the folder contains files with these names that no sweep wrote; does not modify the folder.
void checkSweepFiles(const std::filesystem::path& folder);

} // namespace grouser::sweeps
