// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/support/program_call.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace grouser::output {

/// The plots that runs/plots/ can draw from a results.h5.
inline const std::vector<std::string> kAllPlots = {"shoe_heights", "sinkage",   "surface", "bed",
                                                   "drive",        "mechanism", "ledger",  "figure"};

/// Draws `names` as NAME.png into `folder` by Python and matplotlib, and returns the files drawn; a plot whose
/// quantities the results lack is omitted. If Python or a package is missing, nothing is drawn, and `warning` names the
/// package.
std::vector<std::filesystem::path> drawPlots(const std::filesystem::path& results, const std::filesystem::path& folder,
                                             const std::vector<std::string>& names, std::string& warning);

/// Draws by `script` of runs/plots/ what `inputs` hold into `file`, in place of a former one, and prints its name; on
/// stderr a warning where it could not be drawn. Silent if there is nothing to draw.
void drawPicture(const std::string& script, const std::vector<std::filesystem::path>& inputs,
                 const std::filesystem::path& file);

/// Runs a Python script with these words and waits for it. The scripts in share end with kMissingPackage where
/// something is not installed, and say what on their last line.
support::CallOutcome callPython(const std::filesystem::path& script, const std::vector<std::string>& words);
inline constexpr int kMissingPackage = 3;

/// Runs a Python script with these words. False, with a `warning`, on failure.
bool runScript(const std::filesystem::path& script, const std::vector<std::string>& words, std::string& warning);

} // namespace grouser::output
