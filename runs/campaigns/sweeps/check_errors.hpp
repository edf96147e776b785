// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/jobs/estimate.hpp"

#include <optional>
#include <span>
#include <vector>

/// Errors of a figure from runs that differ in one setting.
namespace grouser::sweeps {

/// Error of the step where runs repeat to the bit: from the same figure at steps h, h/2, h/4...
struct StepError {
  double change = 0;           ///< of the figure where the step goes to nothing: finest known value less that at h
  double bar = 0;              ///< the true change lies within +- this of zero; infinite where there is one value
  std::optional<double> order; ///< of convergence, where it is seen; it is never assumed
};

/// `values` at h, h/2, h/4... An order is seen where the last three differences of successive values have one sign,
/// shrink, and tell orders that agree within 0.5; the figure at h = 0 then follows by Richardson's extrapolation, and
/// the bar is 1.25 times the change (P. J. Roache, J. Fluids Eng. 116 (1994) 405, grid convergence index of three or
/// more grids). Where no order is seen, errors are taken to stay below C h, with C the largest |value - finest| / h
/// that is seen: the bar is the change to the finest value and a quarter of C h, a third for three values, all of it
/// for two.
StepError stepError(std::span<const double> values);

/// Chances that an interval over seeds misses: that of a value, and that of a change by an axis.
struct SeedLevels {
  double value = 0.05, change = 0.05;
};

/// The same where runs scatter with the seed.
struct ScatteredStepError {
  support::Estimate change; ///< from the base to half its step; to no step at all where an order is seen
  std::optional<double> order;
  double bar = 0; ///< what the step may be wrong by: |change| + half width, twice that where no order is seen
};
/// `fine`: a figure at h/2 less that at h, a number a seed; `coarse`: that at h less that at 2 h, of the same seeds, or
/// empty. An order is seen where both means lie outside their intervals, have one sign and shrink by 2^0.5 to 2^8; then
/// the change to h = 0 is f c / (c - f) of these means, and its interval that of its linear part over the seeds, with
/// the scatter of the order in it. Where none is seen h/2 is as wrong again as it differs: of first order. `miss`: the
/// chance that an interval misses.
ScatteredStepError scatteredStepError(std::span<const double> fine, std::span<const double> coarse, double miss = 0.05);
inline constexpr double kStepUnseen = 2; ///< bar of the step over |change| + half width where no order is seen

/// How a difference stands to a bar. With fewer than 8 seeds its half width must lie below half of the bar for *equal*.
jobs::Verdict judgeSeeds(const support::Estimate& difference, double bar, int seeds);

/// Root of the sum of the squares of the seeds' half width and of the bars of all errors.
double totalBar(double seedsHalfWidth, std::span<const double> bars);

/// How many seeds bring the half width of the interval that misses with this chance below `bar`, where `seeds` of them
/// gave `halfWidth`, all in one unit; 0: more than a thousand, or fewer than two were run.
int seedsFor(double bar, double halfWidth, int seeds, double miss = 0.05);

} // namespace grouser::sweeps
