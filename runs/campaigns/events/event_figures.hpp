// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/campaigns/events/event_verdict.hpp"

#include <string>
#include <vector>

/// What an event's run has measured, beside its verdict.
namespace grouser::events {

struct Figure {
  std::string name; ///< with its unit
  double value = 0;
};

/// Of the event drawbar: the mean over the second half of the drive.
inline constexpr const char* kPull = "drawbar pull [N]";

/// Figures of an event from a run's motion and time series; `driveStart` [s] as in motionOf().
std::vector<Figure> figuresOf(Event event, const Motion& motion, const sweeps::RunSeries& series, double driveStart,
                              const Trial& trial, const Course& course);

/// Fourth-order Butterworth low-pass, forward only, of values `dt` [s] apart; cutoff [Hz] below half of 1 / dt.
std::vector<double> lowPass(const std::vector<double>& values, double dt, double cutoff);

/// Moment that resists a turn on the spot: friction on an evenly loaded ground run in the direction in which each place
/// of it slips: sideways with rate x, along with `slipSpeed` [m/s]. mu W L / 4 where slipSpeed is 0 [N m].
double turningMoment(const VehicleShape& shape, double friction, double weight, double rate, double slipSpeed);

} // namespace grouser::events
