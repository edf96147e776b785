// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "contact/body_response.hpp"
#include "coupling/contact_parts.hpp"
#include "coupling/replicated_work.hpp"
#include "multibody/solver.hpp"

#include <vector>

namespace grouser::coupling {

/// Inverse of a symmetric, positive definite matrix.
base::Mat3d inverseOf(const base::Mat3d& m);

/// Response of the bodies of a vehicle or mechanism to impulses of grains, through all joints (Solver::respond()).
class JointedBodies : public contact::BodyResponse {
public:
  /// The arguments must outlive this object.
  JointedBodies(const ContactParts& parts, const multibody::Model& model, multibody::Solver& solver,
                const ReplicatedWork& replicated);

  /// Begins a step. `loads` contains all loads except those of grains.
  void begin(const multibody::State& state, const multibody::Loads& loads, double timeStep);

  const std::vector<std::uint32_t>& bodyOfPart() const override { return bodyOfPart_; }
  const std::vector<Inverse>& inverses() const override { return inverses_; }
  void respond(const std::vector<contact::BodyImpulse>& impulses,
               std::vector<contact::BodyVelocity>& velocities) override;

private:
  const multibody::Model& model_;
  multibody::Solver& solver_;
  ReplicatedWork replicated_;
  std::vector<std::uint32_t> bodyOfPart_;
  std::vector<std::size_t> bodies_; ///< indices in the model
  std::vector<Inverse> inverses_;
  std::vector<base::Mat3d> inverseInertia_; ///< body axes [1/(kg m2)]
  std::vector<multibody::Twist> freeTwists_,
      change_;                              ///< by body of the model: motion without grain contacts, and its change
  std::vector<multibody::Wrench> impulses_; ///< by body of the model
};

} // namespace grouser::coupling
