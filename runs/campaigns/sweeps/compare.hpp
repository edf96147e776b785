// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/campaigns/sweeps/runner.hpp"

#include <filesystem>
#include <string>
#include <vector>

/// `grouser compare`: the same scene on several kinds of ground, or with several contact methods.
namespace grouser::sweeps {

struct CompareOptions {
  SweepOptions sweep;
  std::vector<scene::TerrainKind> grounds;    ///< at least two, or none
  std::vector<scene::ContactMethod> contacts; ///< at least two, or none
  int seeds = 3;                              ///< runs per variant with grains; other grounds have one run
  std::vector<std::string> fixed;             ///< "key=value" for all runs
  double percent = 5;                         ///< largest difference of figures that counts as equal
  std::string words;                          ///< the whole command line
};

/// Kinds of ground, or contact methods, by their words. Throws InputError for unknown or duplicate words, and for fewer
/// than two.
std::vector<scene::TerrainKind> groundsOf(const std::vector<std::string>& words);
std::vector<scene::ContactMethod> contactsOf(const std::vector<std::string>& words);

/// One run for each variant and, with grains, each seed. Loads and checks the scene of every run; throws InputError
/// that names the variant.
SweepPlan planCompare(const std::filesystem::path& scene, const CompareOptions& options);

/// Performs the missing runs (runMissing()), and writes compare.txt, compare.csv, compare.json, compare.png and
/// summary.csv. Returns the number of failed runs.
int runCompare(const std::filesystem::path& scene, const CompareOptions& options);

} // namespace grouser::sweeps
