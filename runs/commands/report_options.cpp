// SPDX-License-Identifier: BSD-3-Clause
#include "runs/commands/command_entry.hpp"

#include "runs/commands/report_command.hpp"
#include "runs/support/option_checks.hpp"

#include <memory>

namespace grouser::commands {

void addReport(CLI::App& app, const Invocation&) {
  const auto command = std::make_shared<ReportCommand>();
  ReportCommand& r = *command;
  CLI::App* report = app.add_subcommand("report", "HTML page about a run, sweep, check, set of events, soil test or "
                                                  "calibration: figures with error bars, plots, 3-D view, provenance");
  report->add_option("folder", r.folder, "folder of the results")->required();
  support::addOut(*report, r.file, "file of the page; default: report.html in the folder");
  report->add_option("--film", r.film, "film to embed; default: one in the folder, if it is small enough");
  report
      ->add_option("--frames", r.frames,
                   "maximum number of frames in the 3-D view, evenly spread over those of the run; 0: no view")
      ->check(support::wholeNumber(0))
      ->capture_default_str();
  report
      ->add_option(
          "--grains", r.grains,
          "maximum number of grains in the 3-D view: those at the bed surface first, then those that moved most")
      ->check(support::wholeNumber(1))
      ->capture_default_str();
  report->add_flag("--force", r.force, "overwrite an existing page");
  report->callback([command] { reportCommand(*command); });
}

} // namespace grouser::commands
