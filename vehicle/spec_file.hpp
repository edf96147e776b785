// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "vehicle/running_gear.hpp"
#include "vehicle/spec.hpp"

#include <string>

namespace grouser::vehicle {

/// Read a vehicle spec file. Throws base::InputError (file:line, key, value, range) on anything unknown, missing or
/// out of range, and where the running gear is impossible (runningGearFault).
VehicleSpec readVehicleSpec(const std::string& path);

/// Throws a fault that was found in a spec file as base::InputError with its place there.
[[noreturn]] void refuse(const std::string& path, const SpecFault& fault);
/// The same of the mesh that a section names and that cannot be had: `why`.
[[noreturn]] void refuseMesh(const std::string& path, const std::string& section, const std::string& why);

/// All keys of a vehicle spec file with unit, range and meaning, as Markdown.
std::string specFieldHelp();

} // namespace grouser::vehicle
