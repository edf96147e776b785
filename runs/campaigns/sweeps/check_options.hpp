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
  std::optional<int> seeds;         ///< most of each case, from the scene's run.seed on; default: 8, with figures 24
  double percent = 5;               ///< of a figure's mean: the bar of the verdicts, and that wanted of figures
  std::vector<std::string> figures; ///< whose bars decide what is run: words of goalFigure(); empty: all is run
  std::vector<CheckAxis> axes;      ///< to be looked at; empty: all
  int draws = 0;                    ///< samples of the constants of deformable soil
  std::string budget;               ///< "20min": wall time for all; empty: no end
  SweepOptions sweep;               ///< folder, jobs, seconds of this call

  int mostSeeds() const { return seeds.value_or(figures.empty() ? 8 : 24); }
};

} // namespace grouser::sweeps
