// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "multibody/detail/axis_laws.hpp"
#include "multibody/detail/integrator.hpp"
#include "multibody/detail/mixing.hpp"
#include "multibody/detail/rotation_simd.hpp"

#include <array>
#include <vector>

namespace grouser::multibody::detail {

/// Constrained symplectic Euler scheme, described in euler_step.cpp.
class EulerStep : public Stepper {
public:
  explicit EulerStep(const Problem& problem);
  void step(State& state, const Loads& loads, double dt) override;
  void startResponse(const State& state, const Loads& loads, double dt, std::vector<Twist>& twists) override;
  void respond(const std::vector<Wrench>& impulses, std::vector<Twist>& change) override;

private:
  /// Phases of the position solve, as in RATTLE (rattle_step.cpp).
  enum class Phase { kAllRows, kWithoutWeakRows, kMixed, kEachIterate };
  /// Progress of the position solve of a step.
  struct PositionSolve {
    Phase phase = Phase::kAllRows;
    int lost = 0;                    ///< number of rows without a pivot
    int iterations = 0, since = 0;   ///< number of iterations: total; in the current phase
    double gap = 0, before = 0;      ///< largest gap of the last iteration; of the previous one
    bool done = false, slow = false; ///< result of the last iteration

    void enter(Phase next) { phase = next, since = 0; }
  };

  void solvePart(const ConstraintSystem::Part& part, State& state, const Loads& loads, double dt);
  void iterate(const ConstraintSystem::Part& part, const State& state, double dt, PositionSolve& solve);
  bool advance(const ConstraintSystem::Part& part, const State& state, const Loads& loads, double dt,
               PositionSolve& solve);
  bool advanceAllRows(const ConstraintSystem::Part& part, const State& state, const Loads& loads, double dt,
                      PositionSolve& solve);
  void advanceWithoutWeakRows(const ConstraintSystem::Part& part, const State& state, double dt, PositionSolve& solve);
  void relinearise(const ConstraintSystem::Part& part, const State& state, double dt, const PositionSolve& solve);
  void setFirstResidual(const ConstraintSystem::Part& part, const State& state, const Loads& loads, double dt);
  void applyCorrection(const ConstraintSystem::Part& part, double dt);
  double setGapResidual(const ConstraintSystem::Part& part, const State& state, double dt, bool first);
  bool startWithoutWeakRows(const ConstraintSystem::Part& part, const State& state, const Loads& loads, double dt);
  [[noreturn]] void fail(const State& state, double gap, int iterations, double dt) const;
  struct OpenRow {
    int constraint = -1, row = 0;
    double gap = 0; ///< [m, rad]
  };
  OpenRow widestGap() const;
  double openGap() const;
  void finish(const ConstraintSystem::Part& part, State& state, const Loads& loads, double dt);
  void addAngularMomentum(int k, const Vec3d& force, const Vec3d& torque, State& state) const;
  void readConstraint(int k, State& state, double dt);
  void addAxes(int k, std::array<double, 6>& total, State& state, double dt);
  void readAxes(int k, const std::array<double, 6>& total, State& state, double dt) const;
  double trialPosition(const State& state, int axis) const;
  JointFrames trialFramesOf(int k) const;

  /// Four bodies and their joints during a step (euler_links.cpp).
  struct alignas(64) LinkStep {
    Vec3L v0, w0, force, torque; ///< before the step
    Vec3L position;
    QuatL orientation;
    Vec3L v, w, gyro; ///< current iterate and its gyroscopic momentum
    FrameL trial;     ///< frame at the end of the step
    QuatL newOrientation;
    JointFramesL joint;
    Lanes impulse[6];
    Lanes oldRate[2];         ///< axis rates before the step
    Lanes startCos, startSin; ///< cosine and sine of the joint angle before the step
    Lanes spread;             ///< spread of the inertias (spreadOf())
    // Energy ledger.
    Vec3L gyroLeft;           ///< gyroscopic momentum of the old twist minus the one used for the new twist
    Vec3L parentV0, parentW0; ///< twist of the parent before the step
  };
  void startLinks(const State& state, const Loads& loads, double dt);
  void startLinkAxes(const State& state, double dt);
  void correctLinks(double dt);
  void unpackIterate();
  void packTwists();
  static void solveAngularVelocity(const Lanes (&inertia)[6], LinkStep& s, int l, double dt);
  void moveLinks(double dt);
  double setLinkGaps(double dt, bool first);
  double setLinkGyro(double dt);
  void takeGyroResiduals();
  /// Work of four bodies and their joints in a step [J].
  struct LinkWork {
    Lanes gravity, external, drive, spring, dissipated;
    // Terms of ledger.hpp. `fall`: sum of m g.v.
    Lanes kinetic, turnover, fall, jointDamping, springDamping, stopDamping;
    Vec3d ground, groundMoment; ///< impulse from immovable bodies on the movable ones
  };
  /// Velocity of the point p_B of B relative to A, and angular velocity of B relative to A.
  Twist relativeTwist(int k, const std::vector<Twist>& twist) const;
  // Defined in euler_ledger.cpp
  void noteOldMotion(const ConstraintSystem::Part& part, const State& state);
  void noteOldLengths(const State& state);
  void recordElasticGain(State& state, const Loads& loads) const;
  void recordCoupling(int c, const State& state);
  void recordConstraint(int k, const Vec3d& force, const Vec3d& torque, const State& state);
  void recordGround(int k, const Vec3d& force, const Vec3d& torque);
  void recordWork(double work);
  void recordMixedSpins(const State& state);
  void bookSeveralPlaces(const State& state);
  void finishLinks(State& state, const Loads& loads, double dt);
  void finishBodies(const LinkLanes& b, const LinkStep& s, State& state, const Loads& loads, double dt,
                    LinkWork& work) const;
  void finishJoints(const LinkLanes& b, const LinkStep& s, State& state, double dt, LinkWork& work) const;
  void addAxis(const LinkLanes& b, const LinkStep& s, int a, const Lanes& newRate, double dt, Lanes& total,
               LinkWork& work) const;
  void readAxis(const LinkLanes& b, const LinkStep& s, int a, const Lanes& total, const Lanes& newRate, State& state,
                double dt) const;
  void addSolution(const ConstraintSystem::Part& part, std::vector<Twist>& twists);
  int rowNode(int k) const { return system_.movableBodies() + k; }

  const Model& model_;
  const SolverOptions& options_;
  ConstraintSystem& system_;
  const std::vector<double>& driveStart_;
  StepReport& last_;
  AxisLaws axisLaws_;

  std::vector<AxisLaw> laws_;                  ///< one per axis
  std::vector<Vector6> x_;                     ///< residuals in, corrections out; one per node
  std::vector<LinkStep> steps_;                ///< one per batch of links
  std::vector<std::array<double, 6>> impulse_; ///< Lambda, one per constraint; for tree joints computed on demand
  std::vector<double> couplingImpulse_;        ///< one per coupling
  std::vector<double> oldRate_, newRates_;     ///< before and after the step, one per axis
  double mass_ = 0;                            ///< total mass of the movable bodies
  StepLedger stepLedger_;
  std::vector<Vec3d> oldSpin_; ///< angular momenta before the step
  bool firstSolve_ = true;     ///< true after the residuals are reset
  Twist fromOutside_;          ///< impulse of gravity and loads, with its moment about the origin
  struct SpringPlace {
    std::size_t joint;
    bool slide;
  };
  static double positionIn(const State& state, const SpringPlace& p) {
    return p.slide ? state.slide[p.joint].position : state.joint[p.joint].position;
  }
  std::vector<SpringPlace> springPlace_; ///< one per axis spring
  std::vector<double> oldLength_;        ///< before the step: axis springs, point springs, six per bushing
  std::vector<Twist> oldMotion_;         ///< before the step, one per constraint outside the tree
  std::vector<double> oldCouplingRate_;  ///< before the step, two per coupling
  Mixing mixing_;
  bool relinearised_ = false;         ///< the position solve has relinearised
  std::vector<Twist> newTwist_;       ///< current iterate, one per body, if mixing needs it
  std::vector<Pose> placed_;          ///< body poses after the last step, equal to trial_
  std::vector<Frame> frames_, trial_; ///< body frames at the start and at the end of the step
};

} // namespace grouser::multibody::detail
