// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace grouser::commands {

struct ReportCommand {
  std::string folder; ///< results folder of a run, sweep, check, set of events, soil test or calibration
  std::string file;   ///< HTML page; empty: report.html in the folder
  std::string film;   ///< film to embed; empty: films in the folder
  int frames = 60;    ///< maximum number of frames in the 3-D view; 0: no 3-D view
  int grains = 40000; ///< maximum number of grains in the 3-D view
  bool force = false; ///< overwrite the page
};

/// Writes an HTML page for a results folder with the scripts of runs/report/; the page needs no server or network.
/// Throws InputError if the results are missing or damaged, if the page exists (unless `force`), or if Python, its
/// packages or a library of the page is not installed.
void reportCommand(const ReportCommand& command);

} // namespace grouser::commands
