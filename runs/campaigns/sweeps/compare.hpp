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
  std::vector<std::string> fixed;             ///< "key=value", of all runs
  double percent = 5;                         ///< difference of two figures that counts as equal
  std::string words;                          ///< the whole command line
};

/// Kinds of ground, or contact methods, by their words. Throws InputError for a word that is none, for one that is
/// there twice, and for fewer than two.
std::vector<scene::TerrainKind> groundsOf(const std::vector<std::string>& words);
std::vector<scene::ContactMethod> contactsOf(const std::vector<std::string>& words);

/// A run for each ground or contact method and, of grains, each seed. The scene of every run is loaded and checked;
/// throws InputError that names the variant.
SweepPlan planCompare(const std::filesystem::path& scene, const CompareOptions& options);

/// Runs what is missing (runMissing()), and writes compare.txt, compare.csv, compare.json, compare.png and summary.csv.
/// Returns the number of failed runs.
int runCompare(const std::filesystem::path& scene, const CompareOptions& options);

} // namespace grouser::sweeps
