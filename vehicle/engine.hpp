// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "vehicle/spec.hpp"

namespace grouser::vehicle {

/// Torque of an engine at full load [N m] at a speed of its shaft [rad/s]: linear between the points of its curve,
/// constant outside them.
double fullLoadTorque(const EngineSpec& engine, double speed);

/// Torque on a sprocket [N m], forward positive, that turns at `speed` while the governor is to hold `wanted`
/// [rad/s]. With the droop d and both speeds taken at the engine's shaft, w for the smaller of wanted and governed
/// speed,
///   throttle = (w - speed) / d, held to [-1, 1];
/// a throttle towards w drives with its share of the full load, times ratio and efficiency; one against it, and any at
/// w = 0, brakes with its share of the brake's torque. Under a load L that the engine bears it therefore turns slower
/// than asked by d L / (full load at the sprocket).
double engineTorque(const EngineSpec& engine, double wanted, double speed);

/// The same without a governor, at a throttle that is given, -1 to 1: it drives with its share of the full load,
/// forward where positive; against the way the sprocket turns it brakes with its share of the brake's torque.
double throttleTorque(const EngineSpec& engine, double throttle, double speed);

/// The steepest slope of that torque over the sprocket's speed [N m s/rad]: together with the inertia that it turns it
/// makes the time that a step must resolve.
double governorSlope(const EngineSpec& engine);

} // namespace grouser::vehicle
