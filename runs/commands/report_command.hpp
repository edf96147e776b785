// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace grouser::commands {

struct ReportCommand {
  std::string folder; ///< results of a run, a sweep, a check or a soil's tests
  std::string file;   ///< HTML page; empty: report.html in the folder
  std::string film;   ///< film to embed; empty: one in the folder
  int frames = 60;    ///< maximum number in the 3-D view; 0: no view
  int grains = 40000; ///< maximum number in the 3-D view
  bool force = false; ///< overwrite the page
};

/// Writes an HTML page for a results folder with the scripts of runs/report/; the page needs no server or network.
/// Throws InputError if the results are missing or damaged, if the page exists (unless `force`), or if Python, its
/// packages or a library of the page is not installed.
void reportCommand(const ReportCommand& command);

} // namespace grouser::commands
