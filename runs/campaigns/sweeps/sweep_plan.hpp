// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/scene/scene.hpp"
#include "runs/storage/checkpoint.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// What a sweep is to run: all combinations of the values given.
namespace grouser::sweeps {

/// What is asked of a sweep, as words of the command line.
struct SweepLists {
  std::vector<std::string> sets = {}; ///< "key=value,value..."
  std::vector<std::string> cases =
      {};        ///< "NAME: key=value, key=value": keys that change together; a name alone: no key
  int seeds = 0; ///< each combination with run.seed 1 to so many; 0: as the scene says
};

inline constexpr const char* kCaseKey = "case";               ///< stands for the cases among the keys of a sweep
inline constexpr const char* kSeedKey = "run.seed";           ///< over its values means and intervals are taken
inline constexpr const char* kDrawKey = "scm.constants_draw"; ///< sample of the soil constants

/// One run of a sweep.
struct SweepRun {
  std::string name;                           ///< of its folder: "deep,sprocket_speed=0.5,seed=1"
  std::vector<std::string> values;            ///< as given, one a swept key
  std::vector<std::string> overrides;         ///< "key=value", the swept ones and the fixed ones
  scene::Scene scene;                         ///< with the overrides applied
  std::filesystem::path file{};               ///< of its scene; empty: the plan's
  bool untilRest = false;                     ///< it stops before its drive
  std::optional<storage::BranchPoint> from{}; ///< that it begins with
  double expectedEnd = 0;                     ///< simulated time at which it will likely end [s]; 0: run.duration
};

struct SweepPlan {
  std::filesystem::path scene;
  std::vector<std::string> keys; ///< the swept ones: kCaseKey, those of --set in the order given, kSeedKey
  std::vector<SweepRun> runs;    ///< the last key changes fastest
};

/// Cuts at commas that stand outside quotes, brackets and braces: "[1, 2],[3, 4]" is two values.
std::vector<std::string> splitValues(std::string_view list);

/// A key with a list of values.
struct KeyValues {
  std::string key;
  std::vector<std::string> values;
};
/// Parses "key=value,value...". Throws InputError for a missing key, a missing or empty value, or a duplicate value;
/// the message names the command-line `option` and shows `example`.
KeyValues keyValues(const std::string& set, const std::string& option, const std::string& example);

/// Replaces each run of characters that are unsafe in folder names by an underscore.
std::string plainText(const std::string& text);

/// The runs of `scene` over the product of all lists, every scene of them loaded and checked as `grouser plan` does. A
/// key of --set with one value is fixed; where nothing has several, those with one are swept. `fixed` are overrides for
/// all runs. Throws InputError for the first wrong value, for a key that is given twice, and for a sweep of nothing.
SweepPlan planSweep(const std::filesystem::path& scene, const SweepLists& lists,
                    const std::vector<std::string>& fixed = {});

} // namespace grouser::sweeps
