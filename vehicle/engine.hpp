// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "vehicle/spec.hpp"

namespace grouser::vehicle {

/// Torque of an engine at full load [N m] at a speed of its shaft [rad/s]: linear between the points of its curve,
/// constant outside them.
double fullLoadTorque(const EngineSpec& engine, double speed);

/// Torque on a sprocket [N m], forward positive, at `speed` with the governor set to `wanted` [rad/s]. With the droop
/// d, both speeds at the engine shaft, and w the smaller of wanted and governed speed,
///   throttle = (w - speed) / d, held to [-1, 1];
/// a throttle towards w drives with its share of the full load, times ratio and efficiency; one against it, and any at
/// w = 0, brakes with its share of the brake's torque. Under a load L within its capacity it is slower than commanded
/// by d L / (full load at the sprocket).
double engineTorque(const EngineSpec& engine, double wanted, double speed);

/// The same without a governor, at a given throttle from -1 to 1: it drives with its share of the full load, forward if
/// positive; against the sprocket's rotation it brakes with its share of the brake torque.
double throttleTorque(const EngineSpec& engine, double throttle, double speed);

/// Steepest slope of that torque over sprocket speed [N m s/rad]: with the driven inertia it defines a time constant
/// that the step must resolve.
double governorSlope(const EngineSpec& engine);

} // namespace grouser::vehicle
