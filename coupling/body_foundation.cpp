// SPDX-License-Identifier: BSD-3-Clause
#include "coupling/body_foundation.hpp"

#include "base/math.hpp"
#include "contact/restitution.hpp"

#include <algorithm>
#include <cmath>

namespace grouser::coupling {

using base::Vec3d;
using contact::SurfaceGeometry;
using contact::SurfaceShape;

int FoundationTable::indexOf(const std::string& material) const {
  return static_cast<int>(std::find(materials.begin(), materials.end(), material) - materials.begin());
}

double largestPatch(const SurfaceGeometry& g, double overlap) {
  const Vec3d& h = g.half;
  if (g.shape == SurfaceShape::box) return 4 * std::max({h.x * h.y, h.x * h.z, h.y * h.z});
  const double strip = 4 * h.z * std::sqrt(2 * h.x * overlap), cap = 2 * base::kPi * h.x * overlap;
  if (g.shape == SurfaceShape::capsule) return strip + cap;
  return std::max(strip, base::kPi * h.x * h.x);
}

contact::PatchLaw patchLaw(const contact::Foundation& f) {
  return {f.modulus, 0, f.friction, f.tangentialRatio, contact::dampingRatioFor(f.restitution, false)};
}

} // namespace grouser::coupling
