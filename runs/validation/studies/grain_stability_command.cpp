// SPDX-License-Identifier: BSD-3-Clause
// `grouser study stability`: tables and files of the maps.
#include "base/error.hpp"
#include "runs/output/plots.hpp"
#include "runs/support/progress.hpp"
#include "runs/support/stop_signals.hpp"
#include "runs/support/text_file.hpp"
#include "runs/validation/studies/grain_stability.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <chrono>
#include <cmath>
#include <functional>

namespace grouser::studies {

namespace {

/// Number of cells that agree with the prediction, e.g. "18 of 18".
std::string counted(const GrainStabilityMap& map, const std::function<bool(const GrainStabilityCell&)>& which) {
  int all = 0, agree = 0;
  for (const GrainStabilityCell& c : map.cells)
    if (which(c)) ++all, agree += c.agrees();
  return fmt::format("{} of {}", agree, all);
}

bool at(const GrainStabilityCell& c, double share) { return std::fabs(c.ofLimit - share) < 1e-9; }

/// The damping ratios of a map, in the order of the cells.
std::vector<double> zetasOf(const GrainStabilityMap& map) {
  std::vector<double> zetas;
  for (const GrainStabilityCell& c : map.cells)
    if (std::find(zetas.begin(), zetas.end(), c.zeta) == zetas.end()) zetas.push_back(c.zeta);
  return zetas;
}

struct Found {
  double highestStable = 0, lowestUnstable = INFINITY; ///< [1 / sqrt(k / m)]
};
Found foundAt(const GrainStabilityMap& map, double zeta) {
  Found found;
  for (const GrainStabilityCell& c : map.cells)
    if (c.zeta == zeta)
      c.stable ? found.highestStable = std::max(found.highestStable, c.scaled)
               : found.lowestUnstable = std::min(found.lowestUnstable, c.scaled);
  return found;
}

} // namespace

std::string grainStabilityTable(const GrainStabilityMap& map) {
  const RestingGrains& r = map.grains;
  int beyondStable = 0, withinUnstable = 0, stopped = 0;
  for (const GrainStabilityCell& c : map.cells)
    beyondStable += c.stable && !c.calm, withinUnstable += !c.stable && c.calm, stopped += c.stopped;
  std::string text = fmt::format(
      "\n{}: {} contacts, highest frequency {:.4f} sqrt(k/m), Gershgorin {:.4f}; resultant force / weight of a grain "
      "{:.1e}\n  {:>6} {:>16} {:>16} {:>16} {:>22}\n",
      r.title, r.network.contacts.size(), r.frequency, r.gershgorin, r.forceRatio, "zeta", "stable up to",
      "unstable from", "predicted limit", "calm up to");
  const double stiffness = map.cells.front().stiffness;
  for (const double zeta : zetasOf(map)) {
    const Found found = foundAt(map, zeta);
    const double scale = map.cells.front().scaled / map.cells.front().timeStep;
    const double limit = predictedLimit(r, zeta), calm = calmLimit(r, stiffness, zeta) * scale;
    text += fmt::format("  {:>6g} {:>16.4f} {:>16.4f} {:>16.4f} {:>13.4f} ({:.2f})\n", zeta, found.highestStable,
                        found.lowestUnstable, limit, calm, calm / limit);
  }
  text += fmt::format("  steps in 1 / sqrt(k/m); in brackets: step / predicted limit\n  as predicted: {} cells; at "
                      "0.95 of the limit {}, at 1.05 {}\n  bound \"calm up to\": excludes {} stable cells, includes {} "
                      "unstable cells; guards stopped {} runs\n",
                      counted(map, [](const GrainStabilityCell&) { return true; }),
                      counted(map, [](const GrainStabilityCell& c) { return at(c, 0.95); }),
                      counted(map, [](const GrainStabilityCell& c) { return at(c, 1.05); }), beyondStable,
                      withinUnstable, stopped);
  return text;
}

std::string grainStabilityCsv(const std::vector<GrainStabilityMap>& maps) {
  std::string text =
      "case,stiffness [N/m],zeta [-],step [s],step sqrt(k/m) [-],step over the predicted limit [-],"
      "predicted,found,kinetic energy over that of the disturbance [-],stopped by a guard,within the bound of calm\n";
  for (const GrainStabilityMap& map : maps)
    for (const GrainStabilityCell& c : map.cells)
      text += fmt::format("{},{},{},{},{},{},{},{},{},{},{}\n", map.grains.name, c.stiffness, c.zeta, c.timeStep,
                          c.scaled, c.ofLimit, c.predicted() ? "stable" : "unstable", c.stable ? "stable" : "unstable",
                          c.growth, c.stopped ? 1 : 0, c.calm ? 1 : 0);
  return text;
}

std::string stabilityLimitsCsv(const std::vector<GrainStabilityMap>& maps) {
  constexpr int kPoints = 81;
  constexpr double kLargest = 2;
  std::string text = "case,zeta [-],predicted limit [1/sqrt(k/m)],calm [1/sqrt(k/m)]\n";
  for (const GrainStabilityMap& map : maps) {
    const GrainStabilityCell& c = map.cells.front();
    for (int k = 0; k < kPoints; ++k) {
      const double zeta = kLargest * k / (kPoints - 1);
      text += fmt::format("{},{},{},{}\n", map.grains.name, zeta, predictedLimit(map.grains, zeta),
                          calmLimit(map.grains, c.stiffness, zeta) * c.scaled / c.timeStep);
    }
  }
  return text;
}

void studyGrainStabilityCommand(const GrainStabilityCommand& command) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point begin = Clock::now();
  const auto folder = jobs::beginStudy("stability", command.place);
  const support::StopSignals signals;
  const bool quick = command.place.quick;
  fmt::print("          radius 5 mm, 2600 kg/m3; unstable: the kinetic energy exceeds {:g} times the energy of a small "
             "disturbance within {} steps, or a guard stops the run\n",
             kGrowth, kStabilitySteps);
  const StabilityAxes axes = stabilityAxes(quick);
  const int bed = command.bedGrains;
  const std::vector<std::function<RestingGrains()>> makers = {
      [] { return oneContact(); }, [&] { return column(command.columnGrains); }, [&] { return randomBed(bed, 0); },
      [&] { return randomBed(bed, 0.5); }};
  support::Progress progress("studying");
  std::vector<GrainStabilityMap> maps;
  for (const auto& make : makers) {
    progress.update(static_cast<double>(maps.size()) / static_cast<double>(makers.size()), "settling");
    const RestingGrains grains = make();
    progress.update((static_cast<double>(maps.size()) + 0.3) / static_cast<double>(makers.size()), grains.title);
    maps.push_back(stabilityMap(grains, axes));
    progress.note(grainStabilityTable(maps.back()));
  }
  progress.finish(fmt::format("{} maps", maps.size()));
  support::writeTextFile(folder / "stability.csv", grainStabilityCsv(maps), "--out");
  support::writeTextFile(folder / "limits.csv", stabilityLimitsCsv(maps), "--out");
  nlohmann::ordered_json counts;
  for (const GrainStabilityMap& map : maps) {
    nlohmann::ordered_json& j = counts[map.grains.name];
    j["cells"] = map.cells.size();
    j["as_predicted"] = std::count_if(map.cells.begin(), map.cells.end(), [](const auto& c) { return c.agrees(); });
    j["highest_frequency"] = map.grains.frequency, j["gershgorin"] = map.grains.gershgorin;
  }
  jobs::writeStudyOrigin(folder, "stability", std::chrono::duration<double>(Clock::now() - begin).count(),
                         {{"steps", kStabilitySteps}, {"growth", kGrowth}, {"quick", quick}, {"maps", counts}});
  output::drawPicture("study_stability.py", {folder / "stability.csv", folder / "limits.csv"},
                      folder / "stability.png");
  fmt::print("tables    {}\n", folder.string());
}

} // namespace grouser::studies
