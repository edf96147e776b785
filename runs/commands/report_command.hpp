// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace grouser::commands {

struct ReportCommand {
  std::string folder; ///< of a run, a sweep, a check or a soil's tests
  std::string file;   ///< of the page; empty: report.html in the folder
  std::string film;   ///< to embed; empty: one in the folder
  int frames = 60;    ///< maximum in the 3-D view; 0: no view
  int grains = 40000; ///< maximum in the 3-D view
  bool force = false; ///< overwrite the page
};

/// Writes an HTML page about a results folder, viewable without a server or a network, with the scripts of
/// runs/report/. Throws InputError if the folder has no results or damaged ones, if the page exists, and if Python, its
/// packages or a library of the page are not installed.
void reportCommand(const ReportCommand& command);

} // namespace grouser::commands
