// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "multibody/detail/constraint.hpp"
#include "multibody/detail/lanes.hpp"

#include <array>
#include <vector>

namespace grouser::multibody::detail {

using FrameL = FrameOf<Lanes>;
using JointFramesL = JointFramesOf<Lanes>;
using RowDirectionsL = RowDirectionsOf<Lanes>;

/// Four bodies of one kind with the joints to their parents (elimination.hpp): constants, and the joints of the last
/// linearisation. Idle lanes repeat the first lane.
struct alignas(64) LinkLanes {
  int count = 0;
  bool joint = false; ///< false for free bodies
  ConstraintKind kind = ConstraintKind::kFixed;
  std::array<int, kLanes> node{}, constraint{}; ///< indices of body and joint
  std::array<int, kLanes> body{}, parent{};     ///< indices in the model; the world is last
  std::array<int, kLanes> parentNode{};         ///< -1: immovable
  int axes = 0;                                 ///< rows available to springs, dampers and drives
  std::array<int, 2> axisRow{};
  std::array<std::array<int, kLanes>, 2> axis{}; ///< axis indices
  std::array<int, 2> freedom{};                  ///< indices of the axes among the joint's degrees of freedom

  Lanes real;               ///< 1, or 0 in idle lanes
  Lanes side;               ///< 1 if the child is B, -1 if it is A
  Lanes mass, inertia_B[6]; ///< inertia: columns of the lower triangle
  JointPlacesOf<Lanes> places;

  JointFramesL frames;
  RowDirectionsL rows;
  Vec3L com, parentCom;

  /// Assigns the frames of child and parent to A and B according to `side`.
  GROUSER_SIMD void sort(const FrameL& child, const FrameL& other, FrameL& A, FrameL& B) const {
    const auto isB = side > 0.0;
    const auto pick = [&](const Lanes& c, const Lanes& o, Lanes& a, Lanes& b) { a = isB ? o : c, b = isB ? c : o; };
#pragma GCC unroll 3
    for (int i = 0; i < 3; ++i)
#pragma GCC unroll 3
      for (int j = 0; j < 3; ++j) pick(child.R.m[i][j], other.R.m[i][j], A.R.m[i][j], B.R.m[i][j]);
    pick(child.p.x, other.p.x, A.p.x, B.p.x);
    pick(child.p.y, other.p.y, A.p.y, B.p.y);
    pick(child.p.z, other.p.z, A.p.z, B.p.z);
  }
};

/// Gathers the frames of four bodies, one per lane.
GROUSER_SIMD void gatherFrames(const std::vector<Frame>& frames, const std::array<int, kLanes>& body, FrameL& out) {
  static_assert(sizeof(Frame) == 12 * sizeof(double));
  const double* row[kLanes];
  for (std::size_t l = 0; l < kLanes; ++l)
    row[l] = reinterpret_cast<const double*>(&frames[static_cast<std::size_t>(body[l])]);
  Lanes a[4], b[4], c[4];
  gatherRows(row, 0, a);
  gatherRows(row, 4, b);
  gatherRows(row, 8, c);
  out.R = {{{a[0], a[1], a[2]}, {a[3], b[0], b[1]}, {b[2], b[3], c[0]}}};
  out.p = {c[1], c[2], c[3]};
}

} // namespace grouser::multibody::detail
