// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/campaigns/sweeps/check_cases.hpp"
#include "runs/campaigns/sweeps/runner.hpp"

#include <optional>
#include <string>
#include <vector>

namespace grouser::sweeps {

struct CheckOptions {
  std::vector<std::string> fixed;   ///< overrides "key=value" of all runs
  std::optional<int> seeds;         ///< maximum number per case; default: 8, with figures 24
  double percent = 5;               ///< percentage of a figure's mean: tolerance of the verdicts, and target of figures
  std::vector<std::string> figures; ///< figures with target bars, see goalFigure(); empty: run all cases
  std::vector<CheckAxis> axes;      ///< axes to vary; empty: all
  int draws = 0;                    ///< number of samples of the soil constants
  std::string budget;               ///< total wall time, e.g. "20min"; empty: unlimited
  SweepOptions sweep;               ///< folder, jobs and seconds of this call

  int maxSeeds() const { return seeds.value_or(figures.empty() ? 8 : 24); }
};

} // namespace grouser::sweeps
