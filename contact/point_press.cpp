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

namespace {

/// Area with a rocking share.
GROUSER_SIMD PointLanes flatArea(const FoundationPress& press, const PointBlock& block, const PointLanes& touching) {
  const PointLanes& z = block.place.z;
  return greater(z, -z) > allLanes(press.flatWithin) ? allLanes(0) : touching;
}

} // namespace

GROUSER_SIMD_CLONES void addFoundation(const PointBlock& block, const FoundationPress& press, const Vec3P& normal,
                                       const PointLanes& overlap, FoundationLanes& sums) {
  const Vec3P x = block.place - normal * (block.radius - overlap * 0.5), turn = cross(x, normal);
  const PointLanes touching = overlap > allLanes(0) ? block.area : allLanes(0);
  const PointLanes volume = sums.addElastic(x, overlap, touching);
  sums.force += normal * volume, sums.torque += turn * volume;
  const RelativeMotion<PointLanes> motion = allLanes(press.motion);
  const PointLanes flat = flatArea(press, block, touching);
  const PointLanes moved = flat * dot(motion.velocity + cross(motion.spin, x), normal);
  sums.rocking += flat, sums.normals += normal * flat, sums.turns += turn * flat;
  sums.rated += normal * moved, sums.ratedTurns += turn * moved;
}

GROUSER_SIMD_CLONES FoundationSums sumOf(const FoundationLanes& sums) { return sums.sum(); }

GROUSER_SIMD_CLONES FoundationSums foundationOnPlane(const std::vector<const PointBlock*>& blocks,
                                                     const FoundationPress& press, const base::Vec3d& n,
                                                     double height) {
  const Vec3P normal = allLanes(n), turning = allLanes(cross(n, press.motion.spin));
  const PointLanes leaving = allLanes(dot(press.motion.velocity, n));
  FoundationLanes sums;
  sums.clear();
  PointLanes rate = allLanes(0); // sum of rocking area x o
  for (const PointBlock* block : blocks) {
    const PointLanes overlap = block->radius - (dot(normal, block->place) - height);
    const Vec3P x = block->place - normal * (block->radius - overlap * 0.5);
    const PointLanes touching = overlap > allLanes(0) ? block->area : allLanes(0);
    sums.addElastic(x, overlap, touching);
    if (press.flatWithin < 0) continue;
    const PointLanes flat = flatArea(press, *block, touching), moved = flat * (dot(turning, x) + leaving);
    sums.rocking += flat, rate += moved;
    sums.turns += x * flat, sums.ratedTurns += x * moved; // positions: the normal is common to all points
  }
  FoundationSums sum = sums.sum();
  sum.force = n * sum.pressed, sum.torque = cross(sum.place, n);
  sum.normals = n * sum.rocking, sum.turns = cross(sum.turns, n);
  sum.rated = n * FoundationLanes::over(rate), sum.ratedTurns = cross(sum.ratedTurns, n);
  return sum;
}

} // namespace grouser::contact
