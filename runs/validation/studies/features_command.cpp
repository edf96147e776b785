// SPDX-License-Identifier: BSD-3-Clause
// `grouser study features`: measures the cost of each feature, and checks that disabled features cost nothing.
#include "base/error.hpp"
#include "coupling/simulation.hpp"
#include "runs/output/plots.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/setup/simulation_setup.hpp"
#include "runs/storage/sphere_cache.hpp"
#include "runs/support/csv_cell.hpp"
#include "runs/support/device_choice.hpp"
#include "runs/support/progress.hpp"
#include "runs/support/stop_signals.hpp"
#include "runs/support/stopwatch.hpp"
#include "runs/support/text_file.hpp"
#include "runs/validation/studies/features.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <memory>

namespace grouser::studies {

namespace {

constexpr const char* kVehicle = "vehicle";
constexpr const char* kOutput = "output";
constexpr const char* kRanksName = "ranks";
constexpr double kReady = 0.05; // time from which on the vehicle drives with its full weight [s]

std::vector<std::string> allNames() {
  std::vector<std::string> names;
  for (const Feature& f : features())
    if (!f.neutral) names.push_back(f.name);
  names.insert(names.end(), {kVehicle, kOutput, kRanksName});
  for (const Feature& f : features())
    if (f.neutral) names.push_back(f.name);
  return names;
}

std::string whatOf(const std::string& name) {
  if (name == kVehicle) return "driven [vehicle]; total time per step and total memory, not per grain";
  if (name == kOutput) return "a row and a frame every 100 steps";
  if (name == kRanksName) return "two ranks with one thread each, compared with one rank with two threads";
  return std::find_if(features().begin(), features().end(), [&](const Feature& f) { return f.name == name; })->what;
}

nlohmann::ordered_json recipeOf(const FeaturesCommand& c) {
  return {{"study", "features"}, {"grains", c.grains},        {"pairs", c.pairs},
          {"turn_s", c.turn},    {"device", c.pieces.device}, {"threads", c.pieces.threads}};
}

std::string vehicleScene(bool with) {
  const std::string bed = "version = 1\n[run]\nduration = 10\ntime_step = 1e-4\n[material.soil]\nstiffness = 1e6\n"
                          "[terrain]\nheightmap = \"heightmaps/flat.png\"\nsize = [4.9, 2.5]\nheight_range = [0, 0]\n"
                          "material = \"soil\"\ngrain_radius = 0.04\ndepth = 0.2\nsettle_time_limit = 20\n"
                          "settle_kinetic_energy = 1e-3\ncache = false\n";
  return with ? bed + "[vehicle]\nspec = \"vehicles/light_tracked.toml\"\nsphere_radius = 0.02\n[driver]\n"
                      "sprocket_speed = 1\ntension_ramp = 0.01\nweight_ramp = 0.01\ndrive_start = 0.02\n"
                      "drive_ramp = 0.02\n"
              : bed;
}

jobs::Table measured(const FeaturesCommand& c, const std::string& name, const base::Exec& exec,
                     const std::filesystem::path& folder) {
  if (name == kVehicle) return measureVehicle(c, exec);
  if (name == kOutput) return measureOutput(c, exec, folder);
  if (name == kRanksName) return measureRanks(c, folder);
  for (const Feature& f : features())
    if (f.name == name) return measureFeature(c, f, exec);
  throw std::logic_error(name + ": unknown feature");
}

} // namespace

jobs::Table measureVehicle(const FeaturesCommand& c, const base::Exec& exec) {
  std::unique_ptr<coupling::Simulation> runs[2];
  double bytes[2] = {0, 0};
  std::optional<storage::SphereCache> spheres = storage::SphereCache::ofUser();
  for (const bool with : {false, true}) {
    auto& run = runs[with ? 1 : 0];
    run = std::make_unique<coupling::Simulation>(
        setup::simulationSetup(setup::parseScene(vehicleScene(with), "features.toml")), exec,
        coupling::SettleProgress([](double, double) { jobs::stopStudyOnRequest(); }), base::Comm(), nullptr,
        spheres ? &*spheres : nullptr);
    while (run->time() < kReady) run->step();
    bytes[with ? 1 : 0] = static_cast<double>(run->ground().grains->system().deviceBytes());
  }
  const auto advance = [&](coupling::Simulation& run, std::int64_t steps) {
    for (std::int64_t i = 0; i < steps;) i += run.advance(steps - i);
    base::synchronize(exec);
  };
  const support::Stopwatch first;
  advance(*runs[1], 20);
  const std::int64_t steps = std::max<std::int64_t>(10, std::llround(c.turn / (first.seconds() / 20)));
  jobs::Table table{kFeatureColumns, {}};
  for (int k = 0; k <= c.pairs; ++k) {
    jobs::stopStudyOnRequest();
    double times[2];
    for (const bool with : {k % 2 != 0, k % 2 == 0}) {
      const support::Stopwatch begin;
      advance(*runs[with ? 1 : 0], steps);
      times[with ? 1 : 0] = 1e9 * begin.seconds() / static_cast<double>(steps);
    }
    const auto grains = [&](int i) { return static_cast<double>(runs[i]->ground().grains->count()); };
    if (k > 0) table.rows.push_back({times[0], times[1], bytes[0], bytes[1], grains(0), grains(1), 0});
  }
  return table;
}

void studyFeaturesCommand(const FeaturesCommand& c) {
  const std::vector<std::string> known = allNames(), wanted = c.features.empty() ? known : c.features;
  for (const std::string& name : wanted)
    if (std::find(known.begin(), known.end(), name) == known.end())
      throw base::InputError(
          fmt::format("study features: --features {}: unknown feature; choose from {}", name, fmt::join(known, ", ")));
  jobs::Pieces pieces("features", c.place, c.pieces, recipeOf(c));
  const support::StopSignals signals;
  const support::Stopwatch begin;
  const base::Exec exec = support::chooseDevice(support::deviceChoice(c.pieces.device), c.pieces.threads, nullptr);
  fmt::print("          about {} grains on {}; {} pairs of measurements of {:g} s; +-: 95 % interval over the pairs\n",
             c.grains, base::describe(exec), c.pairs, c.turn);
  support::Progress progress("measuring");
  int done = 0;
  for (const std::string& name : wanted) {
    progress.update(double(done++) / static_cast<double>(wanted.size()), name);
    if (pieces.due(name)) pieces.keep(name, measured(c, name, exec, pieces.begin(name)));
  }
  progress.finish(fmt::format("{} of {} features finished", wanted.size() - static_cast<std::size_t>(pieces.left()),
                              wanted.size()));
  if (!pieces.whole()) return;

  std::string csv = "feature,what,without [ns],with [ns],difference [ns],half width [ns],relative [-],half width [-],"
                    "bytes without,bytes with,verdict\n";
  fmt::print("\n  {:<14} {:>10} {:>10} {:>18} {:>16} {:>9} {:>9}  {}\n", "feature", "without", "with", "difference",
             "of without", "bytes", "with", "feature");
  fmt::print("  {:<14} {:>10} {:>10} {:>18} {:>16} {:>9} {:>9}\n", "", "ns", "ns", "ns/(grain step)", "%", "per grain",
             "");
  for (const std::string& name : wanted) {
    if (!pieces.has(name)) continue;
    const FeatureCost cost = costOf(pieces.read(name));
    const bool neutral = name.rfind("off_", 0) == 0;
    const std::string verdict = !neutral ? "" : cost.isNothing() ? "nothing" : "UNEXPECTED COST";
    fmt::print("  {:<14} {:>10.1f} {:>10.1f} {:>18} {:>16} {:>9.0f} {:>9.0f}  {}{}\n", name, cost.without, cost.with,
               jobs::plusMinus(cost.difference, 1), jobs::percent(cost.relative), cost.bytesWithout, cost.bytesWith,
               whatOf(name), verdict.empty() ? "" : ": " + verdict);
    csv += fmt::format("{},{},{:.6g},{:.6g},{:.4g},{:.4g},{:.4g},{:.4g},{:.6g},{:.6g},{}\n", name,
                       support::csvCell(whatOf(name)), cost.without, cost.with, cost.difference.value,
                       cost.difference.halfWidth, cost.relative.value, cost.relative.halfWidth, cost.bytesWithout,
                       cost.bytesWith, verdict);
  }
  if (pieces.left() > 0) fmt::print("missing features: {}; repeat the command with --resume\n", pieces.left());
  support::writeTextFile(pieces.folder() / "features.csv", csv, "--out");
  jobs::writeStudyOrigin(pieces.folder(), "features", begin.seconds(), recipeOf(c));
  output::drawPicture("study_features.py", {pieces.folder() / "features.csv"}, pieces.folder() / "features.png");
  fmt::print("tables    {}\n", pieces.folder().string());
}

} // namespace grouser::studies
