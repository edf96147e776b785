// SPDX-License-Identifier: BSD-3-Clause
#include "runs/campaigns/sweeps/kept_checks.hpp"

#include "base/counted.hpp"
#include "base/error.hpp"
#include "base/math.hpp"
#include "runs/campaigns/sweeps/check_cases.hpp"
#include "runs/campaigns/sweeps/check_choice.hpp"
#include "runs/campaigns/sweeps/check_report.hpp"
#include "runs/campaigns/sweeps/overrides.hpp"
#include "runs/campaigns/sweeps/runner.hpp"
#include "runs/jobs/estimate.hpp"
#include "runs/scene/scene.hpp"
#include "runs/support/file_hash.hpp"
#include "runs/support/json_text.hpp"
#include "runs/support/kept_files.hpp"
#include "runs/support/kept_json.hpp"
#include "runs/support/locations.hpp"
#include "runs/support/progress.hpp"
#include "runs/support/shell_word.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <exception>
#include <fstream>
#include <limits>

namespace grouser::sweeps {

namespace {

namespace fs = std::filesystem;

constexpr auto kCheck = support::KeptFiles::Kind::check;
constexpr const char* kShippedChecks = "runs/scenes/checks";
constexpr int kSeedsOfCheck = 8; // number of seeds of a full check

nlohmann::json readJson(const fs::path& path) {
  std::ifstream file(path);
  return nlohmann::json::parse(file, nullptr, false);
}

double numberOrInfinity(const nlohmann::json& json, const char* key) {
  const auto at = json.find(key);
  return at != json.end() && at->is_number() ? at->get<double>() : base::kInfinity;
}

/// Check that the user has run for a scene of this origin; not a JSON object if there is no such check.
nlohmann::json usersCheck(const std::string& origin) {
  const auto kept = support::KeptFiles::ofUser();
  if (!kept) return {};
  return support::keptJson(*kept, kCheck, origin);
}

/// Check from runs/scenes/checks, installed with the program; not a JSON object if there is no such check.
nlohmann::json shippedCheck(const std::string& origin) {
  const std::string hash = originHash(origin);
  std::error_code error;
  for (const fs::directory_entry& file : fs::directory_iterator(support::shareFolder() / kShippedChecks, error)) {
    const nlohmann::json check = readJson(file.path());
    if (check.is_object() && check.value("origin", "") == hash)
      return {{"folder", file.path().string()}, {"check", check}};
  }
  return {};
}

/// "step, depth, 8 seeds": contributions to the error bar of a figure.
std::string partsOf(const nlohmann::json& figure, bool seeded) {
  std::string text;
  for (const nlohmann::json& e : figure.at("errors"))
    text += fmt::format("{}{}", text.empty() ? "" : ", ", e.at("axis").get<std::string>());
  if (seeded)
    text += fmt::format("{}{}", text.empty() ? "" : ", ", base::counted(figure.at("seeds").get<int>(), "seed"));
  return text;
}

/// `listed`: include the figures.
std::string barsText(const nlohmann::json& kept, bool listed) {
  constexpr int kMax = 12;
  const nlohmann::json& check = kept.at("check");
  std::string text, parts;
  int printed = 0, more = 0;
  for (const nlohmann::json& f : check.at("figures")) {
    if (!f.value("headline", false) || !f.at("value").is_number()) continue;
    if (++printed > kMax) ++more;
    if (printed > kMax) continue;
    if (parts.empty()) parts = partsOf(f, check.at("seeds_matter").get<bool>());
    text += fmt::format("  {:<44} {}\n", f.at("name").get<std::string>(),
                        jobs::valueText({f.at("value").get<double>(), numberOrInfinity(f, "bar")}));
  }
  if (more > 0) text += fmt::format("  and {} more\n", more);
  return fmt::format("checked   error bars from {}, taken from the last check of this scene ({}, commit {})\n{}", parts,
                     kept.at("folder").get<std::string>(), check.at("program").at("commit").get<std::string>(),
                     listed ? text : "");
}

/// Command that checks this scene with its overrides.
std::string commandOf(const scene::Scene& scene) {
  std::string text = fmt::format("grouser check {}", support::shellWord(scene.file.string()));
  for (const std::string& o : scene.overrides)
    if (keyOf(o) != "run.seed") text += fmt::format(" --set {}", support::shellWord(o));
  return text;
}

} // namespace

std::string checkOrigin(scene::Scene scene, const std::string& inputs) {
  const scene::RunSettings fresh;
  scene.run.seed = fresh.seed, scene.run.frameInterval = fresh.frameInterval;
  scene.run.checkpointInterval = fresh.checkpointInterval;
  scene.output = {}, scene.parallel = {};
  return identity(scene) + inputs;
}

std::string originHash(std::string origin) {
  const std::string share = support::shareFolder().string() + "/";
  for (std::size_t at = origin.find(share); at != std::string::npos; at = origin.find(share, at))
    origin.erase(at, share.size());
  return support::hashOfText(origin);
}

void keepCheck(const std::string& origin, const std::string& json, int runs, bool ofSome, const fs::path& folder) {
  const auto kept = support::KeptFiles::ofUser();
  if (!kept || !kept->writable()) return;
  try {
    const nlohmann::json check = nlohmann::json::parse(json), former = usersCheck(origin);
    const bool wasOfSome = former.is_object() && former.value("of_some", false);
    if (former.is_object() && (ofSome != wasOfSome ? ofSome : former.value("runs", 0) > runs) &&
        former.at("check").at("program").at("commit") == check.at("program").at("commit"))
      return;
    support::keepJson(*kept, kCheck, origin,
                      nlohmann::json::object({{"runs", runs},
                                              {"of_some", ofSome},
                                              {"folder", fs::absolute(folder).lexically_normal().string()},
                                              {"check", check}}));
  } catch (const std::exception&) {
    return; // then later runs print no error bars
  }
}

std::string checkNote(const scene::Scene& scene, const std::string& inputs, double runSeconds, bool listed) {
  try {
    const nlohmann::json kept = keptCheck(scene, inputs);
    if (kept.is_object()) return barsText(kept, listed);
  } catch (const nlohmann::json::exception&) {
    // damaged, or from another version
  }
  const std::string whole = support::Progress::duration(runSeconds * runsOfWholeCheck(scene, kSeedsOfCheck));
  if (scene.vehicle && seedMatters(scene))
    return fmt::format(
        "no error bars yet; for sinkage and torque (at least {}; without --of, all figures: about {}), run\n"
        "  {} --bar 20% --of sinkage,torque\n",
        support::Progress::duration(runSeconds * runsOfBarCases(scene, kFewSeeds)), whole, commandOf(scene));
  return fmt::format("no error bars yet; to compute them (about {}; --budget 20min limits this), run\n  {}\n", whole,
                     commandOf(scene));
}

nlohmann::json keptCheck(const scene::Scene& scene, const std::string& inputs) {
  const std::string origin = checkOrigin(scene, inputs);
  nlohmann::json kept = usersCheck(origin);
  return kept.is_object() ? kept : shippedCheck(origin);
}

void checkFolderOfCheck(const fs::path& folder) {
  const nlohmann::json json = readJson(folder / kCheckFile);
  if (json.is_object() && json.contains("origin") && json.contains("figures")) return;
  std::error_code error;
  const nlohmann::json choice = readJson(folder / kCheckChoice);
  if (fs::exists(folder / kCheckChoice, error) && !(choice.is_object() && choice.contains("asked")))
    throw base::InputError(fmt::format(
        "{}: exists but was not written by a check; choose another folder with --out, or overwrite it with --force",
        (folder / kCheckChoice).string()));
  for (const char* name : {kCheckFile, kCheckCosts, kCheckSeries, kCheckPlot})
    if (fs::exists(folder / name, error))
      throw base::InputError(fmt::format(
          "{}: exists but was not written by a check; choose another folder with --out, or overwrite it with --force",
          (folder / name).string()));
}

} // namespace grouser::sweeps
