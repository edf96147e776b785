// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "multibody/detail/block.hpp"
#include "multibody/detail/joint_rows.hpp"
#include "multibody/model.hpp"
#include "multibody/spatial.hpp"

#include <array>
#include <vector>

namespace grouser::multibody::detail {

/// Constant part of one constraint.
struct Constraint {
  ConstraintKind kind;
  int bodyA, bodyB;     ///< indices in the model; the last entry of the frame array is the world
  int nodeA, nodeB;     ///< indices among the movable bodies; -1: immovable
  int source;           ///< index of the model's joint, point spring or bushing
  Mat3d axes_A, axes_B; ///< axes of the joint frames in the body frames
  Vec3d point_A, point_B;
  double length = 0; ///< length of a distance joint [m]
};

using Frame = FrameOf<double>;
using JointFrames = JointFramesOf<double>;
using RowDirections = RowDirectionsOf<double>;

/// Bit mask of a kind's hard rows, without the axis row.
constexpr unsigned hardRows(ConstraintKind kind) {
  switch (kind) {
  case ConstraintKind::kRevolute:
  case ConstraintKind::kPrismatic:
    return 0x1fu;
  case ConstraintKind::kSpherical:
    return 0x07u;
  case ConstraintKind::kUniversal:
    return 0x0fu;
  case ConstraintKind::kFixed:
    return 0x3fu;
  case ConstraintKind::kCylindrical:
    return 0x0fu;
  case ConstraintKind::kDistance:
    return 0x01u;
  case ConstraintKind::kPointSpring:
  case ConstraintKind::kBushing:
    return 0;
  }
  return 0;
}

/// Bit mask of the three force rows of a joint; the other rows are torques.
constexpr unsigned forceRows(ConstraintKind kind) {
  return kind == ConstraintKind::kPrismatic     ? 1u << kAxisRow | 0x03u
         : kind == ConstraintKind::kCylindrical ? 1u << kSlideRow | 0x03u
                                                : 0x07u;
}

/// Bit mask of the rows available to springs, dampers, drives and couplings.
constexpr unsigned axisRows(ConstraintKind kind) {
  switch (kind) {
  case ConstraintKind::kRevolute:
  case ConstraintKind::kPrismatic:
    return 1u << kAxisRow;
  case ConstraintKind::kCylindrical:
    return 1u << kAxisRow | 1u << kSlideRow;
  case ConstraintKind::kPointSpring:
    return 0x01u;
  case ConstraintKind::kBushing:
    return 0x3fu;
  default:
    return 0;
  }
}

/// True for constraints from joints of the model.
constexpr bool isJoint(ConstraintKind kind) {
  return kind != ConstraintKind::kPointSpring && kind != ConstraintKind::kBushing;
}

/// Returns the joint frames in the body frames.
JointPlacesOf<double> placesOf(const Constraint& c);

/// Computes the joint frames from the body frames A and B.
void placeFrames(const Constraint& c, const Frame& A, const Frame& B, JointFrames& f);
JointFrames framesOf(const Constraint& c, const Frame& A, const Frame& B);

/// Computes C of the hard rows [m, rad]; sets the others to 0.
void positionError(const Constraint& c, const JointFrames& f, double (&error)[6]);

/// Sets the directions of all rows, including axis row or spring direction; rows that the kind lacks remain zero.
void setRowDirections(const Constraint& c, const JointFrames& f, RowDirections& rows);
RowDirections rowDirections(const Constraint& c, const JointFrames& f);

/// Jacobian blocks of the rows: row r times (v, w) of A (of B) is the contribution of A (of B) to C'.
void rowBlocks(const RowDirections& rows, const Vec3d& p_B, const Vec3d& com_A, const Vec3d& com_B, Block& jacobianA,
               Block& jacobianB);

/// Position along an axis row: angle from A to B about z_A [rad], in (-pi, pi], slide along z_A [m], length of a point
/// spring [m], translation [m] or rotation vector's component [rad] of a bushing.
double axisPosition(const Constraint& c, const JointFrames& f, int row);

/// Position after a step from `f0` to `f1`; angles are continued over full turns by their increment.
double axisPositionAfter(const Constraint& c, const JointFrames& f0, const JointFrames& f1, int row, double before);

/// Rotation vector of R_AB in the axes of A [rad], |phi| <= pi.
Vec3d relativeRotation(const JointFrames& f);

/// J (v, w) of one row [m/s, rad/s], from the frames and twists of all bodies.
double rowRate(const Constraint& c, const JointFrames& f, const RowDirections& rows, int row,
               const std::vector<Frame>& frames, const std::vector<Twist>& twist);

/// J' (v, w) of all rows: C'' at zero acceleration [m/s2, rad/s2]. `A`, `B`: body frames; twists of immovable bodies
/// are zero.
void rowBias(const Constraint& c, const JointFrames& f, const Frame& A, const Frame& B, const Twist& V_A,
             const Twist& V_B, double (&bias)[6]);

/// Short description of a row, for reports: "translation along z", "rotation about x"...
const char* rowName(ConstraintKind kind, int row);

} // namespace grouser::multibody::detail
