// SPDX-License-Identifier: BSD-3-Clause
#include "terrain/bed_plan.hpp"

#include "base/error.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace grouser::terrain {

double clearHeight(const HeightField& floor, double x, double y, double z, double radius) {
  const HeightFieldBounds around = floor.boundsOver({x - radius, x + radius, y - radius, y + radius});
  const double safe = around.highest + radius;
  if (z >= safe) return z;
  // In a hollow tighter than the sphere the foot point is not unique: stay above the whole hollow.
  if (around.valleyCurvature * radius >= 1) return safe;

  // Newton's method on the distance; its derivative along z is the z component of the normal.
  const HeightFieldView view = floor.view();
  const SurfaceJet s = view.jet(x, y);
  double contact = s.h + radius * std::sqrt(1 + s.hx * s.hx + s.hy * s.hy);
  for (int k = 0; k < 8; ++k) {
    const FootPoint foot = view.closestPoint({x, y, contact});
    const double lack = radius - foot.distance;
    if (std::fabs(lack) <= 1e-9 * radius) return std::max(z, contact);
    contact += lack / foot.normal.z;
  }
  return safe;
}

void requireOfBed(bool ok, const char* key, double value, const char* range) {
  if (!ok) throw base::InputError(fmt::format("bed of grains: {} = {} is outside {}", key, value, range));
}

} // namespace grouser::terrain
