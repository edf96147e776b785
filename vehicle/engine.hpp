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
/// a throttle with the sign of w drives with this fraction of the full-load torque, times ratio and efficiency; a
/// throttle of opposite sign, and any throttle at w = 0, brakes with this fraction of the brake torque. A load L below
/// full load slows the sprocket by d L / (full load at the sprocket) relative to the commanded speed.
double engineTorque(const EngineSpec& engine, double wanted, double speed);

/// Torque on a sprocket without a governor, at a throttle from -1 to 1: drives with this fraction of the full-load
/// torque, forward if positive; against the rotation of the sprocket, brakes with this fraction of the brake torque.
double throttleTorque(const EngineSpec& engine, double throttle, double speed);

/// Maximum slope of the torque over sprocket speed [N m s/rad]. Inertia / slope is a time constant that the time step
/// must resolve.
double governorSlope(const EngineSpec& engine);

} // namespace grouser::vehicle
