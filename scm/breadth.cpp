// SPDX-License-Identifier: BSD-3-Clause
#include "scm/breadth.hpp"

#include <algorithm>
#include <cmath>

namespace grouser::scm {

namespace {

constexpr double kTouch = 1e-3; // gap between solids that counts as contact [size]
constexpr double kLevel = 0.05; // difference of undersides that counts as level [width]

/// Bounding box along the axes of a part.
struct Extent {
  Vec3d low, high;
};

Extent extentIn(const contact::PartMotion& frame, const Solid& solid, const contact::PartMotion& motion) {
  const Vec3d centre = frame.toPart(motion.origin);
  Vec3d half;
  for (int a = 0; a < 3; ++a) {
    Vec3d axis;
    axis[a] = solid.half[a];
    const Vec3d inFrame = transposedTimes(frame.rotation, motion.rotation * axis);
    for (int b = 0; b < 3; ++b) half[b] += std::fabs(inFrame[b]);
  }
  return {centre - half, centre + half};
}

/// Axis of a part that is closest to the vertical.
int uprightOf(const contact::PartMotion& motion) {
  int upright = 0;
  for (int a = 1; a < 3; ++a)
    if (std::fabs(motion.rotation.m[2][a]) > std::fabs(motion.rotation.m[2][upright])) upright = a;
  return upright;
}

/// True if `other` touches a solid, and has its underside at the same level, seen in the frame of the solid.
bool adjoins(const Solid& solid, const contact::PartMotion& frame, const Solid& other,
             const contact::PartMotion& motion) {
  const Extent e = extentIn(frame, other, motion);
  const int upright = uprightOf(frame);
  const double size = std::min(norm(solid.half), norm(other.half));
  for (int a = 0; a < 3; ++a)
    if (e.low[a] > solid.half[a] + kTouch * size || e.high[a] < -solid.half[a] - kTouch * size) return false;
  const bool isUp = frame.rotation.m[2][upright] > 0;
  const double level = isUp ? e.low[upright] + solid.half[upright] : solid.half[upright] - e.high[upright];
  return std::fabs(level) <= kLevel * std::min(breadthOf(solid, frame), breadthOf(other, motion));
}

} // namespace

double breadthOf(const Solid& solid, const contact::PartMotion& motion) {
  const int upright = uprightOf(motion);
  const double one = solid.half[(upright + 1) % 3], other = solid.half[(upright + 2) % 3];
  if (solid.isBall || (solid.isRound && upright == 2)) return solid.half.x;
  return 2 * std::min(one, other);
}

std::vector<double> breadthsOf(const Solid* solids, std::size_t count, const contact::PartMotion* motion) {
  std::vector<double> breadths;
  std::vector<std::size_t> plate(count); // lowest index of the solids that form one plate
  for (std::size_t s = 0; s < count; ++s)
    breadths.push_back(breadthOf(solids[s], motion[solids[s].part])), plate[s] = s;
  for (std::size_t a = 0; a < count; ++a)
    for (std::size_t b = 0; b < a; ++b) {
      const contact::PartMotion &one = motion[solids[a].part], &other = motion[solids[b].part];
      if (plate[a] == plate[b] || !adjoins(solids[a], one, solids[b], other) ||
          !adjoins(solids[b], other, solids[a], one))
        continue;
      const std::size_t from = std::max(plate[a], plate[b]), to = std::min(plate[a], plate[b]);
      std::replace(plate.begin(), plate.end(), from, to);
    }
  for (std::size_t p = 0; p < count; ++p) {
    const auto volume = [&](std::size_t s) { return solids[s].half.x * solids[s].half.y * solids[s].half.z; };
    std::size_t largest = count, members = 0;
    for (std::size_t s = 0; s < count; ++s)
      if (plate[s] == p && (++members, largest == count || volume(s) > volume(largest))) largest = s;
    if (members < 2) continue;
    const contact::PartMotion& frame = motion[solids[largest].part];
    const Vec3d half = solids[largest].half;
    Vec3d low = -half, high = half;
    for (std::size_t s = 0; s < count; ++s) {
      if (plate[s] != p) continue;
      const Extent e = extentIn(frame, solids[s], motion[solids[s].part]);
      low = min(low, e.low), high = max(high, e.high);
    }
    const int upright = uprightOf(frame), u = (upright + 1) % 3, v = (upright + 2) % 3;
    const double sideU = high[u] - low[u], sideV = high[v] - low[v];
    const bool isWider = sideU > 2 * half[u] * (1 + kTouch) || sideV > 2 * half[v] * (1 + kTouch);
    const double breadth = isWider ? std::min(sideU, sideV) : breadths[largest];
    for (std::size_t s = 0; s < count; ++s)
      if (plate[s] == p) breadths[s] = breadth;
  }
  return breadths;
}

} // namespace grouser::scm
