// SPDX-License-Identifier: BSD-3-Clause
#include "multibody/detail/constraint.hpp"

#include "base/math.hpp"
#include "multibody/detail/index.hpp"
#include "multibody/detail/rotation.hpp"

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

JointPlacesOf<double> placesOf(const Constraint& c) {
  return {c.point_A, c.point_B, column(c.axes_A, 0), column(c.axes_A, 2), column(c.axes_B, 0), column(c.axes_B, 2)};
}

void placeFrames(const Constraint& c, const Frame& A, const Frame& B, JointFrames& f) {
  placeFrames(placesOf(c), A, B, f);
}

JointFrames framesOf(const Constraint& c, const Frame& A, const Frame& B) {
  JointFrames f;
  placeFrames(c, A, B, f);
  return f;
}

void positionError(const Constraint& c, const JointFrames& f, double (&error)[6]) {
  for (double& e : error) e = 0;
  if (c.kind == ConstraintKind::kDistance)
    error[0] = norm(f.p_B - f.p_A) - c.length;
  else
    jointError(c.kind, f, error);
}

RowDirections rowDirections(const Constraint& c, const JointFrames& f) {
  RowDirections rows;
  setRowDirections(c, f, rows);
  return rows;
}

/// Sets the rows of a constraint kind; all other rows remain zero.
void setRowDirections(const Constraint& c, const JointFrames& f, RowDirections& rows) {
  switch (c.kind) {
  case ConstraintKind::kDistance:
  case ConstraintKind::kPointSpring: {
    const Vec3d d = f.p_B - f.p_A;
    const double l = norm(d);
    // For coincident points, the spring has no direction and no force.
    rows.force[0] = l > 1e-12 ? d * (1 / l) : Vec3d{};
    return;
  }
  case ConstraintKind::kBushing: {
    // Columns of R_A Y^T: Y^T e = e + phi x e / 2 + beta phi x (phi x e).
    const Vec3d phi = relativeRotation(f);
    const double beta = inverseTangentFactor(0.25 * norm2(phi));
    for (int i = 0; i < 3; ++i) {
      Vec3d e;
      e[i] = 1;
      const Vec3d first = cross(phi, e), t = e + 0.5 * first + beta * cross(phi, first);
      rows.torque[3 + static_cast<std::size_t>(i)] = t.x * f.x_A + t.y * f.y_A + t.z * f.z_A;
    }
    rows.force[0] = f.x_A, rows.force[1] = f.y_A, rows.force[2] = f.z_A;
    return;
  }
  default:
    jointRows(c.kind, f, rows);
  }
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

Vec3d relativeRotation(const JointFrames& f) {
  const Vec3d y_B = cross(f.z_B, f.x_B);
  const auto inA = [&](const Vec3d& v) { return Vec3d{dot(f.x_A, v), dot(f.y_A, v), dot(f.z_A, v)}; };
  return rotationVector(quaternionOf(inA(f.x_B), inA(y_B), inA(f.z_B)));
}

double axisPosition(const Constraint& c, const JointFrames& f, int row) {
  const Vec3d d = f.p_B - f.p_A;
  switch (c.kind) {
  case ConstraintKind::kCylindrical:
    if (row == kSlideRow) return dot(f.z_A, d);
    [[fallthrough]];
  case ConstraintKind::kRevolute: {
    double cosine, sine;
    cosSin(f, cosine, sine);
    return base::atan2(sine, cosine);
  }
  case ConstraintKind::kPrismatic:
    return dot(f.z_A, d);
  case ConstraintKind::kPointSpring:
    return norm(d);
  case ConstraintKind::kBushing:
    return row < 3 ? dot(row == 0 ? f.x_A : row == 1 ? f.y_A : f.z_A, d) : relativeRotation(f)[row - 3];
  default:
    return 0;
  }
}

double axisPositionAfter(const Constraint& c, const JointFrames& f0, const JointFrames& f1, int row, double before) {
  const bool angle = row == kAxisRow && (c.kind == ConstraintKind::kRevolute || c.kind == ConstraintKind::kCylindrical);
  if (!angle) return axisPosition(c, f1, row);
  double c0, s0, c1, s1;
  cosSin(f0, c0, s0);
  cosSin(f1, c1, s1);
  const double s = s1 * c0 - c1 * s0, q = s * s;
  // Arc sine by its series for small increments; the first omitted term is below 1e-17 for |s| < 0.02.
  if (q < 4e-4 && c1 * c0 + s1 * s0 > 0)
    return before + s * (1 + q * (1.0 / 6 + q * (3.0 / 40 + q * (15.0 / 336 + q * (105.0 / 3456)))));
  return before + base::atan2(s, c1 * c0 + s1 * s0);
}

double rowRate(const Constraint& c, const JointFrames& f, const RowDirections& rows, int row,
               const std::vector<Frame>& frames, const std::vector<Twist>& twist) {
  const Vec3d &e = rows.force[at(row)], &t = rows.torque[at(row)];
  const auto share = [&](int node, int body) {
    if (node < 0) return 0.0;
    const Twist& V = twist[at(body)];
    return dot(e, V.v) + dot(cross(f.p_B - frames[at(body)].p, e) + t, V.w);
  };
  return share(c.nodeB, c.bodyB) - share(c.nodeA, c.bodyA);
}

void rowBias(const Constraint& c, const JointFrames& f, const Frame& A, const Frame& B, const Twist& V_A,
             const Twist& V_B, double (&bias)[6]) {
  const Vec3d d = f.p_B - f.p_A, r_A = f.p_A - A.p, r_B = f.p_B - B.p;
  const Vec3d &w_A = V_A.w, &w_B = V_B.w;
  // d', and d'' at zero acceleration.
  const Vec3d d1 = V_B.v + cross(w_B, r_B) - V_A.v - cross(w_A, r_A);
  const Vec3d d2 = cross(w_B, cross(w_B, r_B)) - cross(w_A, cross(w_A, r_A));
  // C = u . d, u fixed in A:  u'' . d + 2 u' . d' + u . d''.
  const auto point = [&](const Vec3d& u) {
    const Vec3d u1 = cross(w_A, u);
    return dot(cross(w_A, u1), d) + 2 * dot(u1, d1) + dot(u, d2);
  };
  // C = u . t, u fixed in A, t in B.
  const auto angle = [&](const Vec3d& u, const Vec3d& t) {
    const Vec3d u1 = cross(w_A, u), t1 = cross(w_B, t);
    return dot(cross(w_A, u1), t) + 2 * dot(u1, t1) + dot(u, cross(w_B, t1));
  };
  // C' = z_A . (w_B - w_A).
  const auto turn = [&] { return dot(cross(w_A, f.z_A), w_B - w_A); };
  for (double& x : bias) x = 0;
  switch (c.kind) {
  case ConstraintKind::kPointSpring:
  case ConstraintKind::kBushing:
    return;
  case ConstraintKind::kDistance: {
    // C' = n . d', n' = (d' - n (n . d')) / |d|.
    const double l = norm(d), rate = dot(d, d1) / l;
    bias[0] = dot(d, d2) / l + (norm2(d1) - rate * rate) / l;
    return;
  }
  case ConstraintKind::kPrismatic:
    bias[0] = point(f.x_A), bias[1] = point(f.y_A);
    bias[2] = angle(f.x_A, f.z_B), bias[3] = angle(f.y_A, f.z_B), bias[4] = angle(f.y_A, f.x_B);
    bias[kAxisRow] = point(f.z_A);
    return;
  case ConstraintKind::kCylindrical:
    bias[0] = point(f.x_A), bias[1] = point(f.y_A);
    bias[2] = angle(f.x_A, f.z_B), bias[3] = angle(f.y_A, f.z_B);
    bias[kSlideRow] = point(f.z_A), bias[kAxisRow] = turn();
    return;
  case ConstraintKind::kFixed:
    bias[5] = angle(f.y_A, f.x_B);
    [[fallthrough]];
  case ConstraintKind::kRevolute:
    bias[3] = angle(f.x_A, f.z_B), bias[4] = angle(f.y_A, f.z_B);
    if (c.kind == ConstraintKind::kRevolute) bias[kAxisRow] = turn();
    break;
  case ConstraintKind::kUniversal:
    bias[3] = angle(f.z_A, f.x_B);
    break;
  case ConstraintKind::kSpherical:
    break;
  }
  bias[0] = point(f.x_A), bias[1] = point(f.y_A), bias[2] = point(f.z_A);
}

const char* rowName(ConstraintKind kind, int row) {
  static constexpr const char* kPoint[6] = {"translation along x", "translation along y", "translation along z",
                                            "rotation about y",    "rotation about x",    "rotation about z"};
  static constexpr const char* kSlide[6] = {"translation along x", "translation along y", "rotation about y",
                                            "rotation about x",    "rotation about z",    "translation along z"};
  if (kind == ConstraintKind::kUniversal && row == 3) return "rotation about y";
  if (kind == ConstraintKind::kDistance || kind == ConstraintKind::kPointSpring) return "distance";
  if (kind == ConstraintKind::kCylindrical && row >= 4) return kPoint[row == kSlideRow ? 2 : 5];
  if (kind == ConstraintKind::kBushing && row >= 3) return kPoint[row == 3 ? 4 : row == 4 ? 3 : 5];
  return kind == ConstraintKind::kPrismatic || kind == ConstraintKind::kCylindrical ? kSlide[row] : kPoint[row];
}

} // namespace grouser::multibody::detail
