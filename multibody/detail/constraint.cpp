// SPDX-License-Identifier: BSD-3-Clause
#include "multibody/detail/constraint.hpp"

#include "base/math.hpp"

#include <cstddef>

namespace grouser::multibody::detail {

namespace {

Vec3d column(const Mat3d& R, int j) { return {R.m[0][j], R.m[1][j], R.m[2][j]}; }

/// cos and sin of the angle from A to B about z_A.
void cosSin(const JointFrames& f, double& c, double& s) {
  c = dot(f.x_A, f.x_B);
  s = dot(f.y_A, f.x_B);
}

} // namespace

void placeFrames(const Constraint& c, const Frame& A, const Frame& B, JointFrames& f) {
  f.p_A = A.p + A.R * c.point_A;
  f.p_B = B.p + B.R * c.point_B;
  if (c.kind == ConstraintKind::kPointSpring) return;
  f.x_A = A.R * column(c.axes_A, 0);
  f.z_A = A.R * column(c.axes_A, 2);
  f.y_A = cross(f.z_A, f.x_A);
  f.x_B = B.R * column(c.axes_B, 0);
  f.z_B = B.R * column(c.axes_B, 2);
}

JointFrames framesOf(const Constraint& c, const Frame& A, const Frame& B) {
  JointFrames f;
  placeFrames(c, A, B, f);
  return f;
}

void positionError(const Constraint& c, const JointFrames& f, double (&error)[6]) {
  const Vec3d d = f.p_B - f.p_A;
  for (double& e : error) e = 0;
  switch (c.kind) {
  case ConstraintKind::kPointSpring:
    return;
  case ConstraintKind::kPrismatic:
    error[0] = dot(f.x_A, d);
    error[1] = dot(f.y_A, d);
    error[2] = dot(f.x_A, f.z_B);
    error[3] = dot(f.y_A, f.z_B);
    error[4] = dot(f.y_A, f.x_B);
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
  }
  error[0] = dot(f.x_A, d);
  error[1] = dot(f.y_A, d);
  error[2] = dot(f.z_A, d);
}

RowDirections rowDirections(const Constraint& c, const JointFrames& f) {
  RowDirections rows;
  setRowDirections(c, f, rows);
  return rows;
}

/// Writes the rows that the kind has; the others stay zero.
void setRowDirections(const Constraint& c, const JointFrames& f, RowDirections& rows) {
  switch (c.kind) {
  case ConstraintKind::kPointSpring: {
    const Vec3d d = f.p_B - f.p_A;
    const double l = norm(d);
    // Coinciding points: the spring has no direction, and pulls nowhere.
    rows.force[0] = l > 1e-12 ? d * (1 / l) : Vec3d{};
    return;
  }
  case ConstraintKind::kPrismatic:
    rows.force[0] = f.x_A;
    rows.force[1] = f.y_A;
    rows.torque[2] = cross(f.z_B, f.x_A);
    rows.torque[3] = cross(f.z_B, f.y_A);
    rows.torque[4] = cross(f.x_B, f.y_A);
    rows.force[kAxisRow] = f.z_A;
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
    break;
  case ConstraintKind::kSpherical:
    break;
  }
  rows.force[0] = f.x_A;
  rows.force[1] = f.y_A;
  rows.force[2] = f.z_A;
}

void rowBlocks(const RowDirections& rows, const Vec3d& p_B, const Vec3d& com_A, const Vec3d& com_B, Block& jacobianA,
               Block& jacobianB) {
  const Vec3d arm_A = p_B - com_A, arm_B = p_B - com_B;
  for (std::size_t r = 0; r < 6; ++r) {
    const Vec3d &e = rows.force[r], &t = rows.torque[r];
    const Vec3d a = cross(arm_A, e) + t, b = cross(arm_B, e) + t;
    jacobianA[r] = -e.x, jacobianA[kStride + r] = -e.y, jacobianA[2 * kStride + r] = -e.z;
    jacobianA[3 * kStride + r] = -a.x, jacobianA[4 * kStride + r] = -a.y, jacobianA[5 * kStride + r] = -a.z;
    jacobianB[r] = e.x, jacobianB[kStride + r] = e.y, jacobianB[2 * kStride + r] = e.z;
    jacobianB[3 * kStride + r] = b.x, jacobianB[4 * kStride + r] = b.y, jacobianB[5 * kStride + r] = b.z;
  }
}

double axisPosition(const Constraint& c, const JointFrames& f) {
  switch (c.kind) {
  case ConstraintKind::kRevolute: {
    double cosine, sine;
    cosSin(f, cosine, sine);
    return base::atan2(sine, cosine);
  }
  case ConstraintKind::kPrismatic:
    return dot(f.z_A, f.p_B - f.p_A);
  case ConstraintKind::kPointSpring:
    return norm(f.p_B - f.p_A);
  default:
    return 0;
  }
}

double axisPositionAfter(const Constraint& c, const JointFrames& f0, const JointFrames& f1, double before) {
  if (c.kind != ConstraintKind::kRevolute) return axisPosition(c, f1);
  double c0, s0, c1, s1;
  cosSin(f0, c0, s0);
  cosSin(f1, c1, s1);
  const double s = s1 * c0 - c1 * s0, q = s * s;
  // Arc sine by its series while the increment is small; the first term left out is below 1e-17 for |s| < 0.02.
  if (q < 4e-4 && c1 * c0 + s1 * s0 > 0)
    return before + s * (1 + q * (1.0 / 6 + q * (3.0 / 40 + q * (15.0 / 336 + q * (105.0 / 3456)))));
  return before + base::atan2(s, c1 * c0 + s1 * s0);
}

const char* rowName(ConstraintKind kind, int row) {
  static constexpr const char* kPoint[6] = {"translation along x", "translation along y", "translation along z",
                                            "rotation about y",    "rotation about x",    "rotation about z"};
  static constexpr const char* kSlide[6] = {"translation along x", "translation along y", "rotation about y",
                                            "rotation about x",    "rotation about z",    "translation along z"};
  if (kind == ConstraintKind::kUniversal && row == 3) return "rotation about y";
  return kind == ConstraintKind::kPrismatic ? kSlide[row] : kPoint[row];
}

} // namespace grouser::multibody::detail
