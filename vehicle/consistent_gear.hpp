// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "vehicle/spec.hpp"

#include <functional>
#include <string>

namespace grouser::vehicle {

/// Returns keys with values that together make a running gear `sound`, if no single key does: "road_wheel.count = 6,
/// road_wheel.spacing = 0.3874, ..., roller.z = [0.1283, 0.13, 0.1317]". Keeps the number of road wheels and, if
/// possible, of shoes; moves idler, road wheels and rollers. Empty if no such values were found.
std::string consistentKeys(const VehicleSpec& spec, const std::function<bool(const VehicleSpec&)>& sound);

} // namespace grouser::vehicle
