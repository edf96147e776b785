// SPDX-License-Identifier: BSD-3-Clause
#include "runs/commands/process_options.hpp"

#include "runs/support/option_checks.hpp"

#include <fmt/format.h>

namespace grouser::commands {

void addProcessOptions(CLI::App& app, const ProcessOptions& options, const std::string& outHelp) {
  app.add_option("--jobs", options.jobs, "number of concurrent runs; default: 1")->check(support::wholeNumber(1, 1024));
  app.add_option("--seconds", options.seconds,
                 "start no new runs after this wall time [s]; 0: no limit; repeat the command to continue")
      ->check(support::notNegative("a time in seconds"));
  support::addOut(app, options.folder, outHelp);
  app.add_option("--device", options.device, "auto, cpu or cuda; default: run.device of the scene");
  app.add_option("--threads", options.threads,
                 "number of CPU threads per run; default: all available cores (at most OMP_NUM_THREADS), divided among "
                 "the jobs")
      ->check(support::wholeNumber(0, 1024));
  CLI::Option* resume =
      app.add_flag("--resume")->description("continue an earlier call (the default if the options are the same)");
  app.add_flag("--force", options.force, "repeat runs that have already finished")->excludes(resume);
}

void addDeviceOverrides(std::vector<std::string>& overrides, const std::string& device,
                        const std::optional<int>& threads) {
  if (!device.empty()) overrides.push_back("run.device=" + device);
  if (threads) overrides.push_back(fmt::format("run.threads={}", *threads));
}

} // namespace grouser::commands
