// SPDX-License-Identifier: BSD-3-Clause
#include "runs/campaigns/sweeps/compare.hpp"

#include "base/error.hpp"
#include "runs/campaigns/sweeps/compare_results.hpp"
#include "runs/campaigns/sweeps/grounds.hpp"
#include "runs/campaigns/sweeps/overrides.hpp"
#include "runs/campaigns/sweeps/run_notices.hpp"
#include "runs/campaigns/sweeps/scene_check.hpp"
#include "runs/campaigns/sweeps/sweep_files.hpp"
#include "runs/output/plots.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/setup/step_limit.hpp"
#include "runs/support/build_info.hpp"
#include "runs/support/json_text.hpp"
#include "runs/support/text_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace grouser::sweeps {

namespace fs = std::filesystem;
using base::InputError;
using scene::ContactMethod;
using scene::TerrainKind;

namespace {

constexpr const char* kVariantKey = "variant";
constexpr const char *kText = "compare.txt", *kTable = "compare.csv", *kJson = "compare.json", *kPlot = "compare.png";

/// A variant of the scene.
struct Variant {
  std::string option, word;
  bool random; ///< whether it has one run per seed
  std::vector<std::string> overrides;
};

/// Calls `make` and adds the variant to error messages.
template <class Make> auto naming(const std::string& option, const std::string& word, const Make& make) {
  try {
    return make();
  } catch (const InputError& fault) {
    throw InputError(fmt::format("{} {}: {}", option, word, fault.what()));
  }
}

/// Adds a variant for each multiple of the method's own time step.
void addContact(std::vector<Variant>& variants, const fs::path& scene, const CompareOptions& options,
                ContactMethod contact) {
  const std::string word(base::wordOf(contact)), option = "--contact";
  const std::vector<std::string> overrides = contactOverrides(scene, options.fixed, contact);
  const bool isOwn = options.steps == std::vector<double>{1};
  const double own =
      isOwn ? 0 : naming(option, word, [&] { return setup::chooseTimeStep(setup::loadScene(scene, overrides)); });
  for (const double step : options.steps) {
    Variant variant{option, word, true, overrides};
    if (step != 1) {
      variant.word += fmt::format("_x{:g}", step);
      putOverride(variant.overrides, fmt::format("run.time_step={:.9g}", step * own));
    }
    variants.push_back(std::move(variant));
  }
}

std::vector<Variant> variantsOf(const fs::path& scene, const CompareOptions& options) {
  std::vector<Variant> variants;
  for (const TerrainKind ground : options.grounds) {
    const std::string word(base::wordOf(ground)), option = "--grounds";
    variants.push_back({option, word, ground == TerrainKind::granular,
                        naming(option, word, [&] { return groundOverrides(scene, options.fixed, ground); })});
  }
  for (const ContactMethod contact : options.contacts) addContact(variants, scene, options, contact);
  return variants;
}

/// Values of an option: at least two, without duplicates.
template <class Enum>
std::vector<Enum> differentOf(const std::vector<std::string>& words, const std::string& option, const char* what) {
  std::vector<Enum> values;
  const std::string choices = fmt::format("{}", fmt::join(base::wordsOf<Enum>(), ", "));
  for (const std::string& word : words) {
    const auto value = base::valueOf<Enum>(word);
    if (!value)
      throw InputError(fmt::format("{} {}: is not {}; choose two or more of {}", option, word, what, choices));
    if (std::find(values.begin(), values.end(), *value) != values.end())
      throw InputError(fmt::format("{}: {} is listed twice; remove one", option, word));
    values.push_back(*value);
  }
  if (values.size() < 2)
    throw InputError(
        fmt::format("{} {}: a comparison requires two or more of {}", option, fmt::join(words, ","), choices));
  return values;
}

bool hasSinkage(const Comparison& comparison) {
  for (std::size_t c = 0; c < comparison.columns.size(); ++c)
    for (const VariantResult& variant : comparison.variants)
      if (comparison.columns[c].starts_with("sinkage") && std::isfinite(variant.figures[c].value)) return true;
  return false;
}

void writeComparison(const SweepPlan& plan, const Comparison& comparison, const CompareOptions& options) {
  const fs::path& folder = options.sweep.folder;
  const std::vector<RunNotice> notices = runNotices(plan, folder, hasSinkage(comparison));
  const std::string text =
      noticesText(notices, plan.runs.size()) + comparisonText(comparison, options.percent, options.steps.size() > 1);
  fmt::print("\n{}\n", text);
  nlohmann::ordered_json json = {{"command", options.words},
                                 {"machine", support::machineText()},
                                 {"commit", support::buildInfo().commit},
                                 {"scene", plan.scene.string()},
                                 {"set", options.fixed},
                                 {"bar_percent", options.percent},
                                 {"notices", noticesJson(notices)}};
  json.update(comparisonJson(comparison));
  support::replaceTextFile(folder / kText, text);
  support::replaceTextFile(folder / kTable, comparisonCsv(comparison));
  support::replaceTextFile(folder / kJson, support::jsonText(json, 2) + "\n");
  for (const char* name : {kText, kTable, kJson, kSummaryFile}) fmt::print("table     {}\n", (folder / name).string());
  if (options.sweep.plot) output::drawPicture("compare.py", {folder / kJson}, folder / kPlot);
}

SweepPlan planOf(const fs::path& scene, const std::vector<Variant>& variants, int seeds) {
  SweepPlan plan;
  plan.scene = scene;
  plan.keys = {kVariantKey, kSeedKey};
  for (const Variant& variant : variants)
    for (int seed = 1; seed <= (variant.random ? seeds : 1); ++seed) {
      SweepRun run;
      run.name = variant.random ? fmt::format("{},seed={}", variant.word, seed) : variant.word;
      run.overrides = variant.overrides;
      if (variant.random) putOverride(run.overrides, fmt::format("{}={}", kSeedKey, seed));
      run.scene = naming(variant.option, variant.word, [&] {
        scene::Scene loaded = setup::loadScene(scene, run.overrides);
        if (seed == 1) checkScene(loaded);
        return loaded;
      });
      run.values = {variant.word, fmt::format("{}", run.scene.run.seed)};
      plan.runs.push_back(std::move(run));
    }
  return plan;
}

} // namespace

std::vector<TerrainKind> groundsOf(const std::vector<std::string>& words) {
  return differentOf<TerrainKind>(words, "--grounds", "a kind of ground");
}

std::vector<ContactMethod> contactsOf(const std::vector<std::string>& words) {
  return differentOf<ContactMethod>(words, "--contact", "a contact method");
}

SweepPlan planCompare(const fs::path& scene, const CompareOptions& options) {
  return planOf(scene, variantsOf(scene, options), options.seeds);
}

int runCompare(const fs::path& scene, const CompareOptions& options) {
  const Claim claim(options.sweep);
  if (!options.sweep.force) checkSweepFiles(options.sweep.folder);
  const std::vector<Variant> variants = variantsOf(scene, options);
  const SweepPlan plan = planOf(scene, variants, options.seeds);
  printNotesOf(plan);
  const auto outcomes = runMissing(plan, options.sweep, "compare", [&](const std::vector<SweepOutcome>& now) {
    writeSummary(plan, now, options.sweep.folder);
  });
  std::vector<std::string> random;
  for (const Variant& variant : variants)
    if (variant.random) random.push_back(variant.word);
  writeComparison(plan, comparisonOf(plan, outcomes, random, options.percent, options.sweep.folder), options);
  const auto failed = std::count_if(outcomes.begin(), outcomes.end(),
                                    [](const SweepOutcome& o) { return o.status == output::RunStatus::failed; });
  for (std::size_t i = 0; i < outcomes.size(); ++i)
    if (outcomes[i].status == output::RunStatus::failed)
      fmt::print("WARNING: {} failed: {}\n", plan.runs[i].name, outcomes[i].message);
  return static_cast<int>(failed);
}

} // namespace grouser::sweeps
