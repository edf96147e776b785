// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "vehicle/spec.hpp"

#include <optional>
#include <string>

namespace grouser::vehicle {

/// What is wrong with a vehicle file, and at which of its keys.
struct SpecFault {
  std::string section, key;
  std::string message; ///< what overlaps, by how many millimetres, and a value that was tried and mends it
};

/// The first thing that makes a running gear impossible: parts that overlap, shoes that cannot fold about a wheel, a
/// loop that does not close, wheels outside it, a suspension or tensioner without equilibrium. Judged by the spec's
/// numbers alone, in the plane of a track; empty for a sound vehicle.
std::optional<SpecFault> runningGearFault(const VehicleSpec& spec);

} // namespace grouser::vehicle
