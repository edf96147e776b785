// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "vehicle/spec.hpp"

#include <functional>
#include <string>

namespace grouser::vehicle {

/// Keys that together make a running gear `sound` where no single one does, to be pasted as they are:
/// "road_wheel.count = 6, road_wheel.spacing = 0.3874, ..., roller.z = [0.1283, 0.13, 0.1317]". Keeps the number of
/// road wheels, and that of shoes where it can; places idler, road wheels and rollers anew. Empty where nothing was
/// found.
std::string consistentKeys(const VehicleSpec& spec, const std::function<bool(const VehicleSpec&)>& sound);

} // namespace grouser::vehicle
