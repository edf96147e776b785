// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "multibody/detail/axis_laws.hpp"
#include "multibody/detail/integrator.hpp"
#include "multibody/detail/mixing.hpp"

#include <array>
#include <vector>

namespace grouser::multibody::detail {

/// Constrained symplectic Euler; euler_step.cpp states the scheme.
class EulerStep : public Stepper {
public:
  explicit EulerStep(const Problem& problem);
  void step(State& state, const Loads& loads, double dt) override;

private:
  void solvePart(const ConstraintSystem::Part& part, State& state, const Loads& loads, double dt);
  void setFirstResidual(const ConstraintSystem::Part& part, const State& state, const Loads& loads, double dt);
  void applyCorrection(const ConstraintSystem::Part& part, double dt);
  void moveTrial(const ConstraintSystem::Part& part, const State& state, double dt);
  double setGapResidual(const ConstraintSystem::Part& part, const State& state, double dt, int& worst);
  double setGyroResidual(const ConstraintSystem::Part& part, double dt);
  void finish(const ConstraintSystem::Part& part, State& state, const Loads& loads, double dt);
  void addSpin(int k, const Vec3d& force, const Vec3d& torque, State& state) const;
  void readConstraint(int k, State& state, double dt);
  double trialPosition(const State& state, int axis) const;
  int rowNode(int k) const { return system.movableBodies() + k; }

  const Model& model;
  const SolverOptions& options;
  ConstraintSystem& system;
  const std::vector<double>& driveStart;
  StepReport& last;
  AxisLaws axisLaws;

  std::vector<AxisLaw> laws;                  ///< one an axis
  std::vector<Vector6> x;                     ///< residuals in, corrections out; one a node
  std::vector<std::array<double, 6>> impulse; ///< Lambda, one a constraint
  std::vector<double> couplingImpulse;        ///< one a coupling
  std::vector<double> oldRate, newRates;      ///< before and after the step, one an axis
  std::vector<double> inertiaSpread;          ///< one a movable body
  std::vector<Vec3d> gyro;                    ///< gyroscopic momentum at the current iterate, one a movable body
  Mixing mixing;
  bool relinearised = false;            ///< the current part's position solve had to leave J(q)
  std::vector<Twist> newTwist;          ///< current iterate, one a body
  std::vector<Pose> trialPose;          ///< one a body
  std::vector<Frame> frames, trial;     ///< bodies' frames at the start and at the end of the step
  std::vector<JointFrames> trialFrames; ///< one a constraint
};

} // namespace grouser::multibody::detail
