// SPDX-License-Identifier: BSD-3-Clause
// Tables of `grouser study stability --scene vehicle`.
#include "runs/support/csv_cell.hpp"
#include "runs/validation/studies/trial_files.hpp"
#include "runs/validation/studies/vehicle_stability.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace grouser::studies {

namespace {

const char* wordOf(MapVerdict verdict) { return kVerdictWords[static_cast<std::size_t>(verdict)]; }

} // namespace

int pointsOf(const std::vector<JudgedPoint>& points, const std::string& map, MapVerdict verdict) {
  return static_cast<int>(std::count_if(points.begin(), points.end(), [&](const JudgedPoint& p) {
    return (map.empty() || p.map->name == map) && p.judgement.verdict == verdict;
  }));
}

std::string vehicleMapsCsv(const std::vector<JudgedPoint>& points) {
  std::string text = "map,x axis,x,y axis,y,step [s],verdict,cause,reached [s],reached at a quarter [s],wall [s]";
  for (const FigureColumn& c : kTrialFigures) text += fmt::format(",{0},{0} at a quarter", c.name);
  text += ",end at a quarter\n";
  for (const JudgedPoint& p : points) {
    text += fmt::format("{},{},{:.6g},{},{:.6g},{:.6g},{},{},{:.4g},{:.4g},{:.3g}", p.map->name,
                        support::csvCell(p.map->x.label), p.point->x, support::csvCell(p.map->y.label), p.point->y,
                        p.point->step, wordOf(p.judgement.verdict), support::csvCell(p.judgement.why), p.run().reached,
                        p.finer().reached, p.run().wallSeconds + p.finer().wallSeconds);
    for (const FigureColumn& c : kTrialFigures)
      text += fmt::format(",{},{}", support::csvCell(p.run().figures.*c.value),
                          support::csvCell(p.finer().figures.*c.value));
    text += fmt::format(",{}\n", support::csvCell(p.finer().cause));
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
      const int count = pointsOf(points, name, static_cast<MapVerdict>(v));
      all += count, counts += fmt::format(" {:>15}", count);
    }
    text += fmt::format("\n  {:<10} {:>7}{}", name.empty() ? "all" : name, all, counts);
  }
  text += "\n";
  for (const MapVerdict verdict : {MapVerdict::stopped, MapVerdict::refused, MapVerdict::scatters, MapVerdict::warned,
                                   MapVerdict::wrongCause, MapVerdict::silentlyWrong})
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
  std::string text =
      fmt::format("\n  {} beds with different seeds: mean and standard deviation at the step, mean and standard "
                  "deviation at a quarter of the step,\n  rms difference, allowed difference\n",
                  seeds.size());
  for (const ComparedFigure& figure : comparedFigures(true)) {
    std::array<double, 2> mean{}, squares{};
    double apart = 0;
    const double n = static_cast<double>(seeds.size());
    const auto pairOf = [&figure](const JudgedPoint& p) {
      return std::array<double, 2>{p.run().figures.*figure.value, p.finer().figures.*figure.value};
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

std::string neighboursTable(const std::vector<JudgedPoint>& points) {
  std::string text;
  for (const JudgedPoint& p : points)
    if (p.pairs.size() > 1)
      text += fmt::format(
          "\n  {}: {} at {} = {:.4g}, {} = {:.4g}: mean and standard deviation over {} neighbouring steps (down to "
          "{:.3g} times the step), mean and standard deviation over\n  quarters of these steps, difference of the "
          "means with Welch's 95 % interval, allowed difference\n{}",
          wordOf(p.judgement.verdict), p.map->name, p.map->x.label, p.point->x, p.map->y.label, p.point->y,
          p.pairs.size() - 1, kNeighbourShares.back(), scatterTable(p.pairs, p.map->onBed));
  return text;
}

std::string neighboursCsv(const std::vector<JudgedPoint>& points) {
  std::string text = "map,x axis,x,y axis,y,step [s],end,cause,wall [s]";
  for (const FigureColumn& c : kTrialFigures) text += fmt::format(",{}", c.name);
  text += "\n";
  for (const JudgedPoint& p : points)
    for (const TrialPair& pair : p.pairs) {
      if (p.pairs.size() < 2) continue;
      for (const VehicleTrial* t : {&pair.run, &pair.finer}) {
        text +=
            fmt::format("{},{},{:.6g},{},{:.6g},{:.6g},{},{},{:.3g}", p.map->name, support::csvCell(p.map->x.label),
                        p.point->x, support::csvCell(p.map->y.label), p.point->y, t->step,
                        t->end == TrialEnd::sound ? "sound" : "stopped", support::csvCell(t->cause), t->wallSeconds);
        for (const FigureColumn& c : kTrialFigures) text += fmt::format(",{}", support::csvCell(t->figures.*c.value));
        text += "\n";
      }
    }
  return text;
}

} // namespace grouser::studies
