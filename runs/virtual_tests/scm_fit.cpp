// SPDX-License-Identifier: BSD-3-Clause
#include "runs/virtual_tests/scm_fit.hpp"

#include "base/math.hpp"
#include "runs/jobs/estimate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace grouser::virtual_tests {

namespace {

/// A fitted constant in SI units.
double valueOf(const ScmFit& fit, Quantity quantity) { return inSoilFile(quantity, fit.constants.at(quantity).value); }

/// Loading curve of a plate, and p = (k_c / b + k_phi) z^n at its points. Excludes points without sinkage.
FittedCurve plateCurve(const ScmFit& fit, const TestPlan& plan, const PlannedTest& test, const jobs::Table& run) {
  const double n = valueOf(fit, Quantity::exponent),
               k = valueOf(fit, Quantity::cohesionModulus) / plan.breadth(test.kind) +
                   valueOf(fit, Quantity::frictionModulus);
  const SinkageCurve bedded = beddedCurve(plan, run).curve;
  FittedCurve curve{test.name, {}, {}, {}};
  for (std::size_t i = 0; i < bedded.sinkage.size(); ++i) {
    if (!(bedded.sinkage[i] > (curve.way.empty() ? 0 : curve.way.back()))) continue;
    curve.way.push_back(bedded.sinkage[i]), curve.measured.push_back(bedded.pressure[i]);
    curve.fitted.push_back(k * std::pow(bedded.sinkage[i], n));
  }
  return curve;
}

/// Curve of a shear test, and tau = (c + sigma tan phi) (1 - exp(-j / K)) with the normal stress of the test.
FittedCurve shearFitCurve(const ScmFit& fit, const TestPlan& plan, const PlannedTest& test, const jobs::Table& run) {
  const double c = valueOf(fit, Quantity::cohesion), modulus = valueOf(fit, Quantity::shearModulus),
               friction = std::tan(valueOf(fit, Quantity::frictionAngle) * base::kPi / 180);
  const ShearCurve measured = shearCurve(run, plan.grains.grains.diameter());
  FittedCurve curve{test.name, {}, {}, {}};
  for (std::size_t i = 0; i < measured.displacement.size(); ++i) {
    const double j = measured.displacement[i];
    if (!(j > 0)) continue;
    curve.way.push_back(j), curve.measured.push_back(measured.shear[i]);
    curve.fitted.push_back((c + measured.normal[i] * friction) * -std::expm1(-j / modulus));
  }
  return curve;
}

void addGroup(ScmFit& fit, const std::string& name, bool isPlate, std::vector<FittedCurve> tests) {
  if (tests.empty()) return;
  FittedGroup group{name, isPlate, std::move(tests), {}, {}};
  for (const FittedCurve& c : group.tests) group.residuals.push_back(residualOf(c));
  group.residual = residualOf(group.tests);
  fit.groups.push_back(std::move(group));
}

} // namespace

double ScmFit::modelError(bool ofPlates) const {
  double squares = 0, count = 0;
  for (const FittedGroup& g : groups)
    if (g.isPlate == ofPlates && std::isfinite(g.residual.model))
      squares += g.residual.model * g.residual.model, ++count;
  return std::sqrt(squares / count);
}

double elasticRatioOf(const jobs::Table& run, double origin, double n) {
  const Unloading u = unloadingOf(run);
  const double sinkage = loadingCurve(run).sinkage.back() - origin;
  return u.stiffness * sinkage / (std::max(1.0, n) * u.from);
}

ScmFit fitScm(const TestPlan& plan, const jobs::Pieces& pieces, const SoilResults& results) {
  ScmFit fit;
  for (const Quantity q : kQuantities)
    if (q != Quantity::repose) fit.constants[q] = results.measured.at(q);
  std::vector<double> ratios;
  for (const TestKind kind : kBreadths) {
    std::vector<FittedCurve> curves;
    for (const PlannedTest& test : plan.tests) {
      if (test.kind != kind || !pieces.has(test.name)) continue;
      const jobs::Table run = pieces.read(test.name);
      curves.push_back(plateCurve(fit, plan, test, run));
      const double ratio = elasticRatioOf(run, beddedCurve(plan, run).origin, valueOf(fit, Quantity::exponent));
      if (std::isfinite(ratio)) ratios.push_back(ratio);
    }
    addGroup(fit, fmt::format("plate {:.3g} m", plan.breadth(kind)), true, std::move(curves));
  }
  if (!ratios.empty()) fit.elasticRatio = jobs::interval95(ratios);
  for (const double load : plan.options.loads) {
    std::vector<FittedCurve> curves;
    for (const PlannedTest& test : plan.tests)
      if (test.kind == TestKind::shear && test.load == load && pieces.has(test.name))
        curves.push_back(shearFitCurve(fit, plan, test, pieces.read(test.name)));
    addGroup(fit, fmt::format("shear {:g} kPa", 1e-3 * load), false, std::move(curves));
  }
  return fit;
}

} // namespace grouser::virtual_tests
