// SPDX-License-Identifier: BSD-3-Clause
// Checks that the initial velocities satisfy the joints.
#include "runs/setup/mechanism_model.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace grouser::setup {

using base::Pose;
using base::Vec3d;
using multibody::JointType;

namespace {

/// Relative tolerance of initial velocities at a joint [-], for numbers typed with six digits.
constexpr double kStartRate = 1e-5;

struct Motion {
  Pose X_WB;
  Vec3d v, w;
  Vec3d at(const Vec3d& p) const { return v + cross(w, p - X_WB.position); }
};

Motion motionOf(const multibody::Model& model, int body) {
  if (body == multibody::kWorld) return {};
  const multibody::Body& b = model.bodies()[static_cast<std::size_t>(body)];
  return {b.pose, b.v_WB, b.w_WB};
}

std::string shortText(const Vec3d& v) { return fmt::format("({:.6g}, {:.6g}, {:.6g})", v.x, v.y, v.z); }

/// The component of `v` perpendicular to the unit vector `z`.
Vec3d beside(const Vec3d& v, const Vec3d& z) { return v - dot(v, z) * z; }

} // namespace

void checkStartVelocity(const multibody::Model& model, int index) {
  const multibody::Joint& joint = model.joints()[static_cast<std::size_t>(index)];
  const Motion A = motionOf(model, joint.bodyA), B = motionOf(model, joint.bodyB);
  const Pose X_WA = multibody::compose(A.X_WB, joint.frame_A), X_WB = multibody::compose(B.X_WB, joint.frame_B);
  const Vec3d& p = X_WB.position;
  const base::Mat3d R_A = X_WA.orientation.matrix(), R_B = X_WB.orientation.matrix();
  const Vec3d z = R_A * Vec3d{0, 0, 1}, x = R_B * Vec3d{1, 0, 0};

  // Constrained parts of the velocity of B's point relative to A, and of the angular velocity of B relative to A.
  Vec3d slip = B.at(p) - A.at(p), turn = B.w - A.w;
  switch (joint.type) {
  case JointType::kRevolute:
    turn = beside(turn, z);
    break;
  case JointType::kSpherical:
    turn = {};
    break;
  case JointType::kUniversal: {
    const Vec3d held = normalized(cross(z, x));
    turn = dot(turn, held) * held;
    break;
  }
  case JointType::kPrismatic:
    slip = beside(slip, z);
    break;
  case JointType::kFixed:
    break;
  case JointType::kCylindrical:
    slip = beside(slip, z), turn = beside(turn, z);
    break;
  case JointType::kDistance: {
    const Vec3d along = normalized(p - X_WA.position);
    slip = dot(B.at(p) - A.at(X_WA.position), along) * along, turn = {};
    break;
  }
  }
  // Magnitude of the terms of each velocity: differences within their round-off are no error.
  const auto size = [&](const Motion& m) { return norm(m.v) + norm(m.w) * norm(p - m.X_WB.position); };
  const double speed = size(A) + size(B), spin = norm(A.w) + norm(B.w);
  const auto bodies = [&] {
    return fmt::format("\"{}\" and \"{}\"", model.bodyName(joint.bodyA), model.bodyName(joint.bodyB));
  };
  if (norm(slip) > kStartRate * speed)
    throw support::SectionFault(
        "", fmt::format("(\"{}\") connects {} at {} m, but their initial velocities there, {} and {} m/s, differ by {} "
                        "m/s; change the velocity or spin of one to make them equal",
                        joint.name, bodies(), shortText(p), shortText(A.at(p)), shortText(B.at(p)), shortText(slip)));
  if (norm(turn) > kStartRate * spin)
    throw support::SectionFault("", fmt::format("(\"{}\") connects {}, but their initial spins, {} and {} rad/s, "
                                                "differ by {} rad/s; change one to make them compatible",
                                                joint.name, bodies(), shortText(A.w), shortText(B.w), shortText(turn)));
}

} // namespace grouser::setup
