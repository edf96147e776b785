// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "multibody/model.hpp"
#include "multibody/solver_options.hpp"
#include "multibody/state.hpp"

#include <memory>
#include <string>
#include <vector>

namespace grouser::multibody {

/// Advances a mechanism; the schemes are described in the integrators' sources. Deterministic, one thread, no
/// allocation in step().
///
/// With kSymplecticEuler a start velocity belongs to the start pose, half a step before the first mean velocity: the
/// first step applies a full step of load instead of half (a shift in time of dt / 2, the scheme's only first-order
/// error for smooth motions), and needs half the centripetal constraint force.
class Solver {
public:
  /// Orders the elimination, finds redundant constraints, and checks the start. The model must outlive the solver and
  /// not change. Throws base::InputError if at the start joints are not closed (naming the joint and its gap),
  /// velocities break a constraint (naming joint and rate), a drive or coupling contradicts the others or a closed loop
  /// (naming it), a driven axis is not where its law begins, or an option is out of its range.
  explicit Solver(const Model& model, const SolverOptions& options = {});
  ~Solver();
  Solver(Solver&&) noexcept;
  Solver& operator=(Solver&&) noexcept;

  /// One step of size dt [s], > 0. Throws base::SimulationError (naming step time and joint or body) when the position
  /// solve fails or a state is not finite; base::InputError when dt is beyond the stability limit of explicit springs
  /// (naming spring, limit and remedy).
  void step(State& state, const Loads& loads, double dt);

  /// Makes the twists of a state fit the constraints and drives by the smallest change in the norm of kinetic energy
  /// (as a shock would). Returns the kinetic energy taken out [J].
  double projectVelocities(State& state, const Loads& loads);

  /// Prepares impulse responses for a step of kSymplecticEuler. Computes the twists at its end under `loads`, one per
  /// body, to first order in the gaps that the step opens in curved joints. Does not affect step(). Throws
  /// std::logic_error with kRattle, and base::SimulationError where a twist is not finite or turns a body too far.
  void startResponse(const State& state, const Loads& loads, double dt, std::vector<Twist>& twists);
  /// Computes the change of these twists by further impulses [N s, N m s], one per body. The response includes joints,
  /// drives, and implicit springs; it is linear and symmetric, and at most that of free bodies.
  void respond(const std::vector<Wrench>& impulses, std::vector<Twist>& change);

  /// Largest step for which explicit springs are stable at a state's poses [s]: 2 / omega, omega the highest frequency
  /// of all springs against the constrained masses (the factor 2 is another for orders above 2, see kExplicit);
  /// infinite without springs. `spring`, if given, receives the name of the spring with the greatest part in it.
  double stableStep(const State& state, const Loads& loads, std::string* spring = nullptr);

  /// Highest frequency [rad/s] of the end stops against the constrained masses at a state's poses, as if all of them
  /// were touched at once; 0 without stops. A bounce off one takes pi over it at least. `stop`, if given, receives the
  /// name of the one with the greatest part in it.
  double stopRate(const State& state, const Loads& loads, std::string* stop = nullptr);

  /// Highest rate [1/s] of the dampers, those of joints and end stops with them, against the constrained masses: a
  /// velocity that only they brake dies away in 1 / this. 0 without any. kRattle takes them by the midpoint: from a
  /// step of 2 / this on the velocity changes its sign in every step and hardly dies away; kSymplecticEuler takes any
  /// step. `damper`, if given, receives the name of the one with the greatest part in it.
  double dampingRate(const State& state, const Loads& loads, std::string* damper = nullptr);

  /// Fastest rate [rad/s] at which geometric stiffness moves bodies at a state: under tension joints, springs,
  /// couplings and drives let them swing across it, under compression they let them buckle
  /// (detail/geometric_stiffness.hpp). All schemes need dt < stabilityLimit() / rate; beyond that a swing grows. 0
  /// where there are no forces. `part`, if given, receives the name of what has the greatest part in it.
  double geometricStiffnessRate(const State& state, const Loads& loads, std::string* part = nullptr);

  /// Largest omega dt [rad] of a swing that the scheme takes explicitly: 2 (2.72, 2.53, 3.10 with order 4, 6, 8).
  double stabilityLimit() const;

  /// Force and torque in every joint in the last step, as in JointReading, except for redundantly constrained joints.
  /// Their reactions are not determined by the equations of motion; the readings of a State are one solution, with
  /// zeros for dropped rows; this function returns the solution of least norm, sum of |force|^2 + |moment / L|^2 with L
  /// of SolverOptions::momentLength, so that equal joints share loads equally. For outputs: costs about as much as a
  /// few steps if rows are redundant, else nothing, and has no effect on the motion.
  std::vector<JointReaction> reactions(const State& state) const;

  const StepReport& lastStep() const;
  /// max |J v| over the hard rows at a state's poses [m/s, rad/s]. With kRattle it is met to round-off. With
  /// kSymplecticEuler the twist is the mean over the step that led there and meets the constraints over that step to
  /// positionTolerance / dt; at its end it leaves them by O(dt |w|^2 size).
  double velocityError(const State& state) const;
  /// Size of the problem, independent parts, and redundant rows.
  const std::string& report() const;
  /// Rows dropped as redundant: "joint 'pin 7': rotation about x".
  std::vector<std::string> redundantRowNames() const;
  /// Degrees of freedom left by joints and couplings (drives not counted), accounting for redundancy.
  int degreesOfFreedom() const;

private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace grouser::multibody
