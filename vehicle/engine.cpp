// SPDX-License-Identifier: BSD-3-Clause
#include "vehicle/engine.hpp"

#include <algorithm>
#include <cmath>

namespace grouser::vehicle {

double fullLoadTorque(const EngineSpec& engine, double speed) {
  const std::vector<double>&at = engine.speed, &torque = engine.torque;
  if (speed <= at.front()) return torque.front();
  for (std::size_t i = 1; i < at.size(); ++i)
    if (speed < at[i]) return torque[i - 1] + (torque[i] - torque[i - 1]) * ((speed - at[i - 1]) / (at[i] - at[i - 1]));
  return torque.back();
}

namespace {

/// Torque on the sprocket of a driving engine, in the gear for `forwards` or backwards.
double driveTorque(const EngineSpec& engine, double throttle, bool forwards, double speed) {
  // If the sprocket rotates against the gear, the torque at zero engine speed applies.
  const double shaft = forwards ? speed * engine.ratio : -speed * engine.ratio;
  return throttle * engine.ratio * engine.efficiency * fullLoadTorque(engine, std::max(0.0, shaft));
}

} // namespace

double engineTorque(const EngineSpec& engine, double wanted, double speed) {
  const double most = engine.governedSpeed / engine.ratio, w = std::clamp(wanted, -most, most);
  const double throttle = std::clamp((w - speed) * engine.ratio / engine.droop, -1.0, 1.0);
  if (w == 0 || throttle * w < 0) return throttle * engine.brakeTorque;
  return driveTorque(engine, throttle, w > 0, speed);
}

double throttleTorque(const EngineSpec& engine, double throttle, double speed) {
  if (throttle * speed < 0) return throttle * engine.brakeTorque;
  return driveTorque(engine, throttle, throttle > 0, speed);
}

double governorSlope(const EngineSpec& engine) {
  const double peak = *std::max_element(engine.torque.begin(), engine.torque.end());
  return std::max(engine.ratio * engine.efficiency * peak, engine.brakeTorque) * engine.ratio / engine.droop;
}

} // namespace grouser::vehicle
