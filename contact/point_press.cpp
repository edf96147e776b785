// SPDX-License-Identifier: BSD-3-Clause
#include "contact/point_press.hpp"

namespace grouser::contact {

GROUSER_SIMD_CLONES void pressBlock(const PointBlock& block, const PointPress& press, const Vec3P& normal,
                                    const PointLanes& overlap, PressureLanes& sums) {
  const Vec3P x = block.place - normal * (block.radius - overlap * 0.5);
  sums.add(press.law, press.timeStep, allLanes(press.motion), x, normal, overlap, block.area);
}

GROUSER_SIMD_CLONES PatchPressure sumOf(const PressureLanes& sums) { return sums.sum(); }

/// PressureLanes::add() for points with a common normal, which needs only force magnitudes and positions.
GROUSER_SIMD_CLONES PatchPressure pressOnPlane(const std::vector<const PointBlock*>& blocks, const PointPress& press,
                                               const base::Vec3d& n, double height) {
  const Vec3P normal = allLanes(n), turning = allLanes(cross(n, press.motion.spin));
  const double leaving = dot(press.motion.velocity, n);
  PressureLanes sums;
  sums.clear();
  for (const PointBlock* block : blocks) {
    const PointLanes overlap = block->radius - (dot(normal, block->place) - height);
    const Vec3P x = block->place - normal * (block->radius - overlap * 0.5);
    sums.addSize(press.law, press.timeStep, x, overlap, block->area, dot(turning, x) + leaving);
  }
  PatchPressure sum = sums.sum();
  sum.force = n * sum.weight;
  sum.torque = cross(sum.place, n);
  return sum;
}

} // namespace grouser::contact
