// SPDX-License-Identifier: BSD-3-Clause
// `grouser soil --calibrate`: fits the shear strength, then the pressure at the target sinkage, and measures all
// constants; or fits measured pressure-sinkage curves (curve_calibration.cpp).
#include "base/counted.hpp"
#include "base/error.hpp"
#include "base/math.hpp"
#include "runs/jobs/estimate.hpp"
#include "runs/output/output.hpp"
#include "runs/support/build_info.hpp"
#include "runs/support/stop_signals.hpp"
#include "runs/support/text_file.hpp"
#include "runs/virtual_tests/calibration_record.hpp"
#include "runs/virtual_tests/constant_doubts.hpp"
#include "runs/virtual_tests/curve_calibration.hpp"
#include "runs/virtual_tests/soil_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

namespace grouser::virtual_tests {

namespace {

using support::Estimate;

constexpr double kAngleSlope = 12;      // initial estimate of the slope of phi [deg] over the strength path
constexpr double kStiffnessSlope = 0.5; // initial estimate of the slope of ln pressure over ln stiffness
constexpr double kStiffer = 100;        // maximum stiffness / initial stiffness
constexpr double kDeepest = 0.05;       // [d] maximum overlap at the greatest pressure
constexpr double kBeds = 0.75;          // tensile strength / (w / r), with adhesion at all contacts (Rumpf 1962)

class Calibration {
public:
  Calibration(const CalibrationCommand& command, CalibrationTargets targets, std::filesystem::path folder)
      : command_(command), targets_(std::move(targets)), folder_(std::move(folder)), soil_(targets_.start),
        record_(command, targets_, folder_), trials_(command, folder_, record_) {}

  void run() {
    try {
      if (targets_.curves)
        CurveCalibration(command_, targets_, folder_, record_).run();
      else
        search();
    } catch (const Unfinished& unfinished) {
      record_.stopped(unfinished.trial, unfinished.missing);
      fmt::print("{} missing; repeat the command with --resume\n",
                 base::counted(unfinished.missing, "test of this trial is", "tests of this trial are"));
    }
  }

private:
  void search() {
    seekStrength();
    // The stiffness slightly changes phi and c, so check both again. If they are still within tolerance, this costs
    // nothing, because the final tests reuse these shear tests.
    if (seekStiffness()) seekStrength();
    finish();
  }

  /// Performs the wanted tests of the present soil in the folder `name`.
  TestPlan tested(const std::string& name, const CalibrationTrials::Wanted& wanted, SoilResults& results,
                  const CalibrationTrials::WhenDone& whenDone = {}) {
    PlanOptions options = command_.plan;
    options.coarse = command_.place.quick, options.wide = false;
    return trials_.tested(soil_, name, options, wanted, results, whenDone);
  }

  /// Simultaneously fits friction and rolling friction to phi, and the adhesion to c.
  void seekStrength() {
    const auto phi = targets_.wanted.find(Quantity::frictionAngle), c = targets_.wanted.find(Quantity::cohesion);
    const bool seeksPhi = phi != targets_.wanted.end(), seeksC = c != targets_.wanted.end();
    if (!seeksPhi && !seeksC) return;
    const double mu = soil_.friction;
    const StrengthPoint start{wayOf(numberOf(soil_, "rolling_friction", 0)), numberOf(soil_, pullKey(), 0)};
    std::optional<StrengthSearch::Target> angle, cohesion;
    if (seeksPhi) angle = {phi->second, targets_.angleTolerance, kAngleSlope};
    // Expected slope of the cohesion c [kPa] over the adhesion energy [J/m2].
    const double slope = 1e-3 * kBeds / soil_.grainRadius * base::tan((seeksPhi ? phi->second : 30) * base::kPi / 180);
    if (seeksC) cohesion = {c->second, targets_.cohesionTolerance, slope};
    StrengthSearch search(angle, cohesion, start);
    bool continues = true;
    while (continues) {
      setStrength(search.at(), mu);
      SoilResults r;
      const std::string name = fmt::format("shear_{}", ++shearTrials_);
      tested(
          name, [](const PlannedTest& t) { return t.kind == TestKind::shear; }, r);
      record_.shear(name, soil_, r.measured);
      const Estimate foundAngle = r.measured.at(Quantity::frictionAngle),
                     foundCohesion = r.measured.at(Quantity::cohesion);
      fmt::print("          friction {:.4g}, rolling friction {:.4g}, {} {:.4g}: phi {} deg, c {} kPa; K {} mm\n",
                 soil_.friction, numberOf(soil_, "rolling_friction", 0), pullKey(), search.at().pull,
                 jobs::valueText(foundAngle), jobs::valueText(foundCohesion),
                 jobs::valueText(r.measured.at(Quantity::shearModulus)));
      continues = search.tried(foundAngle.value, foundCohesion.value);
    }
    setStrength(search.nearest(), mu);
  }

  void setStrength(const StrengthPoint& point, double mu) {
    const Strength s = strengthAt(point.way, mu);
    setNumber(soil_, "friction", s.friction), setNumber(soil_, "rolling_friction", s.rollingFriction);
    if (point.pull > 0 || numberOf(soil_, pullKey(), -1) >= 0) setNumber(soil_, pullKey(), point.pull);
  }

  /// Key of the adhesion: cohesion, or surface_energy if [start] sets only surface_energy.
  std::string pullKey() const {
    const bool isAlone = numberOf(soil_, "surface_energy", -1) >= 0 && numberOf(soil_, "cohesion", -1) < 0;
    return isAlone ? "surface_energy" : "cohesion";
  }
  std::string springKey() const { return soil_.young > 0 ? "young" : "stiffness"; }

  /// Minimum stiffness [N/m] or Young's modulus [Pa] that satisfies the overlap limit.
  double softest() const {
    const double d = 2 * soil_.grainRadius, p = command_.plan.maxPressure;
    if (soil_.young == 0) return p * d / kDeepest;
    // F = p d^2 = 4/3 E* sqrt(d / 4) overlap^(3/2), E* = E / 2 / (1 - nu^2).
    const double overlap = kDeepest * d;
    return 2 * (1 - soil_.poisson * soil_.poisson) * 0.75 * p * d * d / (std::sqrt(0.25 * d * overlap) * overlap);
  }

  /// Fits the stiffness to the pressure of the small plate at the target sinkage. Returns true if it changed.
  bool seekStiffness() {
    if (!targets_.requestsSinkage()) return false;
    const double start = numberOf(soil_, springKey(), 0), least = std::min(start, softest());
    double stiffness = start;
    std::vector<Trial> trials;
    std::map<double, double> stiffnesses; // by x of the trials
    const double wanted = base::log(kTrackPressure);
    for (int trial = 1;; ++trial) {
      SoilResults r;
      Estimate pressure;
      const std::string name = fmt::format("plate_{}", trial);
      const TestPlan done = tested(
          name, [](const PlannedTest& t) { return t.kind == TestKind::small; }, r,
          [&](const TestPlan& plan, const jobs::Pieces& pieces) {
            pressure = pressureThere(plan, pieces, TestKind::small);
          });
      record_.plate(name, soil_, pressure, sinkageOf(done, TestKind::small));
      trials.push_back({base::log(stiffness), base::log(pressure.value)});
      stiffnesses[trials.back().x] = stiffness;
      fmt::print("          {} {:.4g}: pressure {} kPa, target {:g} kPa\n", springKey(), stiffness,
                 jobs::valueText({1e-3 * pressure.value, 1e-3 * pressure.halfWidth}), 1e-3 * kTrackPressure);
      const std::optional<double> next = nextTrial(trials, wanted, std::log1p(targets_.stiffnessTolerance),
                                                   base::log(least), base::log(kStiffer * start), kStiffnessSlope);
      if (!next) break;
      stiffness = fourDigits(base::exp(*next));
      const auto isIt = [&](const auto& tried) { return tried.second == stiffness; };
      if (std::any_of(stiffnesses.begin(), stiffnesses.end(), isIt)) break;
      setNumber(soil_, springKey(), stiffness);
    }
    const double found = stiffnesses.at(nearestTrial(trials, wanted).x);
    if (trials.size() > 1) setNumber(soil_, springKey(), found);
    return found != start;
  }

  /// Target sinkage of a plate at the track's pressure [m].
  double sinkageOf(const TestPlan& plan, TestKind kind) const {
    return targets_.sinkageAt(targets_.breadth.value_or(plan.breadth(kind)));
  }

  /// Mean pressure of a plate at the target sinkage [Pa], or the final pressure if the curve ends before that sinkage.
  Estimate pressureThere(const TestPlan& plan, const jobs::Pieces& pieces, TestKind kind) const {
    const double z = sinkageOf(plan, kind);
    const double window = std::max(0.05 * z, 2e-3 * plan.breadth(kind));
    std::vector<double> pressures;
    for (const jobs::Table& run : runsOf(plan, pieces, kind)) {
      const SinkageCurve curve = beddedCurve(plan, run).curve;
      const double at = std::min(z, curve.sinkage.back() - window);
      double sum = 0, count = 0;
      for (std::size_t i = 0; i < curve.sinkage.size(); ++i)
        if (std::fabs(curve.sinkage[i] - at) <= window) sum += curve.pressure[i], ++count;
      pressures.push_back(std::max(1.0, sum / std::max(1.0, count)));
    }
    return jobs::interval95(pressures);
  }

  std::vector<TargetOutcome> outcomes(const SoilResults& r, const Estimate& small, const Estimate& large) const {
    std::vector<TargetOutcome> all;
    for (const auto& [q, wanted] : targets_.wanted) {
      const auto found = r.measured.find(q);
      if (found == r.measured.end()) continue;
      std::optional<double> tolerance;
      if (q == Quantity::cohesion) tolerance = targets_.cohesionTolerance;
      if (q == Quantity::frictionAngle) tolerance = targets_.angleTolerance;
      all.push_back({symbolOf(q), unitOf(q), wanted, tolerance, found->second});
    }
    if (!targets_.requestsSinkage()) return all;
    const double p = 1e-3 * kTrackPressure, within = targets_.stiffnessTolerance * p;
    all.push_back({"pressure, small plate", "kPa", p, within, {1e-3 * small.value, 1e-3 * small.halfWidth}});
    all.push_back({"validation, large plate", "kPa", p, within, {1e-3 * large.value, 1e-3 * large.halfWidth}});
    return all;
  }

  void finish() {
    SoilResults r;
    Estimate small, large;
    const TestPlan plan = tested(
        "final", [](const PlannedTest&) { return true; }, r,
        [&](const TestPlan& all, const jobs::Pieces& pieces) {
          reportSoil(all, pieces, 0);
          if (!targets_.requestsSinkage()) return;
          small = pressureThere(all, pieces, TestKind::small), large = pressureThere(all, pieces, TestKind::large);
        });
    const std::vector<TargetOutcome> found = outcomes(r, small, large);
    const std::string text = outcomesText(found, command_.place.quick);
    fmt::print("{}", text);
    const std::string call = fmt::format("grouser soil --calibrate {}{}", targets_.start.file.filename().string(),
                                         command_.place.quick ? " --quick" : "");
    support::writeTextFile(folder_ / "calibration.txt", text, "--out");
    const std::string file = soil_.name + ".toml";
    support::replaceTextFile(
        folder_ / file,
        soilFileText(soil_, fmt::format("Calibrated by `{}` ({} settings).", call, plan.care()), r, call));
    record_.ended(found, file, "final");
    fmt::print("soil      {}\n", (folder_ / file).string());
  }

  const CalibrationCommand& command_;
  CalibrationTargets targets_;
  std::filesystem::path folder_;
  TestedSoil soil_;
  CalibrationRecord record_;
  CalibrationTrials trials_;
  int shearTrials_ = 0;
};

/// Removes the trials of an earlier call.
void removeTrials(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> trials;
  if (std::filesystem::is_directory(folder))
    for (const auto& entry : std::filesystem::directory_iterator(folder))
      if (std::filesystem::exists(entry.path() / "recipe.json")) trials.push_back(entry.path());
  for (const std::filesystem::path& trial : trials) std::filesystem::remove_all(trial);
}

} // namespace

std::string soilFileText(const TestedSoil& soil, const std::string& description, const SoilResults& reached,
                         const std::string& command) {
  const bool isMeasured = doubtsOf(reached).size() < reached.measured.size();
  std::string text = fmt::format("version = 1\n\n[soil]\ntitle = {}\ndescription = {}\ncalibrated = {}\n\n[material]\n",
                                 base::toToml(soil.name), base::toToml(description), isMeasured);
  for (const auto& [key, value] : soil.keys) text += key + " = " + value + "\n";
  text += fmt::format("\n[bed]\ngrain_radius = {}\nradius_spread = {}\n", base::toToml(soil.grainRadius),
                      base::toToml(soil.spread));
  if (soil.porosity) text += "porosity = " + base::toToml(*soil.porosity) + "\n";
  text += fmt::format("calibrated_radii = [{0}, {0}]\n", base::toToml(soil.grainRadius));
  for (const auto& [q, e] : reached.measured) {
    if (const std::string doubt = doubtOf(q, e); !doubt.empty()) {
      text += fmt::format("\n# {} = {} {} is omitted because it is inconclusive: {}\n", symbolOf(q), jobs::valueText(e),
                          unitOf(q), doubt);
      continue;
    }
    text +=
        fmt::format("\n[[reached]]\nquantity = \"{}\"\nvalue = {}\nhalf_width = {}\nunit = \"{}\"\n", symbolOf(q),
                    base::toToml(inSoilFile(q, e.value)), base::toToml(inSoilFile(q, e.halfWidth)), soilFileUnitOf(q));
    text += fmt::format("grain_radius = {}\ncommand = {}\n", base::toToml(soil.grainRadius), base::toToml(command));
  }
  return text;
}

void calibrateCommand(const CalibrationCommand& command) {
  if (!command.pieces.part.empty())
    throw base::InputError(
        "--part: incompatible with --calibrate, because each trial depends on the previous ones; use --jobs instead");
  CalibrationTargets targets = readTargets(command.targets, command.grainRadius);
  const std::filesystem::path folder = command.place.folder.empty()
                                           ? std::filesystem::path("out") / ("calibrate_" + targets.start.name)
                                           : std::filesystem::path(command.place.folder);
  const bool continues =
      command.pieces.resume || (!command.place.force && CalibrationRecord(command, targets, folder).isOfThisCall());
  output::checkOutputFolder(folder, command.place.force || continues);
  if (!continues) removeTrials(folder);
  const support::StopSignals signals;
  Calibration(command, std::move(targets), folder).run();
}

} // namespace grouser::virtual_tests
