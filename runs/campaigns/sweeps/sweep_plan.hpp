// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/scene/scene.hpp"
#include "runs/storage/checkpoint.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// Runs of a sweep: all combinations of the values.
namespace grouser::sweeps {

/// Options of a sweep from the command line.
struct SweepLists {
  std::vector<std::string> sets = {}; ///< "key=value,value..."
  std::vector<std::string> cases =
      {};        ///< "NAME: key=value, key=value": keys that change together; a name without keys: unchanged
  int seeds = 0; ///< runs each combination with run.seed = 1 to this number; 0: seed of the scene
};

inline constexpr const char* kCaseKey = "case";               ///< key of the cases
inline constexpr const char* kSeedKey = "run.seed";           ///< means and intervals are over its values
inline constexpr const char* kDrawKey = "scm.constants_draw"; ///< sample of the soil constants

/// One run of a sweep.
struct SweepRun {
  std::string name;                           ///< folder name: "deep,sprocket_speed=0.5,seed=1"
  std::vector<std::string> values;            ///< as given, one per swept key
  std::vector<std::string> overrides;         ///< "key=value", swept and fixed
  scene::Scene scene;                         ///< with the overrides applied
  std::filesystem::path file{};               ///< scene file; empty: scene file of the plan
  bool untilRest = false;                     ///< the run stops before its drive
  std::optional<storage::BranchPoint> from{}; ///< initial state
  double expectedEnd = 0;                     ///< expected simulated time at the end [s]; 0: run.duration
};

struct SweepPlan {
  std::filesystem::path scene;
  std::vector<std::string> keys; ///< swept keys: kCaseKey, those of --set in order, kSeedKey
  std::vector<SweepRun> runs;    ///< the last key changes fastest
};

/// Splits a list at commas outside quotes, brackets and braces: "[1, 2],[3, 4]" has two values.
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

/// Plans the runs of `scene` for all combinations of the lists; loads and checks each scene as `grouser plan` does. A
/// key with a single value in --set is fixed, unless all keys have a single value. `fixed`: overrides for all runs.
/// Throws InputError for an invalid value, a duplicate key, or an empty sweep.
SweepPlan planSweep(const std::filesystem::path& scene, const SweepLists& lists,
                    const std::vector<std::string>& fixed = {});

} // namespace grouser::sweeps
