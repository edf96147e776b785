// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "vehicle/assembly.hpp"

#include <cstdint>
#include <vector>

namespace grouser::coupling {

/// Contacts of grains with a vehicle at one time: pairs of grain and part by the part's kind, and single grains.
struct GearContacts {
  std::int64_t shoes{}, sprockets{}, roadWheels{}, rollers{}, idlers{}, hull{};
  std::int64_t stones{};  ///< grains that touch a sprocket, road wheel, roller or idler
  std::int64_t pinched{}; ///< those of them that touch a shoe too
};

/// A grain that touches a part of an assembly.
struct TouchedPart {
  std::uint32_t grain{};
  vehicle::PartKind kind{};
};

/// `touches`: ascending by grain.
GearContacts countGear(const std::vector<TouchedPart>& touches);

} // namespace grouser::coupling
