// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>

#include <optional>
#include <string>
#include <vector>

namespace grouser::commands {

/// Options of a command that performs each run in a separate process. The variables must outlive the parser.
struct ProcessOptions {
  int& jobs;
  double& seconds;
  bool& force;
  std::string &folder, &device;
  std::optional<int>& threads;
};

/// Adds --jobs, --seconds, --out, --device, --threads, --resume and --force. `outHelp`: help text of --out.
void addProcessOptions(CLI::App& app, const ProcessOptions& options, const std::string& outHelp);

/// Adds the scene overrides that --device and --threads define.
void addDeviceOverrides(std::vector<std::string>& overrides, const std::string& device,
                        const std::optional<int>& threads);

} // namespace grouser::commands
