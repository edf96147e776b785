// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/campaigns/sweeps/sweep_summary.hpp"
#include "runs/support/line_fit.hpp"

#include <filesystem>
#include <string>
#include <vector>

/// Statistics over the seeds of a sweep: means with 95 % intervals, and differences from the first combination.
namespace grouser::sweeps {

/// One combination of the swept values, over its seeds.
struct SeedGroup {
  std::vector<std::string> values;        ///< values of the keys except the seed
  int runs = 0;                           ///< number of finished runs with valid figures
  std::string doubt;                      ///< reason why all figures are inconclusive, see SweepFigures; else empty
  std::vector<support::Estimate> figures; ///< one per SweepFigures column; infinite half width for one seed
  std::vector<support::Estimate>
      differences; ///< relative to the mean of the first group [-], paired by common seeds; NaN without such seeds
  std::vector<support::Estimate> changes; ///< the same differences in the figures' units
};

struct SeedIntervals {
  std::vector<std::string> keys;    ///< swept keys except the seed
  std::vector<std::string> columns; ///< columns of the figures
  std::vector<SeedGroup> groups;    ///< in the order of the runs; empty if the seed is not swept
  bool hitched = false;             ///< whether a scene has [hitch]: drawbar pull is then a main figure
};

SeedIntervals seedIntervals(const SweepPlan& plan, const SweepFigures& figures);

/// Writes intervals.csv: one row per combination and figure, with number of seeds, mean, half width, and difference
/// from the first combination (in the figure's unit, and relative to the first mean). Returns the path.
std::filesystem::path writeIntervals(const SeedIntervals& intervals, const std::filesystem::path& folder);

/// Text table of the main figures.
std::string intervalsText(const SeedIntervals& intervals);

} // namespace grouser::sweeps
