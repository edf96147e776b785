// SPDX-License-Identifier: BSD-3-Clause
#include "runs/commands/process_options.hpp"

#include "runs/support/option_checks.hpp"

#include <fmt/format.h>

namespace grouser::commands {

void addProcessOptions(CLI::App& app, const ProcessOptions& options, const std::string& outHelp) {
  app.add_option("--jobs", options.jobs, "runs at the same time; default: 1")->check(support::wholeNumber(1, 1024));
  app.add_option("--seconds", options.seconds,
                 "this call begins no further run after so many, 0: no limit; the same command again continues")
      ->check(support::notNegative("a time in seconds"));
  support::addOut(app, options.folder, outHelp);
  app.add_option("--device", options.device, "auto, cpu or cuda; default: as the scene says");
  app.add_option("--threads", options.threads, "CPU threads of each run; default: all cores shared among the jobs")
      ->check(support::wholeNumber(0, 1024));
  CLI::Option* resume =
      app.add_flag("--resume")
          ->description("go on with what an earlier call has left, which the same command does anyway");
  app.add_flag("--force", options.force, "run again what has already been run")->excludes(resume);
}

void addDeviceOverrides(std::vector<std::string>& overrides, const std::string& device,
                        const std::optional<int>& threads) {
  if (!device.empty()) overrides.push_back("run.device=" + device);
  if (threads) overrides.push_back(fmt::format("run.threads={}", *threads));
}

} // namespace grouser::commands
