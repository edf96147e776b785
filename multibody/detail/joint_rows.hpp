// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/vec.hpp"

#include <array>

namespace grouser::multibody::detail {

using base::Mat3;
using base::Vec3;

/// Constraint equations in world components. d = p_B - p_A connects the origins of the two joint frames; x, y, z with
/// index A or B are the axes of these frames. In differences such as p_B - x_A, x_A and x_B denote the centres of
/// mass of A and B.
///
///   point row along u_A       C = u_A . d
///     rate                    C' = u_A . (v_B + w_B x r_B - v_A) - w_A . ((p_B - x_A) x u_A),      r_B = p_B - x_B
///     J                       B: [u_A, r_B x u_A]        A: [-u_A, -(p_B - x_A) x u_A]
///                             A and B receive opposite forces at the same point p_B: momentum is conserved exactly.
///   angle row                 C = u_A . t_B  (axes that remain perpendicular)
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
///   bushing     points x, y, z (rows 0 to 2); rotation vector phi of R_AB (rows 3 to 5), with the rate in the axes of
///               A
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

inline constexpr int kAxisRow = 5;  ///< axis row of a revolute or prismatic, angle row of a cylindrical
inline constexpr int kSlideRow = 4; ///< slide row of a cylindrical

// Joint formulas are templates: T is double, or the SIMD type of lanes.hpp for several joints of one kind.

/// Rotation matrix and origin of a body.
template <class T> struct FrameOf {
  Mat3<T> R;
  Vec3<T> p;
};

/// Joint frames in the world.
template <class T> struct JointFramesOf {
  Vec3<T> p_A, p_B;
  Vec3<T> x_A, y_A, z_A;
  Vec3<T> x_B, z_B;
};

/// Joint frames in the two body frames.
template <class T> struct JointPlacesOf {
  Vec3<T> point_A, point_B;
  Vec3<T> x_A, z_A, x_B, z_B;
};

/// Each row as a generalised force on B: `force` at p_B plus `torque`; A receives the opposite at the same point.
template <class T> struct RowDirectionsOf { std::array<Vec3<T>, 6> force{}, torque{}; };

template <class T>
inline void placeFrames(const JointPlacesOf<T>& places, const FrameOf<T>& A, const FrameOf<T>& B, JointFramesOf<T>& f) {
  f.p_A = A.p + A.R * places.point_A;
  f.p_B = B.p + B.R * places.point_B;
  f.x_A = A.R * places.x_A;
  f.z_A = A.R * places.z_A;
  f.y_A = cross(f.z_A, f.x_A);
  f.x_B = B.R * places.x_B;
  f.z_B = B.R * places.z_B;
}

/// Computes C of the hard rows of a joint other than a distance joint [m, rad]; other entries are unchanged.
template <class T> inline void jointError(ConstraintKind kind, const JointFramesOf<T>& f, T (&error)[6]) {
  const Vec3<T> d = f.p_B - f.p_A;
  switch (kind) {
  case ConstraintKind::kPrismatic:
    error[4] = dot(f.y_A, f.x_B);
    [[fallthrough]];
  case ConstraintKind::kCylindrical:
    error[0] = dot(f.x_A, d);
    error[1] = dot(f.y_A, d);
    error[2] = dot(f.x_A, f.z_B);
    error[3] = dot(f.y_A, f.z_B);
    return;
  case ConstraintKind::kFixed:
    error[5] = dot(f.y_A, f.x_B);
    [[fallthrough]];
  case ConstraintKind::kRevolute:
    error[3] = dot(f.x_A, f.z_B);
    error[4] = dot(f.y_A, f.z_B);
    break;
  case ConstraintKind::kUniversal:
    error[3] = dot(f.z_A, f.x_B);
    break;
  case ConstraintKind::kSpherical:
    break;
  default:
    return;
  }
  error[0] = dot(f.x_A, d);
  error[1] = dot(f.y_A, d);
  error[2] = dot(f.z_A, d);
}

/// Directions of all six rows of a joint other than a distance joint, including free axes.
template <class T> inline void jointRows(ConstraintKind kind, const JointFramesOf<T>& f, RowDirectionsOf<T>& rows) {
  switch (kind) {
  case ConstraintKind::kPrismatic:
    rows.force[0] = f.x_A;
    rows.force[1] = f.y_A;
    rows.torque[2] = cross(f.z_B, f.x_A);
    rows.torque[3] = cross(f.z_B, f.y_A);
    rows.torque[4] = cross(f.x_B, f.y_A);
    rows.force[kAxisRow] = f.z_A;
    return;
  case ConstraintKind::kCylindrical:
    rows.force[0] = f.x_A;
    rows.force[1] = f.y_A;
    rows.torque[2] = cross(f.z_B, f.x_A);
    rows.torque[3] = cross(f.z_B, f.y_A);
    rows.force[kSlideRow] = f.z_A;
    rows.torque[kAxisRow] = f.z_A;
    return;
  case ConstraintKind::kFixed:
    rows.torque[3] = cross(f.z_B, f.x_A);
    rows.torque[4] = cross(f.z_B, f.y_A);
    rows.torque[5] = cross(f.x_B, f.y_A);
    break;
  case ConstraintKind::kRevolute:
    rows.torque[3] = cross(f.z_B, f.x_A);
    rows.torque[4] = cross(f.z_B, f.y_A);
    rows.torque[kAxisRow] = f.z_A;
    break;
  case ConstraintKind::kUniversal:
    rows.torque[3] = cross(f.x_B, f.z_A);
    rows.torque[4] = f.z_A;
    rows.torque[5] = f.x_B;
    break;
  case ConstraintKind::kSpherical:
    rows.torque[3] = f.x_A;
    rows.torque[4] = f.y_A;
    rows.torque[5] = f.z_A;
    break;
  default:
    return;
  }
  rows.force[0] = f.x_A;
  rows.force[1] = f.y_A;
  rows.force[2] = f.z_A;
}

} // namespace grouser::multibody::detail
