// SPDX-License-Identifier: BSD-3-Clause
// `grouser study stability --scene vehicle`: pieces, tables and files.
#include "runs/validation/studies/vehicle_stability.hpp"

#include "base/counted.hpp"
#include "base/error.hpp"
#include "runs/output/plots.hpp"
#include "runs/storage/bed_cache.hpp"
#include "runs/storage/sphere_cache.hpp"
#include "runs/support/device_choice.hpp"
#include "runs/support/private_folder.hpp"
#include "runs/support/progress.hpp"
#include "runs/support/stop_signals.hpp"
#include "runs/support/text_file.hpp"
#include "runs/validation/studies/trial_files.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>

namespace grouser::studies {

namespace fs = std::filesystem;

namespace {

std::string nameOf(const VehicleMap& map, std::size_t point) { return fmt::format("{}_{}", map.name, point); }
/// Name of the pair of runs at the neighbouring step `k`.
std::string nameBeside(const std::string& point, std::size_t k) { return fmt::format("{}_beside_{}", point, k); }

/// Inputs of the runs; --resume compares them.
nlohmann::ordered_json recipeOf(const std::vector<VehicleMap>& maps, bool quick) {
  nlohmann::ordered_json recipe = {{"study", "stability"}, {"scene", "vehicle"}, {"quick", quick}};
  for (const VehicleMap& map : maps) {
    nlohmann::ordered_json& points = recipe["points"][map.name];
    for (const MapPoint& p : map.points) points.push_back(fmt::format("{:.6g} {:.6g} at {:.6g} s", p.x, p.y, p.step));
  }
  return recipe;
}

/// Runs a scene at a step and at a quarter of this step.
void runPoint(const VehicleCase& what, double step, const std::string& name, const TrialPlace& kept,
              jobs::Pieces& pieces) {
  TrialPlace place = kept;
  place.folder = pieces.begin(name);
  std::vector<VehicleTrial> trials{tryVehicle(what, step, place)};
  if (trials[0].end != TrialEnd::refused) trials.push_back(tryVehicle(what, step / kFinerRatio, place));
  keepTrials(pieces, name, trials);
  fs::remove_all(place.folder);
}

TrialPair pairOf(const jobs::Pieces& pieces, const std::string& name) {
  const std::vector<VehicleTrial> trials = readTrials(pieces, name);
  return {trials.at(0), trials.size() > 1 ? trials[1] : VehicleTrial{}};
}

void runAll(const std::vector<VehicleMap>& maps, jobs::Pieces& pieces, const jobs::PieceOptions& options) {
  storage::BedCache beds(pieces.folder() / "kept");
  storage::SphereCache spheres{support::KeptFiles(pieces.folder() / "kept")};
  const base::Exec exec = support::chooseDevice(support::deviceChoice(options.device), options.threads, nullptr);
  const TrialPlace kept{{}, &beds, &spheres, exec};
  support::Progress progress("driving");
  double all = 0, done = 0;
  for (const VehicleMap& map : maps) all += static_cast<double>(map.points.size());
  for (const VehicleMap& map : maps)
    for (std::size_t i = 0; i < map.points.size(); ++i) {
      const MapPoint& p = map.points[i];
      const std::string name = nameOf(map, i);
      progress.update(done++ / all, name);
      if (pieces.due(name)) runPoint(p.what, p.step, name, kept, pieces);
      if (!pieces.has(name)) continue;
      if (const TrialPair pair = pairOf(pieces, name); !figuresDisagree(pair.run, pair.finer, map.onBed)) continue;
      for (std::size_t k = 0; k < kNeighbourShares.size(); ++k)
        if (const std::string beside = nameBeside(name, k); pieces.dueBeside(beside))
          runPoint(p.what, kNeighbourShares[k] * p.step, beside, kept, pieces);
    }
  progress.finish(fmt::format("{} missing of {} points", base::counted(pieces.left(), "run is", "runs are"), all));
}

std::vector<JudgedPoint> judged(const std::vector<VehicleMap>& maps, const jobs::Pieces& pieces) {
  std::vector<JudgedPoint> points;
  for (const VehicleMap& map : maps)
    for (std::size_t i = 0; i < map.points.size(); ++i) {
      const std::string name = nameOf(map, i);
      if (!pieces.has(name)) continue;
      JudgedPoint p{&map, &map.points[i], {pairOf(pieces, name)}, {}};
      bool whole = true;
      if (figuresDisagree(p.run(), p.finer(), map.onBed))
        for (std::size_t k = 0; k < kNeighbourShares.size() && whole; ++k)
          if (const std::string beside = nameBeside(name, k); (whole = pieces.has(beside)))
            p.pairs.push_back(pairOf(pieces, beside));
      if (!whole) continue; // a verdict requires all pairs
      p.judgement = judge(p.pairs, map.onBed);
      points.push_back(p);
    }
  return points;
}

void writeTables(const std::vector<VehicleMap>& maps, const std::vector<JudgedPoint>& points, const fs::path& folder) {
  support::writeTextFile(folder / "vehicle.csv", vehicleMapsCsv(points), "--out");
  support::writeTextFile(folder / "vehicle_limits.csv", predictedLinesCsv(maps), "--out");
  output::drawPicture("study_vehicle_stability.py", {folder / "vehicle.csv", folder / "vehicle_limits.csv"},
                      folder / "vehicle.png");
  if (std::any_of(points.begin(), points.end(), [](const JudgedPoint& p) { return p.pairs.size() > 1; }))
    support::writeTextFile(folder / "vehicle_neighbours.csv", neighboursCsv(points), "--out");
}

} // namespace

void studyVehicleStability(const VehicleStability& command, const jobs::StudyPlace& place) {
  const auto begin = std::chrono::steady_clock::now();
  const std::vector<std::string> names = command.maps.empty() ? vehicleMapNames() : command.maps;
  std::vector<VehicleMap> maps;
  {
    const support::PrivateFolder scratch("grouser_maps");
    for (const std::string& name : names) maps.push_back(vehicleMap(name, place.quick, scratch.path()));
  }
  jobs::Pieces pieces("stability_vehicle", place, command.pieces, recipeOf(maps, place.quick));
  const support::StopSignals signals;
  fmt::print("          light_tracked vehicle; each point is run at its step and at a quarter of this step\n");
  runAll(maps, pieces, command.pieces);
  if (!pieces.whole()) return;
  const std::vector<JudgedPoint> points = judged(maps, pieces);
  if (points.empty()) {
    fmt::print("no point has finished yet; repeat the command with --resume\n");
    return;
  }
  fmt::print("{}{}{}", vehicleMapsTable(points), seedScatterTable(points), neighboursTable(points));
  if (pieces.left() > 0)
    fmt::print("{} missing; repeat the command with --resume\n", base::counted(pieces.left(), "run is", "runs are"));
  nlohmann::ordered_json counts;
  for (std::size_t v = 0; v < kVerdictWords.size(); ++v)
    counts[kVerdictWords[v]] = pointsOf(points, "", static_cast<MapVerdict>(v));
  jobs::writeStudyOrigin(pieces.folder(), "stability",
                         std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count(),
                         {{"scene", "vehicle"}, {"quick", place.quick}, {"maps", names}, {"verdicts", counts}});
  writeTables(maps, points, pieces.folder());
  if (pieces.left() == 0) fs::remove_all(pieces.folder() / "kept");
  fmt::print("tables    {}\n", pieces.folder().string());
  if (const int wrong = pointsOf(points, "", MapVerdict::silentlyWrong) + pointsOf(points, "", MapVerdict::wrongCause);
      wrong > 0)
    throw base::SimulationError(
        fmt::format("{} points are silently wrong or stopped with a wrong cause (listed above)", wrong));
}

} // namespace grouser::studies
