// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/scene/scene.hpp"

#include <functional>
#include <string>
#include <vector>

namespace grouser::setup {

/// Time scale of a prescribed quantity, or period of a vehicle's spring. A run samples a prescribed quantity once per
/// step, so too few steps cause aliasing: a torque at 1001 Hz is constant at steps of 1 / 1001 s.
struct TimeScale {
  double time = 0;       ///< period, revolution, ramp, or gap between two times of a table [s]
  bool repeats = false;  ///< true for a period, revolution or oscillation
  std::string what;      ///< "a turn of 0.02 s"
  const char* unit = ""; ///< unit of the key
  /// Throws InputError at the key, with this message.
  std::function<void(const std::string& message)> fail;
};

/// Time scales that begin before the run ends: sines of drives and surfaces; revolutions of surfaces that are not
/// symmetric about the rotation axis, and of a vehicle's wheels and sprockets; gaps in the tables of drives and driver;
/// ramps of a surface's load and of the driver; oscillations of a vehicle's torsion bars, tensioner and its stops. Two
/// equal times in a table, and a ramp of 0 s, are a jump without a gap.
std::vector<TimeScale> timeScales(const scene::Scene& scene);

/// Maximum prescribed track speed relative to the hull [m/s]; 0 for prescribed torques. Requires a vehicle.
double greatestTrackSpeed(const scene::Scene& scene);

/// The longest step with run.steps_per_period steps in each time scale [s]; infinite without time scales.
double resolvingStep(const std::vector<TimeScale>& scales, double stepsPerPeriod);

/// Throws InputError if a time scale has fewer than run.steps_per_period steps of `timeStep`; the message states key,
/// number of steps and largest allowed step.
void checkTimeScales(const scene::Scene& scene, double timeStep);

/// Maximum rotation of a body or surface per step [rad]: one revolution in run.steps_per_period steps.
double largestTurn(const scene::RunSettings& run);

} // namespace grouser::setup
