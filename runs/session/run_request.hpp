// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/comm.hpp"
#include "runs/output/option_names.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace grouser::session {

/// Options of a run, in addition to its scene.
struct RunRequest {
  std::filesystem::path folder;                ///< results folder
  bool force = false;                          ///< overwrite existing results
  output::OptionNames names;                   ///< names of --out, --force and --resume in messages
  std::optional<std::filesystem::path> resume; ///< resume from this checkpoint, in its folder
  std::optional<std::filesystem::path> replay; ///< repeat the inputs of the run in this folder
  bool branch = false;                         ///< start a new run from the checkpoint `resume`, in another folder
  bool untilRest = false;                      ///< stop before the first step of the drive
  bool hash = false;                           ///< compute the state hash at the end
  std::optional<std::int64_t> steps;           ///< stop after this number of steps instead of run.duration
  bool verbose = false;                        ///< print ledger, momentum, and run time at the end
  std::string commandLine;                     ///< command line for the manifest
  std::string switches;                        ///< switchesText() of the scene, for the manifest
  bool cache = true;                           ///< use the cache of settled beds and sphere sets
  const base::Ranks* ranks = nullptr;          ///< ranks of the run; null: a single process

  base::Comm comm() const { return ranks ? ranks->comm() : base::Comm(); }
};

} // namespace grouser::session
