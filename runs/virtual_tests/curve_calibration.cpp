// SPDX-License-Identifier: BSD-3-Clause
#include "runs/virtual_tests/curve_calibration.hpp"

#include "runs/jobs/estimate.hpp"
#include "runs/output/plots.hpp"
#include "runs/support/text_file.hpp"
#include "runs/virtual_tests/soil_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

namespace grouser::virtual_tests {

namespace {

constexpr int kMinTilted = 4; // minimum number of tilted beds: the angle of repose scatters more than pressures
constexpr double kWithin = 2; // tolerance of a pressure / standard deviation of a measured test

} // namespace

void CurveCalibration::run() {
  std::vector<double> start;
  for (const SearchRange& range : curves_.ranges) start.push_back(parameterOf(bed_, range.key));
  CurveSearch search(curves_.ranges, start, curves_.maxTrials);
  for (bool continues = true; continues;) {
    setParameters(bed_, curves_, search.at());
    const std::string name = fmt::format("curves_{}", search.trials().size() + 1);
    const Trial trial = tried(name);
    continues = search.tried(curveResiduals(trial.curves.points, reposeOf(trial), curves_));
    const double misfit = search.trials().back().misfit();
    record_.curves(name, bed_, trial.curves, trial.results.measured, misfit);
    printTrial(name, trial, misfit);
  }
  setParameters(bed_, curves_, search.trials()[search.nearest()].values);
  finish();
}

CurveCalibration::Trial CurveCalibration::tried(const std::string& name, const CalibrationTrials::WhenDone& whenDone) {
  PlanOptions options = command_.plan;
  options.coarse = command_.place.quick, options.wide = false;
  options.plates = curves_.bed(bed_.depth);
  options.reposeSeeds = curves_.repose ? std::max(kMinTilted, options.seeds) : 0;
  Trial trial;
  const auto isOurs = [](const PlannedTest& t) { return t.kind == TestKind::plate || t.kind == TestKind::repose; };
  trials_.tested(bed_.soil, name, options, isOurs, trial.results,
                 [&](const TestPlan& plan, const jobs::Pieces& pieces) {
                   trial.curves = compareCurves(plan, pieces, curves_);
                   if (whenDone) whenDone(plan, pieces);
                 });
  return trial;
}

std::optional<double> CurveCalibration::reposeOf(const Trial& trial) const {
  const auto found = trial.results.measured.find(Quantity::repose);
  return found == trial.results.measured.end() ? std::nullopt : std::optional(found->second.value);
}

void CurveCalibration::printTrial(const std::string& name, const Trial& trial, double misfit) const {
  std::string text = fmt::format("          {}:", name);
  for (const SearchRange& range : curves_.ranges)
    text += fmt::format(" {} {:.4g},", range.key, parameterOf(bed_, range.key));
  text += fmt::format(" bed porosity {:.4f}", trial.curves.porosity);
  if (trial.curves.zeroOfSinkage != 0)
    text += fmt::format(", zero sinkage at {:.2f} mm above the mean surface", 1e3 * trial.curves.zeroOfSinkage);
  if (const auto found = trial.results.measured.find(Quantity::repose); found != trial.results.measured.end())
    text += fmt::format(", repose {} deg", jobs::valueText(found->second));
  fmt::print("{}; misfit {:.2f}\n{}", text, misfit, curvesText(trial.curves.points));
  std::fflush(stdout);
}

std::vector<TargetOutcome> CurveCalibration::outcomes(const Trial& trial) const {
  std::vector<TargetOutcome> all;
  for (const CurvePoint& p : trial.curves.points)
    all.push_back({"plate of " + p.name(),
                   "kPa",
                   1e-3 * p.measured.mean,
                   1e-3 * kWithin * p.measured.mean * p.measured.deviation,
                   {1e-3 * p.simulated.value, 1e-3 * p.simulated.halfWidth}});
  if (const auto found = trial.results.measured.find(Quantity::repose); found != trial.results.measured.end())
    all.push_back({"repose", "deg", *curves_.repose, kWithin * curves_.reposeTolerance, found->second});
  return all;
}

void CurveCalibration::finish() {
  std::filesystem::path tables;
  const Trial trial = tried("final", [&](const TestPlan& plan, const jobs::Pieces& pieces) {
    tables = pieces.folder();
    reportSoil(plan, pieces, 0);
    support::writeTextFile(tables / "curves.csv", curvesCsv(plan, pieces, curves_), "--out");
  });
  const std::vector<TargetOutcome> found = outcomes(trial);
  const std::string text = outcomesText(found, command_.place.quick);
  fmt::print("{}", text);
  support::writeTextFile(folder_ / "calibration.txt", curvesText(trial.curves.points) + text, "--out");
  support::writeTextFile(tables / "points.csv", curvePointsCsv(trial.curves.points), "--out");
  output::drawPicture("plate_curves.py", {tables / "curves.csv", tables / "points.csv"}, folder_ / "curves.png");
  const std::string call =
      fmt::format("grouser soil --calibrate {}{} --seeds {} --pressure {:g}", bed_.soil.file.filename().string(),
                  command_.place.quick ? " --quick" : "", command_.plan.seeds, command_.plan.maxPressure);
  const std::string file = bed_.soil.name + ".toml";
  support::replaceTextFile(
      folder_ / file, soilFileText(bed_.soil, fmt::format("Calibrated by `{}` on beds {:g} m deep.", call, bed_.depth),
                                   trial.results, call));
  record_.ended(found, file, "final");
  fmt::print("soil      {}\n", (folder_ / file).string());
}

} // namespace grouser::virtual_tests
