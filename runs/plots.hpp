// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace grouser::runs {

/// The plots that runs/plots/ can draw from a results.h5.
inline const std::vector<std::string> kAllPlots = {"shoe_heights", "sinkage", "drive", "mechanism", "ledger"};

/// Draws `names` as NAME.png into `folder` by Python and matplotlib, and returns the files drawn; a plot whose
/// quantities the results lack is left out. Where Python or a package is missing nothing is drawn, and `warning` says
/// what to install.
std::vector<std::filesystem::path> drawPlots(const std::filesystem::path& results, const std::filesystem::path& folder,
                                             const std::vector<std::string>& names, std::string& warning);

/// Draws the summary.csv of a sweep as summary.png into `folder`. Returns the file; empty, with a `warning`, where it
/// could not be drawn.
std::filesystem::path drawSweep(const std::filesystem::path& summary, const std::filesystem::path& folder,
                                std::string& warning);

/// Draws the multibody.csv of a study into `file`. False, with a `warning`, where it could not be drawn.
bool drawStudy(const std::filesystem::path& table, const std::filesystem::path& file, std::string& warning);

/// Runs a Python script with these words. False, with a `warning`, where it does not end well.
bool runScript(const std::filesystem::path& script, const std::vector<std::string>& words, std::string& warning);

/// Draws the JSON of `grouser bench contacts` as `file`. False, with a `warning`, where it could not be drawn.
bool drawContacts(const std::filesystem::path& json, const std::filesystem::path& file, std::string& warning);

} // namespace grouser::runs
