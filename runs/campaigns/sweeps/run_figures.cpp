// SPDX-License-Identifier: BSD-3-Clause
#include "runs/campaigns/sweeps/run_figures.hpp"

#include "base/error.hpp"
#include "runs/campaigns/sweeps/kept_checks.hpp"
#include "runs/campaigns/sweeps/run_manifest.hpp"
#include "runs/campaigns/sweeps/run_notices.hpp"
#include "runs/campaigns/sweeps/sweep_summary.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/drive_length.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/support/hdf5_file.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <array>
#include <cmath>
#include <exception>
#include <fstream>
#include <iterator>

namespace grouser::sweeps {

namespace {

nlohmann::ordered_json jsonNumber(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
}

/// Range of the hull's speed, for sprockets at constant speeds; null otherwise.
nlohmann::ordered_json speedRange(const scene::Scene& scene, const std::array<double, 2>& range) {
  const scene::Driver& driver = scene.driver;
  const bool isConstant = setup::commandsDrive(scene) && !driver.course && !driver.table && !driver.torqueTable;
  return isConstant && range[0] <= range[1] ? nlohmann::ordered_json(range) : nullptr;
}

/// Throws base::InputError if scene.toml differs from the copy in results.h5.
void requireSameScene(const std::filesystem::path& folder) {
  std::ifstream file(folder / "scene.toml", std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  if (text != support::Hdf5File::open(folder / "results.h5").text("/", "scene"))
    throw base::InputError(
        fmt::format("{}: differs from the scene in results.h5; restore the file from a copy, or run the scene again",
                    (folder / "scene.toml").string()));
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
  requireSameScene(folder);
  const scene::Scene& scene = plan.runs.front().scene;
  const SweepFigures found = sweepFigures(
      plan, {{complete ? output::RunStatus::finished : output::RunStatus::incomplete, manifest.text("incomplete")}},
      whole.parent_path());
  for (std::size_t i = 0; i < found.columns.size(); ++i)
    json["figures"].push_back({{"name", found.columns[i]}, {"value", jsonNumber(found.values.front()[i])}});
  json["inconclusive"] = found.doubtOf(std::size_t{0});
  json["steady_from"] = jsonNumber(found.from.front());
  json["speed_range"] = speedRange(scene, found.speedRange.front());
  json["until"] = jsonNumber(manifest.number("simulated_time_s"));
  json["hitch"] = scene.hitch.has_value();
  json["rigid_ground"] = isOnRigidGround(scene);
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
