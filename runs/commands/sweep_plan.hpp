// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/scene/scene.hpp"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

/// What a sweep is to run: all combinations of the values given.
namespace grouser::commands {

/// One run of a sweep.
struct SweepRun {
  std::string name;                   ///< of its folder: "sprocket_speed=0.5,seed=1"
  std::vector<std::string> values;    ///< as given, one a swept key
  std::vector<std::string> overrides; ///< "key=value", the swept ones and the fixed ones
  scene::Scene scene;                 ///< with the overrides applied
};

struct SweepPlan {
  std::filesystem::path scene;
  std::vector<std::string> keys; ///< the swept ones, in the order given: "driver.sprocket_speed"
  std::vector<SweepRun> runs;    ///< the last key changes fastest
};

/// Cuts at commas that stand outside quotes, brackets and braces: "[1, 2],[3, 4]" is two values.
std::vector<std::string> splitValues(std::string_view list);

/// The runs of `scene` over the product of all lists in `sets` ("key=value,value..."), every scene of them loaded and
/// checked as `grouser plan` does. A key with one value is fixed; where no key has several, those with one are swept.
/// `fixed` are overrides for all runs. Throws InputError for the first wrong value, and for a sweep without a key.
SweepPlan planSweep(const std::filesystem::path& scene, const std::vector<std::string>& sets,
                    const std::vector<std::string>& fixed = {});

} // namespace grouser::commands
