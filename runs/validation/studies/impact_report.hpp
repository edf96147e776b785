// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/validation/studies/impact.hpp"

/// The tables of `grouser study impact`, as text and as CSV.
namespace grouser::studies {

/// All step sizes of one collision: errors in single precision, CPU times in both precisions.
std::string impactTable(const ImpactSeries& single, const ImpactSeries& double_);
/// Measured and expected orders of the errors, one line per collision.
std::string orderTable(const std::vector<ImpactSeries>& all);
/// Cheapest step for errors of 10, 1 and 0.1 %: steps per contact and CPU time per collision.
std::string cheapestImpactTable(const std::vector<ImpactSeries>& all);
std::string impactCsv(const std::vector<ImpactSeries>& all);
std::string orderCsv(const std::vector<ImpactSeries>& all);
std::string cheapestImpactCsv(const std::vector<ImpactSeries>& all);

/// Measured and exact values of all damping ratios at one step size; `point`: its index.
std::string closedFormTable(const std::vector<ImpactSeries>& all, std::size_t point);

/// Convergence of the linear law: worst and mean error of the restitution at an integer number of steps per contact.
struct ConvergenceRow {
  double steps = 0;
  double published = 0; ///< published worst error of an independent integration; NaN if there is none
  ImpactError damped, elastic;
};
std::vector<ConvergenceRow> convergenceRows(int phases);
std::string convergenceTable(const std::vector<ConvergenceRow>& rows);
std::string convergenceCsv(const std::vector<ConvergenceRow>& rows);

/// Accuracy over the range of run.steps_per_contact: errors for one restitution with the clamped law, which scenes use.
struct CoarseRow {
  double restitution = 0, zeta = 0;
  std::array<ImpactError, 3> error; ///< errors at kCoarseSteps
};
inline constexpr std::array<double, 3> kCoarseSteps{20, 10, 6};
std::vector<CoarseRow> coarseRows(int phases);
std::string coarseTable(const std::vector<CoarseRow>& rows);

/// Errors over the approach speed at the same number of steps per contact.
std::string speedTable(const std::vector<ImpactSeries>& all);

} // namespace grouser::studies
