// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "contact/body_response.hpp"
#include "coupling/contact_parts.hpp"
#include "multibody/solver.hpp"

#include <vector>

namespace grouser::coupling {

/// The bodies of a vehicle or mechanism that meet grains, as complementarity contacts see them: impulses on them act
/// through all joints within the iterations (Solver::respond()).
class JointedBodies : public contact::BodyResponse {
public:
  /// All outlive it.
  JointedBodies(const ContactParts& parts, const multibody::Model& model, multibody::Solver& solver);

  /// Begins a step with all loads but those of the grains.
  void begin(const multibody::State& state, const multibody::Loads& loads, double timeStep);

  const std::vector<std::uint32_t>& bodyOfPart() const override { return bodyOfPart_; }
  const std::vector<Inverse>& inverses() const override { return inverses_; }
  void respond(const std::vector<contact::BodyImpulse>& impulses,
               std::vector<contact::BodyVelocity>& velocities) override;

private:
  const multibody::Model& model_;
  multibody::Solver& solver_;
  std::vector<std::uint32_t> bodyOfPart_;
  std::vector<std::size_t> bodies_; ///< index of each in the model
  std::vector<Inverse> inverses_;
  std::vector<base::Mat3d> inverseInertia_;           ///< body axes [1/(kg m2)]
  std::vector<multibody::Twist> freeTwists_, change_; ///< one a body of the model: without the grains, and by them
  std::vector<multibody::Wrench> impulses_;           ///< the same
};

} // namespace grouser::coupling
