// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/validation/studies/impact.hpp"

/// The tables of `grouser study impact`, as text and as CSV.
namespace grouser::studies {

/// All steps of one collision: errors in single precision, times in both.
std::string impactTable(const ImpactSeries& single, const ImpactSeries& double_);
/// Measured orders beside the expected ones, a line a collision.
std::string orderTable(const std::vector<ImpactSeries>& all);
/// Cheapest step for 10, 1 and 0.1 %: steps a contact and CPU time of a collision.
std::string cheapestImpactTable(const std::vector<ImpactSeries>& all);
std::string impactCsv(const std::vector<ImpactSeries>& all);
std::string orderCsv(const std::vector<ImpactSeries>& all);
std::string cheapestImpactCsv(const std::vector<ImpactSeries>& all);

/// Every damping ratio at one step, measured beside exact.
std::string closedFormTable(const std::vector<ImpactSeries>& all, std::size_t point);

/// One row of the convergence of the linear law at whole steps a contact: worst and mean error of the restitution.
struct ConvergenceRow {
  double steps = 0;
  double published = 0; ///< worst error found by an independent integration; NaN: none
  ImpactError damped, elastic;
};
std::vector<ConvergenceRow> convergenceRows(int phases);
std::string convergenceTable(const std::vector<ConvergenceRow>& rows);
std::string convergenceCsv(const std::vector<ConvergenceRow>& rows);

/// What run.steps_per_contact buys: the error of one restitution, of the clamped law as scenes have it, at the steps
/// a contact that the key may name.
struct CoarseRow {
  double restitution = 0, zeta = 0;
  std::array<ImpactError, 3> error; ///< at kCoarseSteps
};
inline constexpr std::array<double, 3> kCoarseSteps{20, 10, 6};
std::vector<CoarseRow> coarseRows(int phases);
std::string coarseTable(const std::vector<CoarseRow>& rows);

/// Errors over the speed of approach, at one number of steps a contact.
std::string speedTable(const std::vector<ImpactSeries>& all);

} // namespace grouser::studies
