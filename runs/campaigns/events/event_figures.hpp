// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/campaigns/events/event_verdict.hpp"

#include <string>
#include <vector>

/// Measured figures of a run of an event.
namespace grouser::events {

struct Figure {
  std::string name; ///< with its unit
  double value = 0;
};

/// Figure of the event drawbar: mean over the second half of the drive.
inline constexpr const char* kPull = "drawbar pull [N]";

/// Figures of an event from a run's motion and time series; `driveStart` [s] as in motionOf().
std::vector<Figure> figuresOf(Event event, const Motion& motion, const sweeps::RunSeries& series, double driveStart,
                              const Trial& trial, const Course& course);

/// Fourth-order Butterworth low-pass filter, forward only, of values at intervals `dt` [s]; cutoff [Hz] < 0.5 / dt.
std::vector<double> lowPass(const std::vector<double>& values, double dt, double cutoff);

/// Turning resistance moment of a pivot turn [N m]: uniform pressure over the contact length; friction opposes the
/// local slip velocity, rate x laterally and `slipSpeed` [m/s] longitudinally. Equals mu W L / 4 if slipSpeed is 0.
double turningMoment(const VehicleShape& shape, double friction, double weight, double rate, double slipSpeed);

} // namespace grouser::events
