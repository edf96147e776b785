// SPDX-License-Identifier: BSD-3-Clause
#include "runs/campaigns/sweeps/run_figures.hpp"

#include "base/error.hpp"
#include "base/math.hpp"
#include "runs/campaigns/sweeps/kept_checks.hpp"
#include "runs/campaigns/sweeps/run_manifest.hpp"
#include "runs/campaigns/sweeps/sweep_summary.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/drive_length.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/support/hdf5_file.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <exception>
#include <vector>

namespace grouser::sweeps {

namespace {

nlohmann::ordered_json jsonNumber(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
}

/// Minimum and maximum of the hull's speed in the steady part [m/s], for sprockets at constant speeds; null otherwise.
nlohmann::ordered_json speedRange(const scene::Scene& scene, const std::filesystem::path& results, double from) {
  const scene::Driver& driver = scene.driver;
  if (!setup::asksToDrive(scene) || driver.course || driver.table || driver.torqueTable) return nullptr;
  const support::Hdf5File file = support::Hdf5File::open(results);
  const std::vector<double> times = file.numbers("/series/time");
  std::vector<double> speeds(times.size());
  int tracks = 0;
  for (const std::string dataset : {"/vehicle/left/speed/value", "/vehicle/right/speed/value"}) {
    if (!file.has(dataset)) continue;
    const std::vector<double> track = file.numbers(dataset);
    ++tracks;
    for (std::size_t i = 0; i < std::min(speeds.size(), track.size()); ++i) speeds[i] += track[i];
  }
  double low = base::kInfinity, high = -base::kInfinity;
  for (std::size_t i = 0; i < times.size(); ++i)
    if (const double speed = speeds[i] / tracks; times[i] >= from && std::isfinite(speed))
      low = std::min(low, speed), high = std::max(high, speed);
  return low <= high ? nlohmann::ordered_json{low, high} : nullptr;
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
  const auto column = std::find(found.columns.begin(), found.columns.end(), "steady from [s]");
  const double from = column == found.columns.end()
                          ? steadyFrom(scene, manifest)
                          : found.values.front()[static_cast<std::size_t>(column - found.columns.begin())];
  json["steady_from"] = jsonNumber(from), json["speed_range"] = speedRange(scene, whole / "results.h5", from);
  json["check"] = keptCheck(scene, manifest.text("inputs"));
  return json;
}

} // namespace

nlohmann::ordered_json runFigures(const std::filesystem::path& folder) {
  try {
    return figuresOf(folder);
  } catch (const std::exception& error) {
    return {{"figures", nlohmann::ordered_json::array()},
            {"check", nullptr},
            {"note", std::string("no means over the steady part: ") + error.what()}};
  }
}

} // namespace grouser::sweeps
