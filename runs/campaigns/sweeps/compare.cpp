// SPDX-License-Identifier: BSD-3-Clause
#include "runs/campaigns/sweeps/compare.hpp"

#include "base/error.hpp"
#include "runs/campaigns/sweeps/compare_results.hpp"
#include "runs/campaigns/sweeps/grounds.hpp"
#include "runs/campaigns/sweeps/overrides.hpp"
#include "runs/campaigns/sweeps/scene_check.hpp"
#include "runs/campaigns/sweeps/sweep_files.hpp"
#include "runs/output/plots.hpp"
#include "runs/scene/scene_file.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/support/build_info.hpp"
#include "runs/support/json_text.hpp"
#include "runs/support/text_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace grouser::sweeps {

namespace fs = std::filesystem;
using base::InputError;
using scene::TerrainKind;

namespace {

constexpr const char* kGroundKey = "ground";
constexpr const char *kText = "compare.txt", *kTable = "compare.csv", *kJson = "compare.json", *kPlot = "compare.png";

scene::Scene sceneOn(TerrainKind ground, const fs::path& file, const std::vector<std::string>& overrides, bool check) {
  try {
    scene::Scene scene = setup::loadScene(file, overrides);
    if (check) checkScene(scene);
    return scene;
  } catch (const InputError& fault) {
    throw InputError(fmt::format("--grounds {}: {}", base::wordOf(ground), fault.what()));
  }
}

std::vector<std::string> overridesOn(TerrainKind ground, const fs::path& file, const std::vector<std::string>& fixed) {
  try {
    return groundOverrides(file, fixed, ground);
  } catch (const InputError& fault) {
    throw InputError(fmt::format("--grounds {}: {}", base::wordOf(ground), fault.what()));
  }
}

void writeComparison(const fs::path& scene, const Comparison& comparison, const CompareOptions& options) {
  const fs::path& folder = options.sweep.folder;
  const std::string text = comparisonText(comparison, options.percent);
  fmt::print("\n{}\n", text);
  nlohmann::ordered_json json = {{"command", options.words},
                                 {"machine", support::machineText()},
                                 {"commit", support::buildInfo().commit},
                                 {"scene", scene.string()},
                                 {"set", options.fixed},
                                 {"bar_percent", options.percent}};
  json.update(comparisonJson(comparison));
  support::replaceTextFile(folder / kText, text);
  support::replaceTextFile(folder / kTable, comparisonCsv(comparison));
  support::replaceTextFile(folder / kJson, support::jsonText(json, 2) + "\n");
  for (const char* name : {kText, kTable, kJson, kSummaryFile}) fmt::print("table     {}\n", (folder / name).string());
  if (options.sweep.plot) output::drawPicture("compare.py", {folder / kJson}, folder / kPlot);
}

} // namespace

std::vector<TerrainKind> groundsOf(const std::vector<std::string>& words) {
  std::vector<TerrainKind> grounds;
  for (const std::string& word : words) {
    const auto ground = base::valueOf<TerrainKind>(word);
    if (!ground)
      throw InputError(fmt::format("--grounds {}: is not a kind of ground; give two or more of {}", word,
                                   fmt::join(base::wordsOf<TerrainKind>(), ", ")));
    if (std::find(grounds.begin(), grounds.end(), *ground) != grounds.end())
      throw InputError(fmt::format("--grounds: {} is there twice; remove one", word));
    grounds.push_back(*ground);
  }
  if (grounds.size() < 2)
    throw InputError(fmt::format("--grounds {}: a comparison needs two or more of {}", fmt::join(words, ","),
                                 fmt::join(base::wordsOf<TerrainKind>(), ", ")));
  return grounds;
}

SweepPlan planCompare(const fs::path& scene, const CompareOptions& options) {
  SweepPlan plan;
  plan.scene = scene;
  plan.keys = {kGroundKey, kSeedKey};
  for (const TerrainKind ground : options.grounds) {
    const std::string word(base::wordOf(ground));
    const std::vector<std::string> overrides = overridesOn(ground, scene, options.fixed);
    const bool random = ground == TerrainKind::granular;
    for (int seed = 1; seed <= (random ? options.seeds : 1); ++seed) {
      SweepRun run;
      run.name = random ? fmt::format("{},seed={}", word, seed) : word;
      run.overrides = overrides;
      if (random) putOverride(run.overrides, fmt::format("{}={}", kSeedKey, seed));
      run.scene = sceneOn(ground, scene, run.overrides, seed == 1);
      run.values = {word, fmt::format("{}", run.scene.run.seed)};
      plan.runs.push_back(std::move(run));
    }
  }
  return plan;
}

int runCompare(const fs::path& scene, const CompareOptions& options) {
  if (!options.sweep.force) checkSweepFiles(options.sweep.folder);
  const SweepPlan plan = planCompare(scene, options);
  scene::printNotes(plan.runs.front().scene);
  const auto outcomes = runMissing(plan, options.sweep, "compare", [&](const std::vector<SweepOutcome>& now) {
    writeSummary(plan, now, options.sweep.folder);
  });
  writeComparison(scene, comparisonOf(plan, outcomes, options.grounds, options.percent, options.sweep.folder), options);
  const auto failed = std::count_if(outcomes.begin(), outcomes.end(),
                                    [](const SweepOutcome& o) { return o.status == output::RunStatus::failed; });
  for (std::size_t i = 0; i < outcomes.size(); ++i)
    if (outcomes[i].status == output::RunStatus::failed)
      fmt::print("WARNING: {} failed: {}\n", plan.runs[i].name, outcomes[i].message);
  return static_cast<int>(failed);
}

} // namespace grouser::sweeps
