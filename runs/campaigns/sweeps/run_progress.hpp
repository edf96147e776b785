// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/campaigns/sweeps/sweep_plan.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

/// Progress of runs in other processes.
namespace grouser::sweeps {

/// Expected simulated time at the end of a run [s]; at most run.duration. Most runs with [stop] end earlier.
double expectedEnd(const SweepRun& run);

/// Relative work of a run in a sweep [grain s]: expectedEnd() times the number of grains; a vehicle counts as twenty
/// thousand grains. Ignores time steps and settling.
double workOf(const SweepRun& run);

/// Relative work of the steps of a run [grain steps]: workOf() over the time step.
double stepWorkOf(const SweepRun& run);

/// Simulated time of the last row in the folder [s]; 0 without rows.
double timeReached(const std::filesystem::path& folder);

/// Remaining wall time of runs, from the measured times of runs of the same kind: ground, contact method, precision and
/// whether there is a vehicle. The work of one kind does not predict the time of another.
class RunTimes {
public:
  /// Adds a run to do; returns its index. `kind` and `bed` are texts: runs with the same bed settle it only once.
  std::size_t add(const std::string& kind, const std::string& bed, double work);
  std::size_t add(const SweepRun& run);

  /// Start of a run that has already reached this share of its end, e.g. in an earlier call.
  void begin(std::size_t i, double share);
  /// A running run has reached this share [-], `wall` seconds after its start.
  void reach(std::size_t i, double share, double wall);
  /// End of a run: wall times of preparation, of settling (part of the preparation), and of its steps [s]; NaN:
  /// unknown.
  void end(std::size_t i, double preparation, double settling, double steps);

  /// Remaining wall time [s] with this number of concurrent runs; empty while a kind has no measured run.
  std::optional<double> left(int jobs) const;

private:
  struct Run {
    std::string kind, bed;
    double work = 0;
    bool hasBegun = false, hasEnded = false, isMeasured = false;
    double begin = 0, wall = 0;                                    ///< share at the start; time since then [s]
    double firstShare = -1, firstWall = 0, share = 0, shareAt = 0; ///< first row seen; last row seen, and its time
    double preparation = 0, settling = 0, steps = 0;               ///< [s] of an ended run
  };
  struct Rate {
    double perWork = 0;           ///< [s]
    double settled = 0, kept = 0; ///< preparation with and without settling [s]
  };
  std::optional<Rate> rateOf(const std::string& kind) const;
  std::vector<Run> runs_;
};

} // namespace grouser::sweeps
