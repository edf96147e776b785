// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/campaigns/sweeps/runner.hpp"

#include <filesystem>
#include <string>
#include <vector>

/// `grouser compare`: the same vehicle and drive on several kinds of ground.
namespace grouser::sweeps {

struct CompareOptions {
  SweepOptions sweep;
  std::vector<scene::TerrainKind> grounds; ///< at least two
  int seeds = 3;                           ///< of a granular bed; other grounds have nothing random, and one run
  std::vector<std::string> fixed;          ///< "key=value", of all runs
  double percent = 5;                      ///< of a figure, within which it counts as equal
  std::string words;                       ///< the whole command line
};

/// Kinds of ground by their words. Throws InputError for a word that is none, for one that is there twice, and for
/// fewer than two.
std::vector<scene::TerrainKind> groundsOf(const std::vector<std::string>& words);

/// A run for each ground and, on grains, each seed. The scene of every run is loaded and checked; throws InputError
/// that names the ground.
SweepPlan planCompare(const std::filesystem::path& scene, const CompareOptions& options);

/// Runs what is missing (runMissing()), and writes compare.txt, compare.csv, compare.json, compare.png and summary.csv.
/// Returns the number of failed runs.
int runCompare(const std::filesystem::path& scene, const CompareOptions& options);

} // namespace grouser::sweeps
