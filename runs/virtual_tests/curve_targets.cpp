// SPDX-License-Identifier: BSD-3-Clause
#include "runs/virtual_tests/curve_targets.hpp"

#include "base/error.hpp"
#include "base/math.hpp"
#include "runs/jobs/estimate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace grouser::virtual_tests {

namespace {

constexpr double kWindow = 0.1;     // half width of the averaging window / sinkage
constexpr double kMinWindow = 1e-3; // [m] minimum half width of the averaging window
constexpr double kFarther = 1.15;   // final sinkage of a plate / sinkage of its last compared point

struct PlateKeys {
  std::string file;
  std::vector<double> sinkages;
  double bin = 0.3, depth = 0.12, contact = 0;
};

base::Table<PlateKeys> plateTable() {
  using T = PlateKeys;
  base::Table<T> t("plates", "Measured pressure-sinkage curves of circular plates");
  t.add("file", &T::file, "",
        "CSV file with the columns trial, plate_diameter_mm, sinkage_mm and pressure_kPa; the path is relative to the "
        "target file")
      .required();
  t.add("sinkages", &T::sinkages, "m", "sinkages at which the pressures are compared, in ascending order")
      .above(0)
      .atMost(10)
      .required();
  t.add("bin", &T::bin, "m", "side length of the square bed, between periodic boundaries").above(0).atMost(100);
  t.add("depth", &T::depth, "m", "depth of the bed").above(0).atMost(100);
  t.add("contact_pressure", &T::contact, "Pa",
        "pressure that defines the zero of the simulated sinkage: at this pressure, the simulated sinkage is set to "
        "the mean measured sinkage; 0: the sinkage is measured from the mean surface of the bed")
      .atLeast(0)
      .atMost(1e6);
  return t;
}

using Span = std::optional<std::array<double, 2>>;
struct SearchKeys {
  Span young, stiffness, friction, rolling, porosity, cohesion, depth;
  int trials = 16;
};

base::Table<SearchKeys> searchTable() {
  using T = SearchKeys;
  base::Table<T> t("search", "Parameters to fit, with their ranges");
  t.add("young", &T::young, "Pa", "Young's modulus of Hertz contacts").above(0).atMost(1e13);
  t.add("stiffness", &T::stiffness, "N/m", "stiffness of linear contacts").above(0).atMost(1e12);
  t.add("friction", &T::friction, "-", "Coulomb coefficient").atLeast(0).atMost(10);
  t.add("rolling_friction", &T::rolling, "-", "rolling friction").atLeast(0).atMost(2);
  t.add("porosity", &T::porosity, "-", "porosity of the bed").atLeast(0.2).atMost(0.7);
  t.add("cohesion", &T::cohesion, "J/m2", "energy of adhesion").atLeast(0).atMost(1e6);
  t.add("depth", &T::depth, "m", "depth of the bed, if the measurements do not state it").above(0).atMost(100);
  t.add("trials", &T::trials, "-", "maximum number of trials; 1: run only the initial values").atLeast(1).atMost(1000);
  return t;
}

void addRange(const base::Section& section, const SoilInBed& start, const std::string& key, const Span& span,
              std::vector<SearchRange>& ranges) {
  if (!span) return;
  const auto [low, high] = *span;
  if (!(low < high)) section.fail(key, "must be [min, max]");
  const double now = parameterOf(start, key);
  if (std::isnan(now))
    section.fail(key, "has no initial value; set it in [start], porosity in [bed] and depth in [plates]");
  if (now < low || now > high)
    section.fail(key, fmt::format("does not include the initial value {:g}; widen the range or change the value", now));
  ranges.push_back({key, low, high, key == "young" || key == "stiffness"});
}

double windowOf(double sinkage) { return std::max(kWindow * sinkage, kMinWindow); }

SinkageCurve curveOf(const jobs::Table& run) { return {run.values("sinkage [m]"), run.values("pressure [Pa]")}; }

/// Finished tests of one plate, ordered by seed.
std::vector<jobs::Table> runsOfPlate(const TestPlan& plan, const jobs::Pieces& pieces, double diameter) {
  std::vector<jobs::Table> runs;
  for (const PlannedTest& test : plan.tests)
    if (test.kind == TestKind::plate && test.diameter == diameter && pieces.has(test.name))
      runs.push_back(pieces.read(test.name));
  return runs;
}

} // namespace

MeasuredPlatesBed CurveTargets::bed(double depthOfBed) const {
  MeasuredPlatesBed all;
  all.bin = bin, all.depth = depthOfBed;
  for (const MeasuredPlate& plate : plates)
    all.diameters.push_back(plate.diameter), all.sinkages.push_back(kFarther * plate.deepest());
  return all;
}

CurveTargets readCurveTargets(const base::Section& root, const std::filesystem::path& file, const TestedSoil& start) {
  CurveTargets t;
  const base::Section plates = root.section("plates");
  const PlateKeys keys = plates.read(plateTable());
  if (keys.sinkages.empty()) plates.fail("sinkages", "is empty; set at least one sinkage, e.g. [0.005, 0.01]");
  if (!std::is_sorted(keys.sinkages.begin(), keys.sinkages.end(), std::less_equal<>()))
    plates.fail("sinkages", "is not ascending; sort it");
  t.bin = keys.bin, t.depth = keys.depth, t.contactPressure = keys.contact;
  t.plates = readMeasuredPlates(file.parent_path() / keys.file, keys.sinkages, keys.contact);
  for (const MeasuredPlate& plate : t.plates)
    if (const double first = plate.points.front().sinkage - windowOf(plate.points.front().sinkage);
        plate.contact >= first)
      plates.fail("contact_pressure",
                  fmt::format("is reached by the plate of {:g} mm at a sinkage of {:.2f} mm, but the first comparison "
                              "starts at {:g} mm; lower contact_pressure, or remove the first entry of sinkages",
                              1e3 * plate.diameter, 1e3 * plate.contact, 1e3 * first));
  const base::Section search = root.section("search");
  const SearchKeys sought = search.read(searchTable());
  const SoilInBed given{start, t.depth};
  const std::pair<const char*, const Span*> spans[] = {
      {"young", &sought.young},       {"stiffness", &sought.stiffness},
      {"friction", &sought.friction}, {"rolling_friction", &sought.rolling},
      {"porosity", &sought.porosity}, {"cohesion", &sought.cohesion},
      {"depth", &sought.depth}};
  for (const auto& [key, span] : spans) addRange(search, given, key, *span, t.ranges);
  if (t.ranges.empty()) search.fail("", "contains no parameters; set at least one, e.g. friction = [0.3, 1]");
  t.maxTrials = static_cast<std::size_t>(sought.trials);
  return t;
}

void setParameter(SoilInBed& bed, const std::string& key, double value) {
  if (key == "porosity")
    bed.soil.porosity = value;
  else if (key == "depth")
    bed.depth = value;
  else
    setNumber(bed.soil, key, value);
}

void setParameters(SoilInBed& bed, const CurveTargets& targets, const std::vector<double>& values) {
  for (std::size_t k = 0; k < values.size(); ++k) setParameter(bed, targets.ranges[k].key, values[k]);
  if (targets.bulkDensity && bed.soil.porosity)
    setNumber(bed.soil, "density", fourDigits(*targets.bulkDensity / (1 - *bed.soil.porosity)));
}

double parameterOf(const SoilInBed& bed, const std::string& key) {
  if (key == "porosity") return bed.soil.porosity.value_or(base::kNaN);
  if (key == "depth") return bed.depth;
  return numberOf(bed.soil, key, key == "cohesion" || key == "rolling_friction" ? 0.0 : base::kNaN);
}

double CurvePoint::deviations() const {
  return (simulated.value - measured.mean) / (measured.deviation * measured.mean);
}

std::string CurvePoint::name() const {
  return fmt::format("{:g} mm at {:g} mm", 1e3 * diameter, 1e3 * measured.sinkage);
}

SinkageCurve comparedCurve(const jobs::Table& run, const CurveTargets& targets, const MeasuredPlate& plate) {
  SinkageCurve curve = curveOf(run);
  if (targets.contactPressure <= 0) return curve;
  return fromContactPressure(curve, targets.contactPressure, plate.contact);
}

CurveComparison compareCurves(const TestPlan& plan, const jobs::Pieces& pieces, const CurveTargets& targets) {
  CurveComparison all;
  std::vector<double> porosities, zeros;
  for (const MeasuredPlate& plate : targets.plates) {
    std::vector<SinkageCurve> curves;
    for (const jobs::Table& run : runsOfPlate(plan, pieces, plate.diameter)) {
      curves.push_back(comparedCurve(run, targets, plate));
      porosities.push_back(run.values("porosity [-]").front());
      if (!curves.back().sinkage.empty()) zeros.push_back(curves.back().sinkage.back() - curveOf(run).sinkage.back());
    }
    if (curves.empty()) continue;
    for (const MeasuredPressure& measured : plate.points) {
      const double window = windowOf(measured.sinkage);
      std::vector<double> pressures;
      for (const SinkageCurve& curve : curves)
        pressures.push_back(curve.sinkage.empty()
                                ? 0
                                : meanPressureBetween(curve, measured.sinkage - window, measured.sinkage + window));
      all.points.push_back({plate.diameter, measured, jobs::interval95(pressures)});
    }
  }
  all.porosity = jobs::interval95(porosities).value, all.zeroOfSinkage = jobs::interval95(zeros).value;
  return all;
}

std::vector<double> curveResiduals(const std::vector<CurvePoint>& points, const std::optional<double>& repose,
                                   const CurveTargets& targets) {
  constexpr double kMin = 1; // [Pa] minimum pressure, which keeps the logarithm finite
  std::vector<double> residuals;
  for (const CurvePoint& p : points)
    residuals.push_back(base::log(std::max(kMin, p.simulated.value) / p.measured.mean) /
                        std::max(kMinScatter, p.measured.deviation));
  if (targets.repose) {
    constexpr double kNeverFlowed = 45; // [deg] assumed for a bed that never flows or never rests
    const double angle = repose && std::isfinite(*repose) ? *repose : kNeverFlowed;
    residuals.push_back((angle - *targets.repose) / targets.reposeTolerance);
  }
  return residuals;
}

std::string curvesText(const std::vector<CurvePoint>& points) {
  std::string text = fmt::format("  {:<18} {:>20} {:>16} {:>6} {:>12}\n", "plate and sinkage", "simulated [kPa]",
                                 "measured [kPa]", "tests", "deviations");
  for (const CurvePoint& p : points)
    text +=
        fmt::format("  {:<18} {:>20} {:>8.2f} +- {:<4.2f} {:>6} {:>12.1f}\n", p.name(),
                    jobs::valueText({1e-3 * p.simulated.value, 1e-3 * p.simulated.halfWidth}), 1e-3 * p.measured.mean,
                    1e-3 * p.measured.mean * p.measured.deviation, p.measured.trials.size(), p.deviations());
  return text;
}

std::string curvePointsCsv(const std::vector<CurvePoint>& points) {
  std::string text = "diameter [m],sinkage [m],trial,measured [Pa],measured mean [Pa],measured deviation [Pa],"
                     "simulated [Pa],half width [Pa],difference [deviations]\n";
  for (const CurvePoint& p : points)
    for (const MeasuredTrial& t : p.measured.trials)
      text += fmt::format("{:g},{:g},{},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.4g}\n", p.diameter, p.measured.sinkage,
                          t.number, t.pressure, p.measured.mean, p.measured.mean * p.measured.deviation,
                          p.simulated.value, p.simulated.halfWidth,
                          (p.simulated.value - t.pressure) / (p.measured.mean * p.measured.deviation));
  return text;
}

std::string curvesCsv(const TestPlan& plan, const jobs::Pieces& pieces, const CurveTargets& targets) {
  std::string text = "care,diameter [m],seed,sinkage [m],pressure [Pa],porosity [-]\n";
  for (const MeasuredPlate& plate : targets.plates)
    for (const PlannedTest& test : plan.tests) {
      if (test.kind != TestKind::plate || test.diameter != plate.diameter || !pieces.has(test.name)) continue;
      const jobs::Table run = pieces.read(test.name);
      const double porosity = run.values("porosity [-]").front();
      const SinkageCurve curve = comparedCurve(run, targets, plate);
      for (std::size_t i = 0; i < curve.sinkage.size(); ++i)
        text += fmt::format("{},{:g},{},{:.6g},{:.6g},{:.5g}\n", plan.care(), test.diameter, test.seed,
                            curve.sinkage[i], curve.pressure[i], porosity);
    }
  return text;
}

} // namespace grouser::virtual_tests
