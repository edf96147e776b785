// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace grouser::commands {

struct ReportCommand {
  std::string folder; ///< of a run, a sweep, a check or a soil's tests
  std::string file;   ///< of the page; empty: report.html in the folder
  std::string film;   ///< to be in it; empty: one that lies in the folder
  int frames = 60;    ///< at most so many in the 3-D view; 0: no view
  int grains = 40000; ///< at most so many there
  bool force = false; ///< overwrite the page
};

/// Writes one page of all that a folder of results holds, to be looked at without a server or a network, by the scripts
/// of runs/report/. Throws InputError where the folder holds no results, or damaged ones, where the page is there
/// already, and where Python, its packages or a library of the page are not installed.
void reportCommand(const ReportCommand& command);

} // namespace grouser::commands
