// SPDX-License-Identifier: BSD-3-Clause
#include "scm/underside.hpp"

#include "base/math.hpp"

#include <algorithm>
#include <cmath>

namespace grouser::scm {

double breadthOf(const Solid& solid, const contact::PartMotion& motion) {
  int upright = 0; // the axis closest to the vertical
  for (int a = 1; a < 3; ++a)
    if (std::fabs(motion.rotation.m[2][a]) > std::fabs(motion.rotation.m[2][upright])) upright = a;
  const double one = solid.half[(upright + 1) % 3], other = solid.half[(upright + 2) % 3];
  if (solid.isBall || (solid.isRound && upright == 2)) return solid.half.x;
  return 2 * std::min(one, other);
}

Undersides::Undersides(const Solid& solid, const contact::PartMotion& motion)
    : solid_(solid), motion_(motion), up_(transposedTimes(motion.rotation, Vec3d{0, 0, 1})),
      near_(1e-9 * norm(solid.half)) {
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b) half_[a] += std::fabs(motion.rotation.m[a][b]) * solid.half[b];
}

std::optional<Underside> Undersides::lowestAt(double x, double y, double ceiling, double* clearance) const {
  constexpr int kSteps = 200; // a grazing line needs more steps, and counts as a miss
  const double bottom = motion_.origin.z - half_.z, height = std::min(2 * half_.z, ceiling - bottom);
  const Vec3d start = motion_.toPart({x, y, bottom});
  double climbed = 0, nearest = base::kInfinity;
  for (int k = 0; k < kSteps && climbed <= height; ++k) {
    const contact::SurfaceGap gap = solid_.gap(start + up_ * climbed);
    nearest = std::min(nearest, gap.distance);
    if (gap.distance <= near_) return Underside{bottom + climbed, motion_.rotation * gap.normal};
    climbed += gap.distance;
  }
  if (clearance) *clearance = 0.5 * nearest; // between two points the gap is >= half of the second one
  return {};
}

} // namespace grouser::scm
