// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/campaigns/events/event_table.hpp"
#include "runs/campaigns/sweeps/run_series.hpp"
#include "runs/campaigns/sweeps/sweep_summary.hpp"

#include <optional>
#include <string>
#include <vector>

/// Go/no-go verdict of a run.
namespace grouser::events {

struct Verdict {
  bool go = false;
  std::string why;           ///< "5.0 m in 6.2 s", "rolls to 41 degrees"
  bool isIncomplete = false; ///< the run ended while the vehicle still drove at the required speed
};

/// Motion of a run after the start of its drive, from its time series.
struct Motion {
  std::vector<double> time;    ///< [s] since the start of the drive
  std::vector<double> way;     ///< [m] travelled: along the x axis, or on a circle along the controlled point's path
  std::vector<double> turned;  ///< [rad] unwrapped heading change
  std::vector<double> left;    ///< [m] lateral displacement, left positive
  std::vector<double> roll;    ///< [rad]
  std::vector<double> pitch;   ///< [rad]
  std::vector<double> upSpeed; ///< [m/s] velocity of the hull along z
};
/// `onPath`: point of the hull (relative to the sprocket axle) whose path is the distance travelled; empty: distance of
/// the sprocket axle along x. Excludes rows before `driveStart` [s]; may have no rows. Throws base::InputError if the
/// series has no vehicle.
Motion motionOf(const sweeps::RunSeries& series, double driveStart, const std::optional<SidePoint>& onPath);

/// Changes over the second half of a motion, in which a circle is steady.
struct LateMotion {
  double way = 0, turned = 0, seconds = 0;             ///< [m], [rad], [s]
  double radius() const { return way / turned; }       ///< [m] positive to the left
  double turnRate() const { return turned / seconds; } ///< [rad/s]
};
LateMotion lateMotion(const Motion& motion);

/// Verdict of a run that ended without an error.
Verdict judge(const Motion& motion, const Trial& trial, const GoRule& rule = {});

/// Verdict of a failed run: no-go if the vehicle threw a track or never came to rest, e.g. as it slid down a slope;
/// `known` is false for errors unrelated to the vehicle.
struct FailureVerdict {
  bool known = false;
  std::string why;
};
FailureVerdict judgeFailure(const sweeps::SweepOutcome& outcome);

/// Time [s] at which an increasing quantity first reaches `level`, interpolated between rows; NaN if it never does.
double timeAt(const std::vector<double>& time, const std::vector<double>& value, double level);

/// Maximum absolute value; 0 if `values` is empty.
double greatest(const std::vector<double>& values);

} // namespace grouser::events
