// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/campaigns/sweeps/sweep_plan.hpp"
#include "runs/output/run_status.hpp"

#include <array>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

namespace grouser::sweeps {

class RunManifest;

/// Outcome of one run of a sweep.
struct SweepOutcome {
  output::RunStatus status = output::RunStatus::pending;
  std::string message; ///< reason why a run failed or is incomplete
  base::Cause cause{}; ///< cause of a failed simulation
};

/// Start of the steady part [s]: the second half of the time after the drive ramp (and after the last time of a speed
/// table); NaN if the run ends before; without a vehicle, the second half of the run. `driveStart`: start of the drive
/// [s]; NaN: earliest start in the scene. `end`: end of the run [s], e.g. by [stop]; NaN: run.duration.
double steadyFrom(const scene::Scene& scene, double driveStart = std::numeric_limits<double>::quiet_NaN(),
                  double end = std::numeric_limits<double>::quiet_NaN());
/// The same for a finished run, with start of the drive and end of the run from its manifest.
double steadyFrom(const scene::Scene& scene, const RunManifest& manifest);

/// Figures of a sweep: means and extremes over the steady part of each run, from its results.h5. With a vehicle, they
/// are taken over a whole number of sprocket teeth (to within one row) at the end of the steady part.
struct SweepFigures {
  std::vector<std::string> columns;              ///< names with units; vehicle and surfaces only if a run has them
  std::vector<std::vector<double>> values;       ///< [runs][columns]; NaN: none, e.g. unfinished runs
  std::vector<double> from;                      ///< [runs] start of the means [s]; NaN: none
  std::vector<std::array<double, 2>> speedRange; ///< [runs] minimum and maximum hull speed in this interval [m/s]
  std::vector<std::string> inconclusive;         ///< [runs] reason, e.g. fewer than two teeth; empty: valid
  std::vector<std::string> turned;               ///< [runs] reason if the direction of motion changes; else empty

  /// Reason why all figures of a run, or the named ones, are inconclusive; empty if all are valid.
  std::string doubtOf(std::size_t run) const;
  /// Reason why the mean of these runs is inconclusive, i.e. no finished run is valid; else empty.
  std::string doubtOf(const std::vector<std::size_t>& runs) const;
  /// Removes inconclusive figures of these runs if any run is valid, and all means along a changing direction of
  /// motion.
  void dropInconclusive(const std::vector<std::size_t>& runs);
};
SweepFigures sweepFigures(const SweepPlan& plan, const std::vector<SweepOutcome>& outcomes,
                          const std::filesystem::path& folder);

/// Writes summary.csv into `folder`: one row per run. Columns: run, swept keys, status, message, reason for
/// inconclusive figures, data of the manifest, and figures; cells without a value are empty. Replaces the file
/// atomically. Returns the path.
std::filesystem::path writeSummary(const SweepPlan& plan, const std::vector<SweepOutcome>& outcomes,
                                   const std::filesystem::path& folder);

} // namespace grouser::sweeps
