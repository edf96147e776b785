// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "vehicle/running_gear.hpp"
#include "vehicle/spec.hpp"
#include "vehicle/spec_source.hpp"

#include <string>
#include <vector>

namespace grouser::vehicle {

/// Read a vehicle spec file, with the keys that are changed in it. Throws base::InputError (file:line, key, value,
/// range) on anything unknown, missing or out of range, and where the running gear is impossible (runningGearFault).
VehicleSpec readVehicleSpec(const SpecSource& source);

/// Throws a fault that was found in a spec file as base::InputError with its place there.
[[noreturn]] void refuse(const SpecSource& source, const SpecFault& fault);
/// The same of the mesh that a section names and that cannot be had: `why`.
[[noreturn]] void refuseMesh(const SpecSource& source, const std::string& section, const std::string& why);

/// A section of a vehicle spec file and its keys.
struct SpecSection {
  std::string name;
  std::vector<base::Field> fields;
};
/// All of them, in the order in which they are described.
std::vector<SpecSection> specSections();

/// Their keys, as "shoe.count", with a text before each.
std::vector<std::string> specKeys(const std::string& before = "");

/// All keys of a vehicle spec file with unit, range and meaning, as Markdown.
std::string specFieldHelp();

} // namespace grouser::vehicle
