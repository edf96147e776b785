// SPDX-License-Identifier: BSD-3-Clause
#include "runs/commands/command_entry.hpp"

#include "runs/commands/report_command.hpp"
#include "runs/support/option_checks.hpp"

#include <memory>

namespace grouser::commands {

void addReport(CLI::App& app, const Invocation&) {
  const auto command = std::make_shared<ReportCommand>();
  ReportCommand& r = *command;
  CLI::App* report =
      app.add_subcommand("report", "Write an HTML report on a run, sweep, check, set of events, soil test or "
                                   "calibration: figures with error bars, plots, 3-D view, provenance");
  report->add_option("folder", r.folder, "results folder")->required();
  support::addOut(*report, r.file, "file of the report; default: report.html in the folder");
  report->add_option("--film", r.film,
                     "film to embed; default: films in the folder, up to 4 MB in total (several runs: 6 MB)");
  report
      ->add_option("--frames", r.frames,
                   "maximum number of frames in the 3-D view, evenly spaced over the run; 0: no 3-D view")
      ->check(support::wholeNumber(0))
      ->capture_default_str();
  report
      ->add_option("--grains", r.grains,
                   "maximum number of grains in the 3-D view; priority: grains at the bed surface, then grains that "
                   "moved most")
      ->check(support::wholeNumber(1))
      ->capture_default_str();
  report->add_flag("--force", r.force, "overwrite an existing report");
  report->callback([command] { reportCommand(*command); });
}

} // namespace grouser::commands
