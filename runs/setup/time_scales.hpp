// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/scene/scene.hpp"

#include <functional>
#include <string>
#include <vector>

namespace grouser::setup {

/// Time scale of a prescribed quantity: a run samples it once per step and aliases it with too few steps (100 N m at
/// 1001 Hz are a constant torque at steps of 1 / 1001 s). Also an oscillation of a vehicle's springs.
struct TimeScale {
  double time = 0;       ///< period or turn, or the gap between two times of a table or ramp [s]
  bool repeats = false;  ///< true for a period, turn or oscillation
  std::string what;      ///< "a turn of 0.02 s"
  const char* unit = ""; ///< unit of the key
  /// Throws InputError at the key, with this message.
  std::function<void(const std::string& message)> fail;
};

/// Time scales that begin before the run ends: sines of drives and surfaces; turns of surfaces without symmetry about
/// their own axis, and of a vehicle's wheels and sprockets; gaps in the tables of drives and driver; ramps of a
/// surface's load and of the driver; oscillations of a vehicle's torsion bars, tensioner and its stops. Two equal times
/// in a table, and a ramp of 0 s, are a jump without a gap.
std::vector<TimeScale> timeScales(const scene::Scene& scene);

/// Maximum prescribed track speed relative to the hull [m/s]; 0 if it sets torques. Requires a vehicle.
double greatestTrackSpeed(const scene::Scene& scene);

/// The longest step with run.steps_per_period steps in each time scale [s]; infinite without time scales.
double resolvingStep(const std::vector<TimeScale>& scales, double stepsPerPeriod);

/// Throws InputError if a time scale has fewer than run.steps_per_period steps of `timeStep`; the message states key,
/// number of steps and largest allowed step.
void checkTimeScales(const scene::Scene& scene, double timeStep);

/// Maximum rotation of a body or surface in a step [rad]: a full turn in run.steps_per_period steps.
double largestTurn(const scene::RunSettings& run);

} // namespace grouser::setup
