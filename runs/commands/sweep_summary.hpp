// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/commands/sweep_plan.hpp"
#include "runs/output/run_status.hpp"

#include <filesystem>
#include <limits>
#include <string>
#include <vector>

namespace grouser::commands {

/// How one run of a sweep stands.
struct SweepOutcome {
  output::RunStatus status = output::RunStatus::pending;
  std::string message; ///< of a failed run
};

/// Time [s] from which a run counts as steady: the second half of what follows the drive's ramp (and the last time of a
/// speed table), NaN where the run ends before; without a vehicle the second half of the run.
/// `driveStart`: when the drive began [s]; NaN: as the scene says, at the earliest.
double steadyFrom(const scene::Scene& scene, double driveStart = std::numeric_limits<double>::quiet_NaN());

/// Writes summary.csv into `folder`: one row a run. Columns: run, the swept keys, status, message, what the run's
/// manifest says of it, and means and extremes over the steady part from its results.h5; cells without a number are
/// empty. Columns about a vehicle or about a surface stand there only where a run has it. Replaces the file at once.
/// Returns its path.
std::filesystem::path writeSummary(const SweepPlan& plan, const std::vector<SweepOutcome>& outcomes,
                                   const std::filesystem::path& folder);

} // namespace grouser::commands
