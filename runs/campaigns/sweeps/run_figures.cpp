// SPDX-License-Identifier: BSD-3-Clause
#include "runs/campaigns/sweeps/run_figures.hpp"

#include "base/error.hpp"
#include "runs/campaigns/sweeps/kept_checks.hpp"
#include "runs/campaigns/sweeps/run_manifest.hpp"
#include "runs/campaigns/sweeps/sweep_summary.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/support/json_text.hpp"

#include <nlohmann/json.hpp>

#include <cmath>
#include <exception>

namespace grouser::sweeps {

namespace {

nlohmann::ordered_json jsonNumber(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
}

nlohmann::ordered_json figuresOf(const std::filesystem::path& folder) {
  const RunManifest manifest(folder);
  nlohmann::ordered_json json{{"figures", nlohmann::ordered_json::array()}, {"check", nullptr}};
  const bool complete = manifest.text("status") == base::wordOf(output::RunStatus::finished);
  if (!complete && manifest.text("status") != base::wordOf(output::RunStatus::incomplete)) return json;
  SweepPlan plan;
  plan.scene = folder / "scene.toml";
  // Resolves paths that end in a slash or a dot.
  const std::filesystem::path whole = std::filesystem::canonical(folder);
  plan.runs.push_back({whole.filename().string(), {}, {}, setup::loadScene(plan.scene)});
  const scene::Scene& scene = plan.runs.front().scene;
  const SweepFigures found = sweepFigures(
      plan, {{complete ? output::RunStatus::finished : output::RunStatus::incomplete, manifest.text("incomplete")}},
      whole.parent_path());
  for (std::size_t i = 0; i < found.columns.size(); ++i)
    json["figures"].push_back({{"name", found.columns[i]}, {"value", jsonNumber(found.values.front()[i])}});
  json["inconclusive"] = found.doubtOf(std::size_t{0});
  json["steady_from"] = jsonNumber(steadyFrom(scene, manifest));
  if (const std::string check = keptCheckText(scene, manifest.text("inputs")); !check.empty())
    json["check"] = nlohmann::ordered_json::parse(check);
  return json;
}

} // namespace

std::string runFiguresText(const std::filesystem::path& folder) {
  try {
    return support::jsonText(figuresOf(folder));
  } catch (const std::exception& error) {
    return nlohmann::ordered_json{{"figures", nlohmann::ordered_json::array()},
                                  {"check", nullptr},
                                  {"note", std::string("no figures of the steady part: ") + error.what()}}
        .dump();
  }
}

} // namespace grouser::sweeps
