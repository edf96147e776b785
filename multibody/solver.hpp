// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "multibody/model.hpp"
#include "multibody/solver_options.hpp"
#include "multibody/state.hpp"

#include <memory>
#include <string>
#include <vector>

namespace grouser::multibody {

/// Time integrator of a mechanism; the schemes are described in the integrators' sources. Deterministic and
/// single-threaded; step() does not allocate.
///
/// With kSymplecticEuler the initial velocity belongs to the initial pose, half a step before the first mean velocity.
/// Therefore the first step applies the load of a full step instead of half a step (a time shift of dt / 2, the only
/// first-order error of the scheme for smooth motions), and requires half the centripetal constraint force.
class Solver {
public:
  /// Determines the elimination order, finds redundant constraints, and checks the initial state. The model must
  /// outlive the solver and not change. Throws base::InputError if joints are initially open (names joint and gap),
  /// velocities violate a constraint (names joint and rate), a drive or coupling contradicts the others or a closed
  /// loop (names the element), a driven axis is not at the start of its law, or an option is out of range.
  explicit Solver(const Model& model, const SolverOptions& options = {});
  ~Solver();
  Solver(Solver&&) noexcept;
  Solver& operator=(Solver&&) noexcept;

  /// Advances the state by dt [s], > 0. Throws base::SimulationError, with the time and the joint or body, if the
  /// position solve fails or a state is not finite; base::InputError, with spring, limit and remedy, if dt exceeds the
  /// stability limit of explicit springs.
  void step(State& state, const Loads& loads, double dt);

  /// Projects the twists of a state onto the constraints and drives by the smallest change in the kinetic energy norm
  /// (like an impact). Returns the kinetic energy removed [J].
  double projectVelocities(State& state, const Loads& loads);

  /// Prepares impulse responses for a step of kSymplecticEuler: computes the end-of-step twists under `loads`, one per
  /// body, to first order in the gaps that the step opens in curved joints. Does not affect step(). Throws
  /// std::logic_error with kRattle, and base::SimulationError if a twist is not finite or rotates a body too far.
  void startResponse(const State& state, const Loads& loads, double dt, std::vector<Twist>& twists);
  /// Computes the change of the end-of-step twists due to further impulses [N s, N m s], one per body. The response
  /// includes joints, drives and implicit springs; it is linear, symmetric, and at most the response of free bodies.
  void respond(const std::vector<Wrench>& impulses, std::vector<Twist>& change);

  /// Maximum stable step of explicit springs at a state's poses [s]: 2 / omega, with the highest frequency omega of all
  /// springs against the constrained masses (another factor for orders above 2, see kExplicit); infinite without
  /// springs. `spring`, if given, receives the name of the spring that contributes most.
  double stableStep(const State& state, const Loads& loads, std::string* spring = nullptr);

  /// Highest frequency [rad/s] of the end stops against the constrained masses at a state's poses, as if all stops were
  /// in contact; 0 without stops. A bounce lasts at least pi / frequency. `stop`, if given, receives the name of the
  /// stop that contributes most.
  double stopRate(const State& state, const Loads& loads, std::string* stop = nullptr);

  /// Highest decay rate [1/s] of the dampers, including joints and end stops, against the constrained masses: without
  /// other forces, a velocity decays in 1 / rate. 0 without dampers. kRattle uses the midpoint rule: in steps above
  /// 2 / rate the velocity changes sign in every step and hardly decays; kSymplecticEuler permits any step.
  /// `damper`, if given, receives the name of the damper that contributes most.
  double dampingRate(const State& state, const Loads& loads, std::string* damper = nullptr);

  /// Fastest rate [rad/s] of the motion due to geometric stiffness at a state: transverse oscillation of joints,
  /// springs, couplings and drives under tension, buckling under compression (detail/geometric_stiffness.hpp). All
  /// schemes require dt < stabilityLimit() / rate; in longer steps oscillations grow. 0 without forces. `part`, if
  /// given, receives the name of the element that contributes most.
  double geometricStiffnessRate(const State& state, const Loads& loads, std::string* part = nullptr);

  /// Stability limit of omega dt [rad] for explicit oscillations: 2 (2.72, 2.53, 3.10 with order 4, 6, 8).
  double stabilityLimit() const;

  /// Force and torque of every joint in the last step, as in JointReading. The equations of motion do not determine the
  /// reactions of redundantly constrained joints: a State contains one solution, with zeros for dropped rows. This
  /// function returns the solution with the minimum norm, sum of |force|^2 + |moment / L|^2 with
  /// L = SolverOptions::momentLength, so that equal joints share loads equally. Intended for output: it costs as much
  /// as a few steps if rows are redundant, else nothing, and does not affect the motion.
  std::vector<JointReaction> reactions(const State& state) const;

  const StepReport& lastStep() const;
  /// max |J v| over the hard rows at a state's poses [m/s, rad/s]. With kRattle the constraints are satisfied to
  /// round-off. With kSymplecticEuler the twist is the mean over the last step and satisfies the constraints over this
  /// step to positionTolerance / dt; at the end of the step the violation is O(dt |w|^2 size), with the body size.
  double velocityError(const State& state) const;
  /// Text report: problem size, independent parts, and redundant rows.
  const std::string& report() const;
  /// Names of the rows dropped as redundant: "joint 'pin 7': rotation about x".
  std::vector<std::string> redundantRowNames() const;
  /// Degrees of freedom remaining with joints and couplings (ignoring drives); redundancy is considered.
  int degreesOfFreedom() const;

private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace grouser::multibody
