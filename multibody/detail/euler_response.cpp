// SPDX-License-Identifier: BSD-3-Clause
// Linear response of a step of the Euler scheme (euler_step.cpp) to impulses on its bodies.
#include "multibody/detail/euler_step.hpp"
#include "multibody/detail/index.hpp"
#include "multibody/detail/vector6.hpp"

namespace grouser::multibody::detail {

/// Adds the solution for the current residuals.
void EulerStep::addSolution(const ConstraintSystem::Part& part, std::vector<Twist>& twists) {
  system_.solve(part, x_);
  for (const int node : part.bodies) {
    Twist& V = twists[at(system_.bodyOf(node))];
    V.v += linear(x_[at(node)]);
    V.w += angular(x_[at(node)]);
  }
}

/// Performs the first solve of a step, without the Newton corrections.
void EulerStep::startResponse(const State& state, const Loads& loads, double dt, std::vector<Twist>& twists) {
  system_.place(state.pose, frames_);
  placed_.clear(); // makes step() place the bodies again
  axisLaws_.evaluate(system_, state, loads, dt, frames_, driveStart_, laws_);
  twists = state.twist;
  for (const ConstraintSystem::Part& part : system_.parts()) {
    system_.linearise(part, frames_, laws_);
    setFirstResidual(part, state, loads, dt);
    moveLinks(dt);
    setGapResidual(part, state, dt, true);
    addSolution(part, twists);
    for (const int node : part.bodies) {
      const std::size_t b = at(system_.bodyOf(node));
      checkTwist(model_.bodies()[b], twists[b], state.time, dt);
    }
  }
}

void EulerStep::respond(const std::vector<Wrench>& impulses, std::vector<Twist>& change) {
  change.assign(model_.bodies().size(), Twist{});
  for (const ConstraintSystem::Part& part : system_.parts()) {
    for (const int node : part.bodies) {
      const auto& [force, torque] = impulses[at(system_.bodyOf(node))];
      x_[at(node)] = {force.x, force.y, force.z, torque.x, torque.y, torque.z};
    }
    for (const int k : part.constraints) x_[at(rowNode(k))] = {};
    for (const int c : part.couplings) x_[at(system_.couplingNode(c))] = {};
    addSolution(part, change);
  }
}

} // namespace grouser::multibody::detail
