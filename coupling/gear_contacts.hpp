// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "vehicle/assembly.hpp"

#include <cstdint>
#include <vector>

namespace grouser::coupling {

/// Contacts of grains with a vehicle at one time: grain-part pairs by kind of part, and single grains.
struct GearContacts {
  std::int64_t shoes{}, sprockets{}, roadWheels{}, rollers{}, idlers{}, hull{};
  std::int64_t stones{};  ///< grains in contact with a sprocket, road wheel, roller or idler
  std::int64_t pinched{}; ///< stones also in contact with a shoe
};

/// Grain in contact with a part of an assembly.
struct TouchedPart {
  std::uint32_t grain{};
  vehicle::PartKind kind{};
};

/// Counts the contacts. `touches`: ascending by grain.
GearContacts countGear(const std::vector<TouchedPart>& touches);

} // namespace grouser::coupling
