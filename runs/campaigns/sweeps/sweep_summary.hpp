// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/campaigns/sweeps/sweep_plan.hpp"
#include "runs/output/run_status.hpp"

#include <filesystem>
#include <limits>
#include <string>
#include <vector>

namespace grouser::sweeps {

class RunManifest;

/// How one run of a sweep stands.
struct SweepOutcome {
  output::RunStatus status = output::RunStatus::pending;
  std::string message; ///< reason why a run failed or is incomplete
  base::Cause cause{}; ///< cause of a failed simulation
};

/// Time [s] from which a run counts as steady: the second half of what follows the drive's ramp (and the last time of a
/// speed table), NaN where the run ends before; without a vehicle the second half of the run.
/// `driveStart`: when the drive began [s]; NaN: as the scene says, at the earliest. `end`: when the run has ended,
/// where [stop] may have ended it [s]; NaN: as the scene says.
double steadyFrom(const scene::Scene& scene, double driveStart = std::numeric_limits<double>::quiet_NaN(),
                  double end = std::numeric_limits<double>::quiet_NaN());
/// The same of a finished run, by what its manifest says of its drive and of its end.
double steadyFrom(const scene::Scene& scene, const RunManifest& manifest);

/// Figures of a sweep: means and extremes over the steady part of each run, from its results.h5.
struct SweepFigures {
  std::vector<std::string> columns;        ///< name and unit; of a vehicle or a surface only where a run has it
  std::vector<std::vector<double>> values; ///< [runs][columns]; NaN: none, as of every run that has not ended
  std::vector<std::string> inconclusive;   ///< [runs]: why its figures are, as over less than two teeth; empty: sound
  std::vector<std::string> turned; ///< [runs]: why those along the motion alone are: its direction changes; else empty

  /// Why figures of a run are inconclusive: all of them, or those that it names; empty where all are sound.
  std::string doubtOf(std::size_t run) const;
  /// Why the mean of these runs is inconclusive: none of those that have ended is sound. Else empty.
  std::string doubtOf(const std::vector<std::size_t>& runs) const;
  /// Leaves out what is inconclusive of these runs, where any of them is sound, and in any case means along a direction
  /// that changes.
  void keepSound(const std::vector<std::size_t>& runs);
};
SweepFigures sweepFigures(const SweepPlan& plan, const std::vector<SweepOutcome>& outcomes,
                          const std::filesystem::path& folder);

/// Writes summary.csv into `folder`: one row a run. Columns: run, the swept keys, status, message, why its figures are
/// inconclusive, what the run's manifest says of it, and its figures; cells without a number are empty. Replaces the
/// file at once. Returns its path.
std::filesystem::path writeSummary(const SweepPlan& plan, const std::vector<SweepOutcome>& outcomes,
                                   const std::filesystem::path& folder);

} // namespace grouser::sweeps
