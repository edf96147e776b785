// SPDX-License-Identifier: BSD-3-Clause
// Tables and files of `grouser soil NAME --fit-scm`.
#include "runs/jobs/estimate.hpp"
#include "runs/output/plots.hpp"
#include "runs/support/print_stderr.hpp"
#include "runs/support/text_file.hpp"
#include "runs/virtual_tests/constant_doubts.hpp"
#include "runs/virtual_tests/scm_fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace grouser::virtual_tests {

namespace {

std::string percent(double share) { return std::isfinite(share) ? fmt::format("{:.1f} %", 100 * share) : "-"; }

double siValue(const ScmFit& fit, Quantity q) { return inSoilFile(q, fit.constants.at(q).value); }

/// Line of section [scm] with a constant, its unit and its interval, e.g. "n = 1.1 # [-] +- 0.1".
std::string lineOf(Quantity q, double value, const support::Estimate& e) {
  return fmt::format("{} = {:.6g} # [{}] +- {:.2g}{}\n", symbolOf(q), value, soilFileUnitOf(q),
                     inSoilFile(q, e.halfWidth), doubtOf(q, e).empty() ? "" : ", inconclusive");
}

} // namespace

std::string scmFitText(const TestPlan& plan, const ScmFit& fit) {
  std::string text = fmt::format("\nfit of the soil contact model to virtual tests of {}{}: p = (k_c / b + k_phi) z^n, "
                                 "tau = (c + p tan phi) (1 - exp(-j / K))\n",
                                 plan.soil.name, plan.options.coarse ? " (coarse)" : "");
  for (const auto& [q, e] : fit.constants)
    text += fmt::format("  {:<8} {:>20} {}{}\n", symbolOf(q), jobs::valueText(e), unitOf(q),
                        doubtOf(q, e).empty() ? "" : "  inconclusive");
  text +=
      fmt::format("  {:<8} {:>20} elastic_ratio, from unloading the plates\n", "f", jobs::valueText(fit.elasticRatio));
  text += fmt::format("\n  {:<16} {:>5} {:>9} {:>9} {:>12} {:>13}\n", "measured / fit - 1", "tests", "rms", "largest",
                      "model error", "seed scatter");
  for (const FittedGroup& g : fit.groups)
    text += fmt::format("  {:<18} {:>5} {:>9} {:>9} {:>12} {:>13}\n", g.name, g.tests.size(), percent(g.residual.rms),
                        fmt::format("{:+.1f} %", 100 * g.residual.largest), percent(g.residual.model),
                        percent(g.residual.scatter));
  return text + fmt::format("  model error with these constants: plates {}, shear {} (rms deviation of the mean curves "
                            "where the fit exceeds {:g} % of the maximum stress)\n",
                            percent(fit.modelError(true)), percent(fit.modelError(false)), 100 * kCountedFrom);
}

std::string scmFitToml(const TestPlan& plan, const ScmFit& fit, std::string& why) {
  const auto at = [&](Quantity q) { return siValue(fit, q); };
  const double n = at(Quantity::exponent), phi = at(Quantity::frictionAngle), modulus = at(Quantity::shearModulus);
  if (!(n > 0 && n <= 3))
    why = fmt::format("n = {:.4g} is outside (0, 3]", n);
  else if (!(phi >= 0 && phi <= 60))
    why = fmt::format("phi = {:.4g} deg is outside [0, 60]", phi);
  else if (!(modulus > 0))
    why = fmt::format("K = {:.4g} m is not positive", modulus);
  if (!why.empty()) return "";
  std::string text =
      fmt::format("# Soil contact model (terrain.kind = \"scm\") fitted to {}virtual tests of {} (grain diameter {:g} "
                  "mm) by\n# `grouser soil {} --fit-scm`. +- is the half width of the 95 % interval. Model error: "
                  "plates {}, shear {}.\n[scm]\n",
                  plan.options.coarse ? "coarse " : "", plan.soil.name, 2e3 * plan.soil.grainRadius, plan.soil.name,
                  percent(fit.modelError(true)), percent(fit.modelError(false)));
  for (const auto& [q, e] : fit.constants) text += lineOf(q, q == Quantity::cohesion ? std::max(0.0, at(q)) : at(q), e);
  const support::Estimate& f = fit.elasticRatio;
  if (std::isfinite(f.value))
    text += fmt::format("elastic_ratio = {:.4g} # [-] +- {:.2g}{}\n", std::max(1.0, f.value), f.halfWidth,
                        f.value < 1 ? fmt::format("; measured {:.2g}, the model requires at least 1", f.value) : "");
  return text;
}

std::string scmResidualsCsv(const TestPlan& plan, const ScmFit& fit) {
  std::string text = "care,tests,test,rms [-],largest [-],at [m],model error [-],seed scatter [-]\n";
  for (const FittedGroup& g : fit.groups)
    for (std::size_t i = 0; i < g.tests.size(); ++i)
      text += fmt::format("{},{},{},{:.5g},{:.5g},{:.5g},{:.5g},{:.5g}\n", plan.care(), g.name, g.tests[i].test,
                          g.residuals[i].rms, g.residuals[i].largest, g.residuals[i].largestAt, g.residual.model,
                          g.residual.scatter);
  return text;
}

std::string scmCurvesCsv(const TestPlan& plan, const ScmFit& fit) {
  std::string text = "care,tests,test,sinkage or displacement [m],measured [Pa],fit [Pa]\n";
  for (const FittedGroup& g : fit.groups)
    for (const FittedCurve& c : g.tests)
      for (std::size_t i = 0; i < c.way.size(); ++i)
        text += fmt::format("{},{},{},{:.6g},{:.6g},{:.6g}\n", plan.care(), g.name, c.test, c.way[i], c.measured[i],
                            c.fitted[i]);
  return text;
}

void reportScmFit(const TestPlan& plan, const jobs::Pieces& pieces) {
  const SoilResults results = resultsOf(plan, pieces);
  if (!results.hasPlates() || !results.hasShear())
    return fmt::print("fit       skipped: {}; repeat the command with --resume\n",
                      results.hasShear() ? "a plate has no finished tests"
                                         : "no seed has finished shear tests under all loads");
  const ScmFit fit = fitScm(plan, pieces, results);
  const std::string text = scmFitText(plan, fit);
  std::string why;
  const std::string toml = scmFitToml(plan, fit, why);
  fmt::print("{}", text);
  const auto& folder = pieces.folder();
  if (toml.empty())
    support::printStderr("WARNING: scm_fit.toml was not written, because {}; use more seeds or larger plates\n", why);
  else
    support::replaceTextFile(folder / "scm_fit.toml", toml);
  support::replaceTextFile(folder / "scm_fit.txt", text);
  support::replaceTextFile(folder / "scm_residuals.csv", scmResidualsCsv(plan, fit));
  support::replaceTextFile(folder / "scm_curves.csv", scmCurvesCsv(plan, fit));
  output::drawPicture("scm_fit.py", {folder / "scm_curves.csv"}, folder / "scm_fit.png");
  if (!toml.empty()) fmt::print("fit       {} (add it to a scene)\n", (folder / "scm_fit.toml").string());
}

} // namespace grouser::virtual_tests
