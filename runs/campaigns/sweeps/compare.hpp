// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/campaigns/sweeps/runner.hpp"

#include <filesystem>
#include <string>
#include <vector>

/// `grouser compare`: one scene on several kinds of ground, or with several contact methods.
namespace grouser::sweeps {

struct CompareOptions {
  SweepOptions sweep;
  std::vector<scene::TerrainKind> grounds;    ///< at least two, or empty
  std::vector<scene::ContactMethod> contacts; ///< at least two, or empty
  std::vector<double> steps{1};               ///< multiples of the time step of each contact method, ascending
  int seeds = 3;                              ///< runs per variant with grains; other variants have one run
  std::vector<std::string> fixed;             ///< "key=value" for all runs
  double percent = 5;                         ///< tolerance of the verdict "equal" [% of the larger mean]
  std::string words;                          ///< the whole command line
};

/// Kinds of ground, or contact methods, with these names. Throws InputError for unknown or duplicate names, and for
/// fewer than two.
std::vector<scene::TerrainKind> groundsOf(const std::vector<std::string>& words);
std::vector<scene::ContactMethod> contactsOf(const std::vector<std::string>& words);

/// One run for each variant and, with grains, for each seed. Loads and checks the scene of each run; throws InputError
/// with the variant in the message.
SweepPlan planCompare(const std::filesystem::path& scene, const CompareOptions& options);

/// Performs the missing runs (runMissing()), and writes compare.txt, compare.csv, compare.json, compare.png and
/// summary.csv. Returns the number of failed runs.
int runCompare(const std::filesystem::path& scene, const CompareOptions& options);

} // namespace grouser::sweeps
