// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/comm.hpp"
#include "runs/output/option_names.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace grouser::session {

/// What is asked of a run, beside its scene.
struct RunRequest {
  std::filesystem::path folder;                ///< of the results
  bool force = false;                          ///< overwrite what is there
  output::OptionNames names;                   ///< of these three in messages
  std::optional<std::filesystem::path> resume; ///< go on from this checkpoint, in the folder it lies in
  std::optional<std::filesystem::path> replay; ///< set what was set in the run of this folder
  bool branch = false;                ///< that checkpoint is of another run: this one begins in a folder of its own
  bool untilRest = false;             ///< stop before the first step of the drive
  bool hash = false;                  ///< take the state hash at the end
  std::optional<std::int64_t> steps;  ///< stop after so many steps instead of the scene's duration
  std::string commandLine;            ///< for the manifest
  std::string switches;               ///< for the manifest: switchesText() of the scene
  bool cache = true;                  ///< take beds and parts' spheres from earlier runs, and keep them
  const base::Ranks* ranks = nullptr; ///< that run the scene together; null: this program alone

  base::Comm comm() const { return ranks ? ranks->comm() : base::Comm(); }
};

} // namespace grouser::session
