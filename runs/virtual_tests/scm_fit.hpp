// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/virtual_tests/results.hpp"
#include "runs/virtual_tests/scm_residual.hpp"

#include <string>
#include <vector>

/// `grouser soil NAME --fit-scm`: constants of the soil contact model (SCM) from virtual tests, and the model error.
namespace grouser::virtual_tests {

/// Tests of one plate, or shear tests under one load.
struct FittedGroup {
  std::string name; ///< "plate 0.112 m", "shear 25 kPa"
  bool isPlate = false;
  std::vector<FittedCurve> tests;
  std::vector<TestResidual> residuals; ///< one for each test
  GroupResidual residual;
};

struct ScmFit {
  std::map<Quantity, support::Estimate> constants; ///< n, k_c, k_phi, c, phi, K in unitOf()
  support::Estimate elasticRatio = kUnmeasured;    ///< see elasticRatioOf; [scm] elastic_ratio must be at least 1 [-]
  std::vector<FittedGroup> groups;
  /// Model error of the plate tests or of the shear tests: rms over their groups [-].
  double modelError(bool ofPlates) const;
};

/// Ratio of the unloading slope to max(1, n) p / z at the end of a plate's loading [-], for [scm] elastic_ratio. NaN if
/// the slope was not measured. `origin`: origin of the sinkage from correctedForBedding() [m].
double elasticRatioOf(const jobs::Table& run, double origin, double n);

/// Fits the soil contact model to the finished tests, which must include both plates, and shear tests under all loads.
ScmFit fitScm(const TestPlan& plan, const jobs::Pieces& pieces, const SoilResults& results);

/// Table of constants and residuals.
std::string scmFitText(const TestPlan& plan, const ScmFit& fit);
/// Section [scm] of a scene file. Empty if a constant is outside the range of its key; `why` then contains the reason.
std::string scmFitToml(const TestPlan& plan, const ScmFit& fit, std::string& why);
std::string scmResidualsCsv(const TestPlan& plan, const ScmFit& fit); ///< one row per test
std::string scmCurvesCsv(const TestPlan& plan, const ScmFit& fit);    ///< one row per point

/// Prints the fit, and writes scm_fit.toml, scm_fit.txt, scm_residuals.csv, scm_curves.csv and scm_fit.png. If tests
/// are missing, only prints a note.
void reportScmFit(const TestPlan& plan, const jobs::Pieces& pieces);

} // namespace grouser::virtual_tests
