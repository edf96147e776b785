// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/campaigns/sweeps/sweep_summary.hpp"
#include "runs/support/line_fit.hpp"

#include <filesystem>
#include <string>
#include <vector>

/// What the seeds of a sweep tell: means with 95 % intervals, and differences to the first combination.
namespace grouser::sweeps {

/// One combination of a sweep's values, over its seeds.
struct SeedGroup {
  std::vector<std::string> values;            ///< of the keys but the seed
  int runs = 0;                               ///< finished runs whose figures count
  std::string doubt;                          ///< why all of them are inconclusive: see SweepFigures; else empty
  std::vector<support::Estimate> figures;     ///< of SweepFigures::columns; half width infinite for one seed
  std::vector<support::Estimate> differences; ///< to the first group, over its mean [-]: seed by seed, of the
                                              ///< seeds that both have; NaN where there are none
  std::vector<support::Estimate> changes;     ///< the same in the figures' units
};

struct SeedIntervals {
  std::vector<std::string> keys;    ///< swept ones but the seed
  std::vector<std::string> columns; ///< of the figures
  std::vector<SeedGroup> groups;    ///< in the order of the runs; none where the seed is not swept
};

SeedIntervals seedIntervals(const SweepPlan& plan, const SweepFigures& figures);

/// Writes intervals.csv: a row for each combination and figure, with its number of seeds, mean, half width, and the
/// difference to the first combination, in its unit and in shares of its mean. Returns its path.
std::filesystem::path writeIntervals(const SeedIntervals& intervals, const std::filesystem::path& folder);

/// The figures one asks for first, as a table to read.
std::string intervalsText(const SeedIntervals& intervals);

} // namespace grouser::sweeps
