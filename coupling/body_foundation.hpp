// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "contact/mixing.hpp"
#include "contact/patch_law.hpp"
#include "contact/surface_geometry.hpp"

#include <string>
#include <vector>

namespace grouser::coupling {

/// Contact foundations between the materials of bodies and of all rigid surfaces they may touch.
struct FoundationTable {
  std::vector<std::string> materials;    ///< bodies' materials first, in the order of BodyShape::material
  std::vector<contact::Foundation> laws; ///< [material of a body * materials.size() + any material]
  int ground{-1};                        ///< material of rigid terrain; -1: none
  std::vector<double> onVehicle; ///< [material of a body] friction on parts of the vehicle [-]; empty without a vehicle

  const contact::Foundation& between(int body, int other) const {
    return laws[static_cast<std::size_t>(body) * materials.size() + static_cast<std::size_t>(other)];
  }
  int indexOf(const std::string& material) const; ///< the material must be in the table
};

/// Maximum contact area of a shape on a plane [m2]: a face of a box, the end or a strip of a cylinder, a cap of a
/// sphere. Areas of strips and caps are those at an overlap of `overlap` [m].
double largestPatch(const contact::SurfaceGeometry& shape, double overlap);

/// Contact law of a shape. Damped as a whole, so that the restitution holds on any patch (contact/whole_contact.hpp).
contact::PatchLaw patchLaw(const contact::Foundation& foundation);

} // namespace grouser::coupling
