// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/jobs/estimate.hpp"

#include <optional>
#include <span>
#include <vector>

/// Errors of a figure from runs that differ in one setting.
namespace grouser::sweeps {

/// Time-step error of reproducible runs, from a figure at steps h, h/2, h/4...
struct StepError {
  double change = 0;           ///< estimated value at zero step less that at h
  double bar = 0;              ///< bound of the true change; infinite for a single value
  std::optional<double> order; ///< observed order of convergence; never assumed
};

/// `values` at h, h/2, h/4... An order is observed if the last three differences of successive values have the same
/// sign, shrink, and have orders that agree within 0.5; Richardson extrapolation then yields the figure at h = 0, and
/// the bar is 1.25 times the change (P. J. Roache, J. Fluids Eng. 116 (1994) 405, grid convergence index of three or
/// more grids). Without an observed order, errors are assumed to stay below C h, with C the largest |value - finest| /
/// h: the bar is the change to the finest value plus a quarter of C h, a third for three values, all of it for two.
StepError stepError(std::span<const double> values);

/// Error probabilities of intervals over seeds: of a value, and of a change by an axis.
struct SeedLevels {
  double value = 0.05, change = 0.05;
};

/// Time-step error of runs that scatter with the seed.
struct ScatteredStepError {
  support::Estimate change; ///< from the base to half its step; to zero step with an observed order
  std::optional<double> order;
  double bar = 0; ///< |change| + half width, twice that without an observed order
};
/// `fine`: a figure at h/2 less that at h for each seed; `coarse`: that at h less that at 2 h for the same seeds, or
/// empty. An order is observed if both means exceed their half widths, have the same sign and shrink by 2^0.5 to 2^8;
/// the change to h = 0 is then f c / (c - f) of these means, with the interval of its linearisation over the seeds,
/// which includes the scatter of the order. Otherwise first order is assumed. `miss`: error probability of an interval.
ScatteredStepError scatteredStepError(std::span<const double> fine, std::span<const double> coarse, double miss = 0.05);
inline constexpr double kStepUnseen = 2; ///< bar of the step over |change| + half width without an observed order

/// Verdict on a difference by a bar. With fewer than 8 seeds, *equal* requires a half width below half the bar.
jobs::Verdict judgeSeeds(const support::Estimate& difference, double bar, int seeds);

/// Root of the sum of the squares of the seeds' half width and of the bars of all errors.
double totalBar(double seedsHalfWidth, std::span<const double> bars);

/// Number of seeds whose interval with error probability `miss` has a half width below `bar`, if `seeds` seeds had
/// `halfWidth`, all in one unit; 0: more than a thousand, or fewer than two were run.
int seedsFor(double bar, double halfWidth, int seeds, double miss = 0.05);

} // namespace grouser::sweeps
