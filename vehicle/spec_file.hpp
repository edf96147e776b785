// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "vehicle/spec.hpp"

#include <string>

namespace grouser::vehicle {

/// Read a vehicle spec file. Throws base::InputError (file:line, key, value, range) on anything unknown, missing or
/// out of range.
VehicleSpec readVehicleSpec(const std::string& path);

/// All keys of a vehicle spec file with unit, range and meaning, as Markdown.
std::string specFieldHelp();

} // namespace grouser::vehicle
