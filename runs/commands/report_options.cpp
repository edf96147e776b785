// SPDX-License-Identifier: BSD-3-Clause
#include "runs/commands/command_entry.hpp"

#include "runs/commands/report_command.hpp"
#include "runs/support/option_checks.hpp"

#include <memory>

namespace grouser::commands {

void addReport(CLI::App& app, const Invocation&) {
  const auto command = std::make_shared<ReportCommand>();
  ReportCommand& r = *command;
  CLI::App* report = app.add_subcommand("report", "One page for a browser of all that a run, sweep, check, set of "
                                                  "events, soil or calibration has left: figures with their error "
                                                  "bars, plots, 3-D view, provenance");
  report->add_option("folder", r.folder, "the folder of the results")->required();
  support::addOut(*report, r.file, "file of the page; default: report.html in the folder");
  report->add_option("--film", r.film, "film to be in it; default: one that lies in the folder and is not too large");
  report
      ->add_option("--frames", r.frames,
                   "at most so many frames in the 3-D view, evenly spread over those of the run; 0: no view")
      ->check(support::wholeNumber(0))
      ->capture_default_str();
  report
      ->add_option("--grains", r.grains,
                   "at most so many grains there: those at the surface of the bed first, then those that moved most")
      ->check(support::wholeNumber(1))
      ->capture_default_str();
  report->add_flag("--force", r.force, "overwrite a page that is there already");
  report->callback([command] { reportCommand(*command); });
}

} // namespace grouser::commands
