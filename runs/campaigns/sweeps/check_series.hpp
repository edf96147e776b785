// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/campaigns/sweeps/check_results.hpp"

#include <string>
#include <vector>

/// Errors of a scene's time series, at each of its output times.
namespace grouser::sweeps {

struct SeriesWithBars {
  std::string name;          ///< with its unit
  std::vector<double> value; ///< mean over the seeds
  std::vector<double> seeds; ///< half width of its 95 % interval; 0 where seeds make no difference
  std::vector<double> step;  ///< half width of the error by the step: stepError(), or scatteredStepError() of h and h/2
  std::vector<double> both;  ///< root of the sum of their squares; other axes have no part in it
};
struct CheckSeries {
  std::vector<double> time; ///< [s]
  std::vector<SeriesWithBars> series;
};

/// Whether the runs of a case have a part in the series: those of the base and of finer steps.
bool hasPartInSeries(const CheckCase& aCase);

/// Of the base's runs; a number that is not known is NaN. Series that the finer runs have not, or at other times, have
/// no error by the step. `levels`: of the intervals over seeds.
CheckSeries checkSeries(const CheckCases& cases, const CheckRuns& runs, const std::vector<SweepOutcome>& outcomes,
                        const SeedLevels& levels = {});

/// As text: time, and for each series its value and the three half widths.
std::string seriesCsv(const CheckSeries& series);

} // namespace grouser::sweeps
