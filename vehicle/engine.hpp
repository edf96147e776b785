// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "vehicle/spec.hpp"

namespace grouser::vehicle {

/// Full-load torque of an engine [N m] at a shaft speed [rad/s]: linear between the points of its curve, constant
/// outside them.
double fullLoadTorque(const EngineSpec& engine, double speed);

/// Governed torque on a sprocket [N m], forward positive, at `speed` with the commanded speed `wanted` [rad/s]. With
/// the droop d, both speeds at the engine shaft, and w the smaller of commanded and governed speed,
///   throttle = (w - speed) / d, clamped to [-1, 1];
/// a throttle towards w drives with that fraction of the full load, times ratio and efficiency; a throttle against w,
/// and any at w = 0, brakes with that fraction of the brake torque. Under a load L within its capacity the sprocket is
/// slower than commanded by d L / (full load at the sprocket).
double engineTorque(const EngineSpec& engine, double wanted, double speed);

/// Torque without a governor, at a throttle from -1 to 1: drives with that fraction of the full load, forward if
/// positive; against the sprocket's rotation it brakes with that fraction of the brake torque.
double throttleTorque(const EngineSpec& engine, double throttle, double speed);

/// Maximum slope of that torque over sprocket speed [N m s/rad]: with the driven inertia it defines a time constant
/// that the time step must resolve.
double governorSlope(const EngineSpec& engine);

} // namespace grouser::vehicle
