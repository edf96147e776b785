// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/scene/scene.hpp"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

/// Many runs of one scene, over the product of all given values.
///
/// Each run is a process of its own, so that one that fails, or crashes, takes no other with it, and that all memory
/// comes back between two runs.
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

struct SweepOptions {
  std::filesystem::path program; ///< of grouser
  std::filesystem::path folder;  ///< the runs' folders go in here, with summary.csv and summary.png
  int jobs = 1;                  ///< runs at the same time
  bool force = false;            ///< run again what has already been run, and overwrite folders of other origin
  bool plot = true;
};

/// Runs what is not there yet. A run is left out when its folder holds a finished one of the same resolved scene
/// (device, threads and the output folder aside, on which no result depends); what is half done or of another scene is
/// run again. summary.csv is written anew after every run. Returns the number of failed runs. Throws InputError, before
/// anything is started, where a run's folder holds something else.
int runSweep(const SweepPlan& plan, const SweepOptions& options);

} // namespace grouser::commands
