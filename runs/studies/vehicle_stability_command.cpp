// SPDX-License-Identifier: BSD-3-Clause
// `grouser study stability --scene vehicle`: pieces, tables and files of the maps.
#include "runs/studies/vehicle_stability.hpp"

#include "base/error.hpp"
#include "runs/output/plots.hpp"
#include "runs/studies/trial_files.hpp"
#include "runs/support/csv_cell.hpp"
#include "runs/support/device_choice.hpp"
#include "runs/support/progress.hpp"
#include "runs/support/stop_signals.hpp"
#include "runs/support/text_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <stdexcept>

namespace grouser::studies {

namespace fs = std::filesystem;

namespace {

constexpr double kFiner = 4; // the run that judges has so many times as many steps

std::string nameOf(const VehicleMap& map, std::size_t point) { return fmt::format("{}_{}", map.name, point); }

/// What the runs depend on, beside the program.
nlohmann::ordered_json recipeOf(const std::vector<VehicleMap>& maps, bool quick) {
  nlohmann::ordered_json recipe = {{"study", "stability"}, {"scene", "vehicle"}, {"quick", quick}};
  for (const VehicleMap& map : maps) {
    nlohmann::ordered_json& points = recipe["points"][map.name];
    for (const MapPoint& p : map.points) points.push_back(fmt::format("{:.6g} {:.6g} at {:.6g} s", p.x, p.y, p.step));
  }
  return recipe;
}

void runAll(const std::vector<VehicleMap>& maps, Pieces& pieces, const PieceOptions& options) {
  simulation::BedCache beds(pieces.folder() / "kept");
  simulation::SphereCache spheres{support::KeptFiles(pieces.folder() / "kept")};
  const base::Exec exec = support::chooseDevice(support::deviceChoice(options.device), options.threads, nullptr);
  support::Progress progress("driving");
  double all = 0, done = 0;
  for (const VehicleMap& map : maps) all += static_cast<double>(map.points.size());
  for (const VehicleMap& map : maps)
    for (std::size_t i = 0; i < map.points.size(); ++i) {
      const MapPoint& p = map.points[i];
      const std::string name = nameOf(map, i);
      progress.update(done++ / all, name);
      if (!pieces.due(name)) continue;
      const fs::path folder = pieces.begin(name);
      const TrialPlace place{folder, &beds, &spheres, exec};
      std::vector<VehicleTrial> trials{tryVehicle(p.what, p.step, place)};
      if (trials[0].end != TrialEnd::refused) trials.push_back(tryVehicle(p.what, p.step / kFiner, place));
      keepTrials(pieces, name, trials);
      fs::remove_all(folder);
    }
  progress.finish(fmt::format("{} of {} points are there", all - pieces.left(), all));
}

std::vector<JudgedPoint> judged(const std::vector<VehicleMap>& maps, const Pieces& pieces) {
  std::vector<JudgedPoint> points;
  for (const VehicleMap& map : maps)
    for (std::size_t i = 0; i < map.points.size(); ++i) {
      const std::string name = nameOf(map, i);
      if (!pieces.has(name)) continue;
      const std::vector<VehicleTrial> trials = readTrials(pieces, name);
      JudgedPoint p{&map, &map.points[i], trials.at(0), trials.size() > 1 ? trials[1] : VehicleTrial{}, {}};
      p.judgement = judge(p.run, p.finer, map.onBed);
      points.push_back(p);
    }
  return points;
}

int countOf(const std::vector<JudgedPoint>& points, const std::string& map, MapVerdict verdict) {
  return static_cast<int>(std::count_if(points.begin(), points.end(), [&](const JudgedPoint& p) {
    return (map.empty() || p.map->name == map) && p.judgement.verdict == verdict;
  }));
}

const char* wordOf(MapVerdict verdict) { return kVerdictWords[static_cast<std::size_t>(verdict)]; }

void writeTables(const std::vector<VehicleMap>& maps, const std::vector<JudgedPoint>& points, const fs::path& folder) {
  support::writeTextFile(folder / "vehicle.csv", vehicleMapsCsv(points), "--out");
  support::writeTextFile(folder / "vehicle_limits.csv", predictedLinesCsv(maps), "--out");
  output::drawPicture("study_vehicle_stability.py", {folder / "vehicle.csv", folder / "vehicle_limits.csv"},
                      folder / "vehicle.png");
}

} // namespace

std::string vehicleMapsCsv(const std::vector<JudgedPoint>& points) {
  std::string text = "map,x axis,x,y axis,y,step [s],verdict,cause,reached [s],reached at a quarter [s],wall [s]";
  for (const FigureColumn& c : kTrialFigures) text += fmt::format(",{0},{0} at a quarter", c.name);
  text += ",end at a quarter\n";
  for (const JudgedPoint& p : points) {
    text += fmt::format("{},{},{:.6g},{},{:.6g},{:.6g},{},{},{:.4g},{:.4g},{:.3g}", p.map->name,
                        support::csvCell(p.map->x.label), p.point->x, support::csvCell(p.map->y.label), p.point->y,
                        p.point->step, wordOf(p.judgement.verdict), support::csvCell(p.judgement.why), p.run.reached,
                        p.finer.reached, p.run.wallSeconds + p.finer.wallSeconds);
    for (const FigureColumn& c : kTrialFigures)
      text +=
          fmt::format(",{},{}", support::csvCell(p.run.figures.*c.value), support::csvCell(p.finer.figures.*c.value));
    text += fmt::format(",{}\n", support::csvCell(p.finer.cause));
  }
  return text;
}

std::string predictedLinesCsv(const std::vector<VehicleMap>& maps) {
  std::string text = "map,title,logarithmic x,logarithmic y,line,x,y\n";
  for (const VehicleMap& map : maps)
    for (const PredictedLine& line : map.lines)
      for (std::size_t i = 0; i < line.x.size(); ++i)
        text += fmt::format("{},{},{},{},{},{:.6g},{:.6g}\n", map.name, support::csvCell(map.title),
                            map.x.logarithmic ? 1 : 0, map.y.logarithmic ? 1 : 0, support::csvCell(line.label),
                            line.x[i], line.y[i]);
  return text;
}

std::string vehicleMapsTable(const std::vector<JudgedPoint>& points) {
  std::string text = fmt::format("\n  {:<10} {:>7}", "map", "points");
  for (const char* word : kVerdictWords) text += fmt::format(" {:>15}", word);
  std::vector<std::string> names;
  for (const JudgedPoint& p : points)
    if (names.empty() || names.back() != p.map->name) names.push_back(p.map->name);
  names.emplace_back();
  for (const std::string& name : names) {
    int all = 0;
    std::string counts;
    for (std::size_t v = 0; v < kVerdictWords.size(); ++v) {
      const int count = countOf(points, name, static_cast<MapVerdict>(v));
      all += count, counts += fmt::format(" {:>15}", count);
    }
    text += fmt::format("\n  {:<10} {:>7}{}", name.empty() ? "all" : name, all, counts);
  }
  text += "\n";
  for (const MapVerdict verdict :
       {MapVerdict::stopped, MapVerdict::refused, MapVerdict::wrongCause, MapVerdict::silentlyWrong})
    for (const JudgedPoint& p : points)
      if (p.judgement.verdict == verdict)
        text += fmt::format("{}: {} at {} = {:.4g}, {} = {:.4g}: {}\n", wordOf(verdict), p.map->name, p.map->x.label,
                            p.point->x, p.map->y.label, p.point->y, p.judgement.why);
  return text;
}

std::string seedScatterTable(const std::vector<JudgedPoint>& points) {
  std::vector<const JudgedPoint*> seeds;
  for (const JudgedPoint& p : points)
    if (p.map->name == "seeds" && p.judgement.verdict == MapVerdict::sound) seeds.push_back(&p);
  if (seeds.size() < 2) return {};
  std::string text = fmt::format("\n  {} beds from other seeds: mean and standard deviation at the step, the same at a "
                                 "quarter, root mean square difference\n  of the two, and what they may differ by\n",
                                 seeds.size());
  for (const ComparedFigure& figure : comparedFigures(true)) {
    std::array<double, 2> mean{}, squares{};
    double apart = 0;
    const double n = static_cast<double>(seeds.size());
    const auto pairOf = [&figure](const JudgedPoint& p) {
      return std::array<double, 2>{p.run.figures.*figure.value, p.finer.figures.*figure.value};
    };
    for (const JudgedPoint* p : seeds) {
      const std::array<double, 2> values = pairOf(*p);
      for (std::size_t k = 0; k < 2; ++k) mean[k] += values[k] / n;
      apart += (values[0] - values[1]) * (values[0] - values[1]) / n;
    }
    for (const JudgedPoint* p : seeds)
      for (std::size_t k = 0; k < 2; ++k) squares[k] += (pairOf(*p)[k] - mean[k]) * (pairOf(*p)[k] - mean[k]);
    const double may = figure.relative * std::max(std::fabs(mean[0]), std::fabs(mean[1])) + figure.floor;
    text += fmt::format("  {:<18} {:>9.4g} +- {:<9.3g} {:>9.4g} +- {:<9.3g} {:>9.3g} {:>9.3g} {}\n", figure.name,
                        mean[0], std::sqrt(squares[0] / (n - 1)), mean[1], std::sqrt(squares[1] / (n - 1)),
                        std::sqrt(apart), may, figure.unit);
  }
  return text;
}

void studyVehicleStability(const VehicleStability& command, const StudyPlace& place) {
  const auto begin = std::chrono::steady_clock::now();
  const std::vector<std::string> names = command.maps.empty() ? vehicleMapNames() : command.maps;
  const fs::path scratch = fs::temp_directory_path() / fmt::format("grouser_maps_{}", begin.time_since_epoch().count());
  std::vector<VehicleMap> maps;
  for (const std::string& name : names) maps.push_back(vehicleMap(name, place.quick, scratch));
  fs::remove_all(scratch);
  Pieces pieces("stability_vehicle", place, command.pieces, recipeOf(maps, place.quick));
  const support::StopSignals signals;
  fmt::print("          the shipped vehicle, each point at its step and at a quarter of it\n");
  runAll(maps, pieces, command.pieces);
  if (!pieces.whole()) return;
  const std::vector<JudgedPoint> points = judged(maps, pieces);
  if (points.empty()) {
    fmt::print("no point is there yet: call again with --resume\n");
    return;
  }
  fmt::print("{}{}", vehicleMapsTable(points), seedScatterTable(points));
  if (pieces.left() > 0) fmt::print("{} points are missing: call again with --resume\n", pieces.left());
  nlohmann::ordered_json counts;
  for (std::size_t v = 0; v < kVerdictWords.size(); ++v)
    counts[kVerdictWords[v]] = countOf(points, "", static_cast<MapVerdict>(v));
  writeStudyOrigin(pieces.folder(), "stability",
                   std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count(),
                   {{"scene", "vehicle"}, {"quick", place.quick}, {"maps", names}, {"verdicts", counts}});
  writeTables(maps, points, pieces.folder());
  if (pieces.left() == 0) fs::remove_all(pieces.folder() / "kept");
  fmt::print("tables    {}\n", pieces.folder().string());
  if (const int wrong = countOf(points, "", MapVerdict::silentlyWrong) + countOf(points, "", MapVerdict::wrongCause);
      wrong > 0)
    throw std::runtime_error(
        fmt::format("{} points are silently wrong, or stopped for a wrong cause: see above", wrong));
}

} // namespace grouser::studies
