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

/// Maximum overlap [m] of a shape on a plane under `load` [N], over its faces, strips and caps.
double restingOverlap(const contact::SurfaceGeometry& shape, double modulus, double load);

/// Contact law of a shape with its own mass [kg]. The relaxation reproduces the restitution for small bounces of the
/// free shape about its rest on a plane under `gravity` [m/s2], on a patch of mean stiffness. Larger faces, and
/// stronger impacts of curved shapes, dissipate more; strips, edges and corners dissipate less.
contact::PatchLaw patchLaw(const contact::Foundation& foundation, const contact::SurfaceGeometry& shape, double mass,
                           double gravity);

} // namespace grouser::coupling
