// SPDX-License-Identifier: BSD-3-Clause
#include "coupling/jointed_bodies.hpp"

#include <algorithm>

namespace grouser::coupling {

using base::Mat3d;
using base::Vec3d;

Mat3d inverseOf(const Mat3d& m) {
  const Vec3d a{m.m[0][0], m.m[1][0], m.m[2][0]}, b{m.m[0][1], m.m[1][1], m.m[2][1]},
      c{m.m[0][2], m.m[1][2], m.m[2][2]};
  const double scale = 1 / dot(a, cross(b, c));
  const Vec3d row[] = {cross(b, c) * scale, cross(c, a) * scale, cross(a, b) * scale};
  Mat3d inverse;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) inverse.m[i][j] = row[i][j];
  return inverse;
}

JointedBodies::JointedBodies(const ContactParts& parts, const multibody::Model& model, multibody::Solver& solver,
                             const ReplicatedWork& replicated)
    : model_(model), solver_(solver), replicated_(replicated), impulses_(model.bodies().size()) {
  for (const ContactPart& part : parts.parts) {
    const auto known = std::find(bodies_.begin(), bodies_.end(), part.body);
    bodyOfPart_.push_back(static_cast<std::uint32_t>(known - bodies_.begin()));
    if (known != bodies_.end()) continue;
    bodies_.push_back(part.body), inverseInertia_.push_back(inverseOf(model.bodies()[part.body].inertia_B));
  }
  inverses_.resize(bodies_.size());
}

void JointedBodies::begin(const multibody::State& state, const multibody::Loads& loads, double timeStep) {
  replicated_.run([&] { solver_.startResponse(state, loads, timeStep, freeTwists_); });
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    const multibody::Body& body = model_.bodies()[bodies_[b]];
    if (body.fixed) continue;
    inverses_[b] = {1 / body.mass,
                    multibody::rotatedInertia(state.pose[bodies_[b]].orientation.matrix(), inverseInertia_[b])};
  }
}

void JointedBodies::respond(const std::vector<contact::BodyImpulse>& impulses,
                            std::vector<contact::BodyVelocity>& velocities) {
  for (std::size_t b = 0; b < bodies_.size(); ++b) impulses_[bodies_[b]] = {impulses[b].linear, impulses[b].angular};
  replicated_.run([this] { solver_.respond(impulses_, change_); });
  velocities.resize(bodies_.size());
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    const multibody::Twist &V = freeTwists_[bodies_[b]], &more = change_[bodies_[b]];
    velocities[b] = {V.v + more.v, V.w + more.w};
  }
}

} // namespace grouser::coupling
