// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "multibody/detail/block.hpp"
#include "multibody/model.hpp"
#include "multibody/state.hpp"

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
///   cylindrical points x, y;     angles (x_A, z_B), (y_A, z_B)
///   distance    C = |d| - length: point row along d / |d|
///   axis rows   revolute, cylindrical: angle rate z_A . (w_B - w_A), row 5;
///               prismatic (row 5), cylindrical (row 4): point row along z_A.        Drive, spring, damper, coupling.
///   point spring  distance l = |d|, n = d / l:  J of a point row along n.                  Row 0.
///   bushing     points x, y, z (rows 0 to 2); rotation vector phi of R_AB (rows 3 to 5), whose rate in the axes of A
///   is
///                 phi' = Y(phi) w_AB:   J_i: B: [0, R_A Y^T e_i], A: the opposite.       (Y: rotation.hpp)
enum class ConstraintKind {
  kRevolute,
  kSpherical,
  kUniversal,
  kPrismatic,
  kFixed,
  kCylindrical,
  kDistance,
  kPointSpring,
  kBushing
};

inline constexpr int kAxisRow = 5;  ///< of a revolute, prismatic, and of the angle of a cylindrical
inline constexpr int kSlideRow = 4; ///< of a cylindrical

/// Constant part of one constraint.
struct Constraint {
  ConstraintKind kind;
  int bodyA, bodyB;     ///< model's indices; the frame array holds the world at the end
  int nodeA, nodeB;     ///< indices among the movable bodies, -1 if immovable
  int source;           ///< joint, point spring or bushing of the model
  Mat3d axes_A, axes_B; ///< joint frames' axes in the body frames
  Vec3d point_A, point_B;
  double length = 0; ///< of a distance joint [m]
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

/// Bit mask of the rows that springs, dampers, drives and couplings may use.
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

/// Whether the constraint comes from a joint of the model.
constexpr bool isJoint(ConstraintKind kind) {
  return kind != ConstraintKind::kPointSpring && kind != ConstraintKind::kBushing;
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

/// Position along an axis row: angle from A to B about z_A [rad], in (-pi, pi], slide along z_A [m], length of a point
/// spring [m], translation [m] or rotation vector's component [rad] of a bushing.
double axisPosition(const Constraint& c, const JointFrames& f, int row);

/// Position after a step from `f0` to `f1`: an angle is carried on over turns by its increment.
double axisPositionAfter(const Constraint& c, const JointFrames& f0, const JointFrames& f1, int row, double before);

/// Rotation vector of R_AB in the axes of A [rad], |phi| <= pi.
Vec3d relativeRotation(const JointFrames& f);

/// J' (v, w) of all rows: what is left of C'' when nothing accelerates [m/s2, rad/s2]. `A`, `B`: the bodies' frames;
/// twists of immovable bodies are zero.
void rowBias(const Constraint& c, const JointFrames& f, const Frame& A, const Frame& B, const Twist& V_A,
             const Twist& V_B, double (&bias)[6]);

/// Short description of a row, for reports: "translation along z", "rotation about x"...
const char* rowName(ConstraintKind kind, int row);

} // namespace grouser::multibody::detail
