// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>

#include <optional>
#include <string>
#include <vector>

namespace grouser::commands {

/// Options of a command whose runs are processes of their own. The fields outlive the command line.
struct ProcessOptions {
  int& jobs;
  double& seconds;
  bool& force;
  std::string &folder, &device;
  std::optional<int>& threads;
};

/// Adds --jobs, --seconds, --out, --device, --threads, --resume and --force; `outHelp`: of --out.
void addProcessOptions(CLI::App& app, const ProcessOptions& options, const std::string& outHelp);

/// Adds the overrides of a scene by --device and --threads.
void addDeviceOverrides(std::vector<std::string>& overrides, const std::string& device,
                        const std::optional<int>& threads);

} // namespace grouser::commands
