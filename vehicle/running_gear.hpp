// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "vehicle/spec.hpp"

#include <optional>
#include <string>

namespace grouser::vehicle {

/// Error of a vehicle file at one of its keys.
struct SpecFault {
  std::string section, key;
  std::string message; ///< overlapping parts, overlap in millimetres, and a tested remedy
};

/// Returns the first error of an impossible running gear: overlapping parts, shoes that cannot fold about a wheel, a
/// loop that does not close, wheels outside the loop, or a suspension or tensioner without equilibrium. Empty for a
/// valid vehicle. Uses only the dimensions in the spec, in the plane of a track.
std::optional<SpecFault> runningGearFault(const VehicleSpec& spec);

} // namespace grouser::vehicle
