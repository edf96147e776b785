// SPDX-License-Identifier: BSD-3-Clause
// Targets, and searches for one and two parameters.
#include "runs/virtual_tests/calibration.hpp"

#include "base/error.hpp"
#include "base/math.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace grouser::virtual_tests {

namespace {

constexpr double kMinWay = -1, kMaxWay = 2;                                // range of the path of Strength
constexpr double kMaxRolling = 0.5, kMaxFriction = 1, kMinFriction = 0.01; // [-] ranges of Strength
constexpr double kMiddle = 0.1; // minimum distance of a trial from both ends of its interval / interval width
constexpr double kSame = 0.1;   // minimum change of a parameter / change that shifts the result by the tolerance
constexpr double kSlopes = 5;   // measured slopes are limited to 1/5 to 5 times the expected slope
constexpr std::size_t kMaxTrials = 8;

struct TargetKeys {
  std::optional<double> n, kc, kphi, k, b, c, phi, shearModulus, repose, bulkDensity;
};

struct ToleranceKeys {
  double phi = 1, c = 0.5, k = 0.1, repose = 1;
};

base::Table<TargetKeys> targetTable() {
  using T = TargetKeys;
  base::Table<T> t("targets", "Target constants of the soil");
  t.add("n", &T::n, "-", "sinkage exponent").above(0).atMost(5);
  t.add("k_c", &T::kc, "kN/m^(n+1)", "cohesive modulus; may be negative");
  t.add("k_phi", &T::kphi, "kN/m^(n+2)", "frictional modulus");
  t.add("k", &T::k, "kN/m^(n+2)", "k_c / b + k_phi for plate width b; replaces k_c and k_phi").above(0);
  t.add("b", &T::b, "m", "plate width for which k is given").above(0).atMost(100);
  t.add("c", &T::c, "kPa", "cohesion").atLeast(0).atMost(1000);
  t.add("phi", &T::phi, "deg", "angle of internal friction").above(0).atMost(60);
  t.add("K", &T::shearModulus, "mm", "shear deformation modulus; reported but not fitted").above(0);
  t.add("repose", &T::repose, "deg", "angle of repose; requires [plates]").above(0).atMost(60);
  t.add("bulk_density", &T::bulkDensity, "kg/m3", "bulk density, which determines the solid density; requires [plates]")
      .above(0)
      .atMost(1e5);
  return t;
}

base::Table<ToleranceKeys> toleranceTable() {
  using T = ToleranceKeys;
  base::Table<T> t("tolerances", "Tolerances of the targets");
  t.add("phi", &T::phi, "deg", "tolerance of phi").above(0);
  t.add("c", &T::c, "kPa", "tolerance of c").above(0);
  t.add("k", &T::k, "-", "relative tolerance of the pressure at the target sinkage").above(0).atMost(1);
  t.add("repose", &T::repose, "deg", "standard deviation of the angle of repose").above(0);
  return t;
}

/// Measured curves and soil constants are mutually exclusive targets.
void checkBesidePlates(const base::Section& section, const TargetKeys& k, bool hasPlates) {
  const std::pair<const char*, const std::optional<double>*> constants[] = {
      {"n", &k.n}, {"k_c", &k.kc},  {"k_phi", &k.kphi},    {"k", &k.k},
      {"c", &k.c}, {"phi", &k.phi}, {"K", &k.shearModulus}};
  for (const auto& [key, value] : constants)
    if (hasPlates && *value)
      section.fail(key, "is mutually exclusive with [plates]; remove it, or [plates] and [search]");
  if (!hasPlates && k.repose) section.fail("repose", "requires [plates]; add this section, or remove the key");
  if (!hasPlates && k.bulkDensity)
    section.fail("bulk_density", "requires [plates]; add this section, or set density in [start]");
}

void checkTogether(const base::Section& section, const TargetKeys& k) {
  if (k.k.has_value() != k.b.has_value())
    section.fail(k.k ? "k" : "b", k.k ? "requires b; add it" : "requires k; add it");
  if (k.kc.has_value() != k.kphi.has_value())
    section.fail(k.kc ? "k_c" : "k_phi", k.kc ? "requires k_phi; add it, or use k and b instead"
                                              : "requires k_c; add it, or use k and b instead");
  if (k.k && k.kphi) section.fail("k", "is mutually exclusive with k_c and k_phi; remove k and b, or k_c and k_phi");
  if ((k.k || k.kphi) && !k.n) section.fail("n", "is missing, but the units of k, k_c and k_phi depend on it; add it");
  if (!k.phi && !k.c && !k.k && !k.kphi) section.fail("", "contains no targets; set phi, c, k_c and k_phi, or k and b");
}

} // namespace

bool CalibrationTargets::requestsSinkage() const { return k || wanted.contains(Quantity::frictionModulus); }

double CalibrationTargets::kAt(double b) const {
  return k ? *k : wanted.at(Quantity::cohesionModulus) / b + wanted.at(Quantity::frictionModulus);
}

double CalibrationTargets::sinkageAt(double b) const {
  return base::pow(1e-3 * kTrackPressure / kAt(b), 1 / wanted.at(Quantity::exponent));
}

namespace {

CalibrationTargets withCurves(const base::Section& root, const std::filesystem::path& file, double grainRadius,
                              const TargetKeys& keys, const ToleranceKeys& within) {
  CalibrationTargets t;
  t.start = readMaterial(root, "start", file, grainRadius);
  t.curves = readCurveTargets(root, file, t.start);
  t.curves->repose = keys.repose, t.curves->reposeTolerance = within.repose;
  t.curves->bulkDensity = keys.bulkDensity;
  if (keys.bulkDensity && !t.start.porosity)
    root.section("targets").fail("bulk_density", "requires bed.porosity to compute the solid density; add it");
  return t;
}

} // namespace

CalibrationTargets readTargets(const std::filesystem::path& file, double grainRadius) {
  const base::Document document = base::Document::load(file);
  const base::Section root = document.root();
  root.allowOnly({"version", "targets", "tolerances", "plates", "search", "start", "bed"});
  const bool hasPlates = root.has("plates");
  CalibrationTargets t;
  ToleranceKeys within;
  if (root.has("tolerances")) within = root.section("tolerances").read(toleranceTable());
  if (hasPlates && !root.has("targets")) return withCurves(root, file, grainRadius, {}, within);
  const base::Section section = root.section("targets");
  const TargetKeys keys = section.read(targetTable());
  checkBesidePlates(section, keys, hasPlates);
  if (hasPlates) return withCurves(root, file, grainRadius, keys, within);
  if (root.has("search")) root.section("search").fail("", "requires [plates]; add this section, or remove the other");
  checkTogether(section, keys);
  const auto take = [&](Quantity quantity, const std::optional<double>& value) {
    if (value) t.wanted[quantity] = *value;
  };
  take(Quantity::exponent, keys.n), take(Quantity::cohesionModulus, keys.kc);
  take(Quantity::frictionModulus, keys.kphi), take(Quantity::cohesion, keys.c);
  take(Quantity::frictionAngle, keys.phi), take(Quantity::shearModulus, keys.shearModulus);
  t.k = keys.k, t.breadth = keys.b;
  t.angleTolerance = within.phi, t.cohesionTolerance = within.c, t.stiffnessTolerance = within.k;
  t.start = readMaterial(root, "start", file, grainRadius);
  return t;
}

namespace {

/// Slope from `from` to the nearest other trial; limited to a range around `expected`, because trials scatter.
double slopeNear(const std::vector<Trial>& trials, const Trial& from, double expected) {
  const Trial* next = nullptr;
  for (const Trial& t : trials)
    if (t.x != from.x && (!next || std::fabs(t.x - from.x) < std::fabs(next->x - from.x))) next = &t;
  if (!next) return expected;
  return std::clamp((next->y - from.y) / (next->x - from.x), expected / kSlopes, kSlopes * expected);
}

} // namespace

std::optional<double> nextTrial(const std::vector<Trial>& trials, double wanted, double tolerance, double low,
                                double high, double slope) {
  if (trials.empty() || trials.size() >= kMaxTrials) return {};
  const Trial *below = nullptr, *above = nullptr; // the nearest trial on each side of the target
  for (const Trial& t : trials) {
    if (std::fabs(t.y - wanted) <= tolerance) return {};
    if (t.y < wanted && (!below || t.x > below->x)) below = &t;
    if (t.y > wanted && (!above || t.x < above->x)) above = &t;
  }
  const double same = kSame * tolerance / slope;
  if (below && above && below->x < above->x) {
    const double share = (wanted - below->y) / (above->y - below->y);
    const double x = below->x + (above->x - below->x) * std::clamp(share, kMiddle, 1 - kMiddle);
    return above->x - below->x < same ? std::nullopt : std::optional<double>(x);
  }
  // All trials are on one side of the target, or scatter has reversed their order: extrapolate from the outermost one.
  const Trial& from = below ? *below : *above;
  const double x = std::clamp(from.x + (wanted - from.y) / slopeNear(trials, from, slope), low, high);
  if (std::fabs(x - from.x) < same) return {};
  return x;
}

Trial nearestTrial(const std::vector<Trial>& trials, double wanted) {
  return *std::min_element(trials.begin(), trials.end(), [&](const Trial& a, const Trial& b) {
    return std::fabs(a.y - wanted) < std::fabs(b.y - wanted);
  });
}

StrengthSearch::StrengthSearch(std::optional<Target> angle, std::optional<Target> cohesion, StrengthPoint start)
    : targets_{angle, cohesion}, start_(start), next_(start) {
  for (std::size_t k = 0; k < 2; ++k)
    if (targets_[k]) unit_[k] = targets_[k]->tolerance / targets_[k]->slope;
}

double StrengthSearch::farOff(const Done& trial) const {
  return std::max(std::fabs(trial.off[0]), std::fabs(trial.off[1]));
}

/// Broyden's update: the smallest change of the slopes that reproduces the last step; limited, because trials scatter.
void StrengthSearch::learn(const Done& before, const Done& now) {
  constexpr double kMaxAcross = 0.8;
  const Two way{now.x[0] - before.x[0], now.x[1] - before.x[1]};
  const double square = way[0] * way[0] + way[1] * way[1];
  if (square == 0) return;
  for (std::size_t row = 0; row < 2; ++row) {
    if (!targets_[row]) continue;
    const double came = before.off[row] - now.off[row];
    const double missed = came - slopes_[row][0] * way[0] - slopes_[row][1] * way[1];
    for (std::size_t column = 0; column < 2; ++column) slopes_[row][column] += missed * way[column] / square;
    slopes_[row][row] = std::clamp(slopes_[row][row], 1 / kSlopes, kSlopes);
    double& across = slopes_[row][1 - row];
    across = std::clamp(across, -kMaxAcross * slopes_[row][row], kMaxAcross * slopes_[row][row]);
  }
}

StrengthSearch::Two StrengthSearch::stepFrom(const Done& trial) const {
  constexpr double kMaxOfWay = 0.4, kMaxUnits = 10; // limits of a step; the pull may also change by its present value
  const auto& s = slopes_;
  const double determinant = s[0][0] * s[1][1] - s[0][1] * s[1][0];
  Two step{(trial.off[0] * s[1][1] - trial.off[1] * s[0][1]) / determinant,
           (trial.off[1] * s[0][0] - trial.off[0] * s[1][0]) / determinant};
  const double maxPull = std::max(kMaxUnits, trial.x[1]);
  step[0] = std::clamp(step[0], -kMaxOfWay / unit_[0], kMaxOfWay / unit_[0]);
  step[1] = std::clamp(step[1], -maxPull, maxPull);
  for (std::size_t k = 0; k < 2; ++k)
    if (!targets_[k]) step[k] = 0;
  return step;
}

bool StrengthSearch::tried(double angle, double cohesion) {
  const StrengthPoint was = at();
  Done trial{was, {was.way / unit_[0], was.pull / unit_[1]}, {0, 0}};
  if (targets_[0]) trial.off[0] = (targets_[0]->wanted - angle) / targets_[0]->tolerance;
  if (targets_[1]) trial.off[1] = (targets_[1]->wanted - cohesion) / targets_[1]->tolerance;
  if (!trials_.empty()) learn(trials_.back(), trial);
  trials_.push_back(trial);
  if (farOff(trial) <= 1 || trials_.size() >= kMaxTrials) return false;
  const Two step = stepFrom(trial);
  next_ = {fourDigits(std::clamp(was.way + step[0] * unit_[0], kMinWay, kMaxWay)),
           fourDigits(std::max(0.0, was.pull + step[1] * unit_[1]))};
  const double moved = std::max(std::fabs(next_.way - was.way) / unit_[0], std::fabs(next_.pull - was.pull) / unit_[1]);
  return moved >= kSame;
}

StrengthPoint StrengthSearch::nearest() const {
  const auto best = std::min_element(trials_.begin(), trials_.end(),
                                     [this](const Done& a, const Done& b) { return farOff(a) < farOff(b); });
  return best == trials_.end() ? start_ : best->where;
}

Strength strengthAt(double way, double startFriction) {
  if (way < 0) return {std::max(kMinFriction, startFriction * (1 + way)), 0};
  if (way <= 1) return {startFriction, kMaxRolling * way};
  return {startFriction + std::max(0.0, kMaxFriction - startFriction) * (way - 1), kMaxRolling};
}

double wayOf(double rollingFriction) { return std::min(1.0, rollingFriction / kMaxRolling); }

} // namespace grouser::virtual_tests
