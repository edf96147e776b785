// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "multibody/detail/block.hpp"
#include "multibody/model.hpp"

#include <array>

namespace grouser::multibody::detail {

/// Constraint equations. d = p_B - p_A joins the origins of the two joint frames; x, y, z with index A or B are their
/// axes; x_A stands for the centre of mass of A (and so on) where it is subtracted from a point. All in world
/// components.
///
///   point row along u_A       C = u_A . d
///     rate                    C' = u_A . (v_B + w_B x r_B - v_A) - w_A . ((p_B - x_A) x u_A),      r_B = p_B - x_B
///     J                       B: [u_A, r_B x u_A]        A: [-u_A, -(p_B - x_A) x u_A]
///                             A and B feel opposite forces at the same point p_B: no momentum is made, closed or not.
///   angle row                 C = u_A . t_B  (axes that shall stay perpendicular)
///     rate                    C' = (w_B - w_A) . (t_B x u_A)
///     J                       B: [0, t_B x u_A]          A: the opposite
///
///   spherical   points x, y, z
///   revolute    points x, y, z;  angles (x_A, z_B), (y_A, z_B)
///   universal   points x, y, z;  angle (z_A, x_B)
///   fixed       points x, y, z;  angles (x_A, z_B), (y_A, z_B), (y_A, x_B)
///   prismatic   points x, y;     angles (x_A, z_B), (y_A, z_B), (y_A, x_B)
///   axis row    revolute: angle rate z_A . (w_B - w_A);  prismatic: point row along z_A.  Row 5; drive, spring,
///   damper. point spring  distance l = |d|, n = d / l:  J of a point row along n.                  Row 0.
enum class ConstraintKind { kRevolute, kSpherical, kUniversal, kPrismatic, kFixed, kPointSpring };

inline constexpr int kAxisRow = 5;

/// Constant part of one constraint.
struct Constraint {
  ConstraintKind kind;
  int bodyA, bodyB;     ///< model's indices; the frame array holds the world at the end
  int nodeA, nodeB;     ///< indices among the movable bodies, -1 if immovable
  int source;           ///< joint or point spring of the model
  Mat3d axes_A, axes_B; ///< joint frames' axes in the body frames
  Vec3d point_A, point_B;
};

/// Rotation matrix and origin of a body.
struct Frame {
  Mat3d R;
  Vec3d p;
};

/// Joint frames in the world.
struct JointFrames {
  Vec3d p_A, p_B;
  Vec3d x_A, y_A, z_A;
  Vec3d x_B, z_B;
};

/// Each row as a generalised force on B: `force` at p_B plus `torque`; A feels the opposite at the same point.
struct RowDirections {
  std::array<Vec3d, 6> force{}, torque{};
};

/// Bit mask of the hard rows of a kind (the axis row not among them).
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
  case ConstraintKind::kPointSpring:
    return 0;
  }
  return 0;
}

/// Row that springs, dampers and drives may use; -1 if the kind has none.
constexpr int softRow(ConstraintKind kind) {
  switch (kind) {
  case ConstraintKind::kRevolute:
  case ConstraintKind::kPrismatic:
    return kAxisRow;
  case ConstraintKind::kPointSpring:
    return 0;
  default:
    return -1;
  }
}

constexpr bool hasAxis(ConstraintKind kind) {
  return kind == ConstraintKind::kRevolute || kind == ConstraintKind::kPrismatic;
}

/// Writes the joint frames at the bodies' frames A and B.
void placeFrames(const Constraint& c, const Frame& A, const Frame& B, JointFrames& f);
JointFrames framesOf(const Constraint& c, const Frame& A, const Frame& B);

/// C of the hard rows [m, rad]; 0 in the others.
void positionError(const Constraint& c, const JointFrames& f, double (&error)[6]);

/// Directions of all rows, axis row or spring direction included; rows the kind has not are left as they are (zero).
void setRowDirections(const Constraint& c, const JointFrames& f, RowDirections& rows);
RowDirections rowDirections(const Constraint& c, const JointFrames& f);

/// The rows' blocks: row r times (v, w) of A (of B) gives its share of C'.
void rowBlocks(const RowDirections& rows, const Vec3d& p_B, const Vec3d& com_A, const Vec3d& com_B, Block& jacobianA,
               Block& jacobianB);

/// Angle from A to B about z_A [rad], in (-pi, pi], or slide along z_A [m], or length of a point spring [m].
double axisPosition(const Constraint& c, const JointFrames& f);

/// Position after a step from `f0` to `f1`: an angle is carried on over turns by its increment.
double axisPositionAfter(const Constraint& c, const JointFrames& f0, const JointFrames& f1, double before);

/// Short description of a row, for reports: "translation along z", "rotation about x"...
const char* rowName(ConstraintKind kind, int row);

} // namespace grouser::multibody::detail
