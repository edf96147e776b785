// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/campaigns/sweeps/check_results.hpp"

#include <string>
#include <vector>

/// Error bars of time series at each output time.
namespace grouser::sweeps {

struct SeriesWithBars {
  std::string name;          ///< with its unit
  std::vector<double> value; ///< mean over the seeds
  std::vector<double> seeds; ///< half width of the 95 % interval over seeds; 0 without seed dependence
  std::vector<double> step;  ///< half width of the step error: stepError(), or scatteredStepError() of h and h/2
  std::vector<double> both;  ///< root sum of squares of both; excludes other axes
};
struct CheckSeries {
  std::vector<double> time; ///< [s]
  std::vector<SeriesWithBars> series;
};

/// Whether a case contributes to the series: true for the base and finer steps.
bool hasPartInSeries(const CheckCase& aCase);

/// Series of the base runs; unknown numbers are NaN. A series has no step error if the finer runs lack it or have other
/// output times. `levels`: levels of the intervals over seeds.
CheckSeries checkSeries(const CheckCases& cases, const CheckRuns& runs, const std::vector<SweepOutcome>& outcomes,
                        const SeedLevels& levels = {});

/// CSV text: time, and for each series the value and the three half widths.
std::string seriesCsv(const CheckSeries& series);

} // namespace grouser::sweeps
