// SPDX-License-Identifier: BSD-3-Clause
#include "coupling/gear_contacts.hpp"

#include <cstddef>

namespace grouser::coupling {

using vehicle::PartKind;

GearContacts countGear(const std::vector<TouchedPart>& touches) {
  GearContacts counts;
  for (std::size_t i = 0; i < touches.size();) {
    bool shoe = false, inner = false;
    const std::uint32_t grain = touches[i].grain;
    for (; i < touches.size() && touches[i].grain == grain; ++i) {
      const PartKind kind = touches[i].kind;
      shoe = shoe || kind == PartKind::kShoe;
      inner = inner || (kind != PartKind::kShoe && kind != PartKind::kChassis);
      switch (kind) {
      case PartKind::kShoe:
        ++counts.shoes;
        break;
      case PartKind::kSprocket:
        ++counts.sprockets;
        break;
      case PartKind::kRoadWheel:
        ++counts.roadWheels;
        break;
      case PartKind::kRoller:
        ++counts.rollers;
        break;
      case PartKind::kIdler:
        ++counts.idlers;
        break;
      case PartKind::kChassis:
        ++counts.hull;
        break;
      }
    }
    if (inner) ++counts.stones;
    if (inner && shoe) ++counts.pinched;
  }
  return counts;
}

} // namespace grouser::coupling
