// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/campaigns/events/event_table.hpp"
#include "runs/campaigns/sweeps/run_series.hpp"
#include "runs/campaigns/sweeps/sweep_summary.hpp"

#include <string>
#include <vector>

/// Whether a run was a go.
namespace grouser::events {

/// What "go" asks for.
struct GoRule {
  double way = 5;       ///< [m] of level distance, the last before the course's end
  double share = 0.5;   ///< of the commanded speed, or rate of turn, in the mean over that way
  double time = 20;     ///< [s] from the beginning of the drive
  double mostRoll = 30; ///< [deg] of the hull against the ground's plane
};

struct Verdict {
  bool go = false;
  std::string why; ///< "5.0 m in 6.2 s", "rolls to 41 degrees": short, for a table
};

/// A run's motion since its drive began, from its time series.
struct Motion {
  std::vector<double> time;    ///< [s], 0 where the drive begins
  std::vector<double> way;     ///< [m] covered: along the x axis, or on a circle along the path
  std::vector<double> turned;  ///< [rad] of the heading, without jumps
  std::vector<double> left;    ///< [m] to the left of where the drive began
  std::vector<double> roll;    ///< [rad]
  std::vector<double> pitch;   ///< [rad]
  std::vector<double> upSpeed; ///< [m/s] of the hull along z
};
/// `alongPath`: the way is the path's length, not the progress along x. Rows before `driveStart` [s] are left out; no
/// rows where there are none behind it. Throws base::InputError where the series has no vehicle.
Motion motionOf(const sweeps::RunSeries& series, double driveStart, bool alongPath);

/// Of a run that has ended soundly.
Verdict judge(const Motion& motion, const Trial& trial, const GoRule& rule = {});

/// A run that ended with an error is a no-go where its vehicle has thrown a track or never came to rest, as on a slope
/// that it slides down; with any other error it says nothing of the vehicle, and `known` is false.
struct FailureVerdict {
  bool known = false;
  std::string why;
};
FailureVerdict judgeFailure(const sweeps::SweepOutcome& outcome);

/// Time at which a growing quantity first reaches `level`, straight between rows; NaN where it does not [s].
double timeAt(const std::vector<double>& time, const std::vector<double>& value, double level);

/// The greatest magnitude of some values; 0 of none.
double greatest(const std::vector<double>& values);

} // namespace grouser::events
