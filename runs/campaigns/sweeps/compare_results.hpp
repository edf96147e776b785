// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/campaigns/sweeps/sweep_plan.hpp"
#include "runs/campaigns/sweeps/sweep_summary.hpp"
#include "runs/jobs/estimate.hpp"

#include <nlohmann/json_fwd.hpp>

#include <filesystem>
#include <string>
#include <vector>

/// Figures of a scene in several variants (kinds of ground, contact methods), and their differences.
namespace grouser::sweeps {

/// Results of one variant over its runs.
struct VariantResult {
  std::string variant;                     ///< "granular", "penalty", "penalty_x0.5"
  bool random = false;                     ///< whether it has several seeds; otherwise values have no interval
  int runs = 0, ended = 0;                 ///< planned runs; runs with figures
  std::string doubt;                       ///< reason why all figures are inconclusive; else empty
  std::vector<support::Estimate> figures;  ///< [columns]; NaN if missing
  std::vector<std::vector<double>> values; ///< [columns][runs with a value]
  double wallTime = 0;                     ///< wall time of the steps, mean over the runs [s]
  double preparation = 0, cpuTime = 0;     ///< means of wall time before the steps, CPU time of the steps [s]
  double perSecond = 0;                    ///< wall time / simulated time [-]
};

/// Difference between two variants: `to` minus `from`.
struct VariantDifference {
  std::size_t from = 0, to = 0;           ///< indices of the variants
  std::vector<support::Estimate> changes; ///< [columns]; NaN if a variant lacks the value
  std::vector<std::string> verdicts;      ///< "equal", "differs", "inconclusive"; empty if a variant lacks the value
};

struct Comparison {
  std::vector<std::string> columns;
  std::vector<VariantResult> variants;
  std::vector<VariantDifference> differences; ///< all pairs of variants
};

/// Difference b - a with its 95 % half width: Welch's interval between two samples; if one variant has no scatter, the
/// half width of the other mean; 0 if neither has scatter.
support::Estimate variantDifference(const VariantResult& a, const VariantResult& b, std::size_t column);

/// Verdict on a difference with a tolerance of `percent` of the larger mean.
std::string variantVerdict(const support::Estimate& difference, double a, double b, double percent);

/// Value with half width ("12.3 +- 0.4"); only the value, with four digits, if the half width is zero or infinite; "-"
/// for NaN.
std::string figureText(const support::Estimate& e);

/// The first value of each run is its variant. `random`: variants with several seeds.
Comparison comparisonOf(const SweepPlan& plan, const std::vector<SweepOutcome>& outcomes,
                        const std::vector<std::string>& random, double percent, const std::filesystem::path& folder);

/// Text of the main figures, their differences, and the cost. `fromFirst`: only differences from the first variant, in
/// percent, as one table.
std::string comparisonText(const Comparison& comparison, double percent, bool fromFirst = false);
/// One row per figure and pair of variants.
std::string comparisonCsv(const Comparison& comparison);
nlohmann::ordered_json comparisonJson(const Comparison& comparison);

} // namespace grouser::sweeps
