// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/jobs/estimate.hpp"

#include <optional>
#include <span>
#include <vector>

/// Errors of a figure, from runs that differ in one setting.
namespace grouser::sweeps {

/// Time-step error of reproducible runs, from a figure at steps h, h/2, h/4...
struct StepError {
  double change = 0;           ///< estimated value at zero step minus value at h
  double bar = 0;              ///< bound on the true change; infinite for a single value
  std::optional<double> order; ///< observed order of convergence; never assumed
};

/// `values`: figure at h, h/2, h/4... An order is observed if the last three differences of successive values have the
/// same sign, decrease, and have orders that agree within 0.5. Richardson extrapolation then yields the figure at zero
/// step, and the bar is 1.25 times the change (P. J. Roache, J. Fluids Eng. 116 (1994) 405, grid convergence index of
/// three or more grids). Without an observed order, errors are assumed to stay below C h (C: largest difference from
/// the finest value / h): the bar is the change to this value plus C h / 4 (C h / 3 for three values, C h for two).
StepError stepError(std::span<const double> values);

/// Error probabilities of intervals over seeds: for a value, and for a change along an axis.
struct SeedLevels {
  double value = 0.05, change = 0.05;
};

/// Time-step error of runs that depend on the seed.
struct ScatteredStepError {
  support::Estimate change; ///< from the base to half its step; with an observed order, to zero step
  std::optional<double> order;
  double bar = 0; ///< |change| + half width; twice this sum without an observed order
};
/// `fine`: for each seed, the figure at h/2 minus the figure at h; `coarse`: figure at h minus figure at 2 h for the
/// same seeds, or empty. An order is observed if both means exceed their half widths, have the same sign and have a
/// ratio of 2^0.5 to 2^8. The change to h = 0 is then f c / (c - f) of these means f and c; its interval follows from a
/// linearisation over the seeds, which includes the scatter of the order. Otherwise first order is assumed. `miss`:
/// error probability of an interval.
ScatteredStepError scatteredStepError(std::span<const double> fine, std::span<const double> coarse, double miss = 0.05);
inline constexpr double kStepUnseen = 2; ///< bar of the step / (|change| + half width) without an observed order

/// Verdict on a difference with a tolerance. With fewer than 8 seeds, "equal" requires a half width below half of it.
jobs::Verdict judgeSeeds(const support::Estimate& difference, double bar, int seeds);

/// Root sum of squares of the half width over the seeds and the bars of all errors.
double totalBar(double seedsHalfWidth, std::span<const double> bars);

/// Number of seeds required for a half width below `bar` at error probability `miss`, if `seeds` seeds had `halfWidth`
/// (same unit). Returns 0 if more than a thousand seeds are required, or if fewer than two were run.
int seedsFor(double bar, double halfWidth, int seeds, double miss = 0.05);

} // namespace grouser::sweeps
