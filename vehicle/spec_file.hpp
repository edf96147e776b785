// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "vehicle/running_gear.hpp"
#include "vehicle/spec.hpp"
#include "vehicle/spec_source.hpp"

#include <string>
#include <vector>

namespace grouser::vehicle {

/// Reads a vehicle file and applies the changed keys. Throws base::InputError (file:line, key, value, range) for
/// unknown, missing or out-of-range keys, and for an impossible running gear (runningGearFault).
VehicleSpec readVehicleSpec(const SpecSource& source);
/// Notes on values outside the usual span of their key (base::Document::unusual()). Throws as readVehicleSpec() does,
/// but does not check the running gear.
std::vector<base::UnusualValue> unusualSpecValues(const SpecSource& source);

/// Throws a fault in a spec file as base::InputError, with its location.
[[noreturn]] void refuse(const SpecSource& source, const SpecFault& fault);
/// Throws InputError for an unusable mesh of a section; `why`: reason.
[[noreturn]] void refuseMesh(const SpecSource& source, const std::string& section, const std::string& why);

/// A section of a vehicle spec file and its keys.
struct SpecSection {
  std::string name;
  std::vector<base::Field> fields;
};
/// All sections, in the order of the documentation.
std::vector<SpecSection> specSections();

/// Names of all keys, e.g. "shoe.count", each with the prefix `before`.
std::vector<std::string> specKeys(const std::string& before = "");

/// Markdown tables of all keys of a vehicle spec file, with unit, range and meaning.
std::string specFieldHelp();

} // namespace grouser::vehicle
