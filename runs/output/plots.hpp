// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/support/program_call.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace grouser::output {

/// Plots that the scripts in runs/plots/ can draw from results.h5.
inline const std::vector<std::string> kAllPlots = {"shoe_heights", "sinkage",   "surface", "bed",
                                                   "drive",        "mechanism", "ledger",  "figure"};

/// Draws the plots `names` with Python and matplotlib as NAME.png in `folder`, and returns the files. Omits a plot if
/// the results lack its quantities. If Python or a package is missing, draws nothing, and `warning` names the missing
/// package.
std::vector<std::filesystem::path> drawPlots(const std::filesystem::path& results, const std::filesystem::path& folder,
                                             const std::vector<std::string>& names, std::string& warning);

/// Calls `script` of runs/plots/ with `inputs` to draw `file`, replacing an existing file, and prints the file name; on
/// failure, prints a warning to stderr. Prints nothing if there is nothing to draw.
void drawPicture(const std::string& script, const std::vector<std::filesystem::path>& inputs,
                 const std::filesystem::path& file);

/// Runs a Python script with these arguments and waits for it. The installed scripts exit with kMissingPackage if a
/// package is missing, and print its name on the last line.
support::CallOutcome callPython(const std::filesystem::path& script, const std::vector<std::string>& words);
inline constexpr int kMissingPackage = 3;

/// Runs a Python script with these arguments. Returns false and sets `warning` on failure.
bool runScript(const std::filesystem::path& script, const std::vector<std::string>& words, std::string& warning);

} // namespace grouser::output
