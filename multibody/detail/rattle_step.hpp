// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "multibody/detail/integrator.hpp"
#include "multibody/detail/mixing.hpp"
#include "multibody/detail/soft_rows.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace grouser::multibody::detail {

/// RATTLE on the rotation group, order 2, and its symmetric compositions. The scheme is described in rattle_step.cpp.
class RattleStep : public Stepper {
public:
  explicit RattleStep(const Problem& problem);
  void step(State& state, const Loads& loads, double dt) override;

private:
  using Part = ConstraintSystem::Part;
  /// Phases of the position solve, described with the scheme.
  enum class Phase { kAllRows, kWithoutWeakRows, kMixed, kEachIterate };

  /// Progress of the position solve of a stage.
  struct PositionSolve {
    Phase phase = Phase::kAllRows;
    double tolerance = 0; ///< gap tolerance [m, rad]
    int lost = 0;         ///< number of rows without a pivot
    int iterations = 0;   ///< total
    // Current phase.
    int since = 0;                                                        ///< iterations
    double best = std::numeric_limits<double>::infinity(), before = best; ///< smallest gap, last gap
    // Last iteration.
    double gap = 0;      ///< largest gap of rows with a pivot
    double open = 0;     ///< largest gap of all rows
    bool follow = false; ///< true: soft rows differ too much from the factored matrix
    bool done = false, slow = false;

    void enter(Phase next) { phase = next, since = 0, best = before = std::numeric_limits<double>::infinity(); }
  };
  /// Largest gaps so far: of rows with a pivot, and of all rows. NaN counts as the largest.
  struct Gaps {
    double largest = 0, open = 0;
    static void takeLarger(double& most, double gap) {
      if (!(std::fabs(gap) <= most)) most = std::fabs(gap);
    }
    void take(double gap, bool hasPivot) {
      takeLarger(open, gap);
      if (hasPivot) takeLarger(largest, gap);
    }
  };

  void stage(State& state, const Loads& loads, double h);
  /// Linearises at `where`. Returns the number of rows without a pivot.
  int linearise(const Part& part, const std::vector<Frame>& where);
  bool positionsFactored(const Part& part) const;

  // Position solve: Newton's method and its phases (rattle_phases.cpp).
  void solvePositions(const Part& part, const State& state, const Loads& loads, double h);
  double gapTolerance(const Part& part, const State& state) const;
  void iterate(const Part& part, const State& state, double h, PositionSolve& solve);
  bool advance(const Part& part, const State& state, const Loads& loads, double h, PositionSolve& solve);
  bool advanceAllRows(const Part& part, const State& state, const Loads& loads, double h, PositionSolve& solve);
  void advanceWithoutWeakRows(const Part& part, PositionSolve& solve);
  bool startWithoutWeakRows(const Part& part, const State& state, const Loads& loads, double h);
  int closeWeakRows(const Part& part, const State& state, double h);
  [[noreturn]] void fail(const Part& part, const State& state, double gap, double h) const;

  // Unknowns and residuals (rattle_position.cpp).
  void startAxes(const Part& part, const State& state, double h);
  void predictSoftRows(const Part& part, double h);
  void setFirstResidual(const Part& part, const State& state, const Loads& loads, double h);
  bool updateAxes(const Part& part, double h);
  void applyCorrection(const Part& part, double h);
  void moveTrial(const Part& part, const State& state, double h);
  /// Computes the row residuals; returns the largest gap of the rows with a pivot, in units of position.
  double setResiduals(const Part& part, double h);
  void setResidual(int k, double h, Gaps& gaps);
  void collectMomentum(const Part& part, const State& state, const Loads& loads, double h);

  // Velocity stage (rattle_velocity.cpp).
  void solveVelocities(const Part& part, const Loads& loads, double h);
  void factorEnd(const Part& part);
  void setSecondKick(const Part& part, const Loads& loads, double h);
  void addEndImpulses(const Part& part);
  double setRateResiduals(const Part& part);
  void finish(const Part& part, State& state, const Loads& loads, double h);
  void finishAxis(int a, State& state, double h);

  // Ledger of the kicks (rattle_ledger.cpp).
  /// Adds an impulse along a row to the vectors of its bodies, and an impulse from an immovable body to the ledger.
  void give(int k, int row, double impulse);
  void accountFirstKick(const Part& part, const State& state, const Loads& loads, double h);
  void bookSecondKick(const Part& part, const Loads& loads, double h);
  struct Kick {
    Twist before, after;
    Vec3d spinBefore, spinAfter;
    Vec3d impulse, moment; ///< totals [N s], [N m s]
    Vec3d place;           ///< position of the centre of mass
  };
  void recordKick(int b, const Mat3d& inertia, const Kick& kick, const Loads& loads, double h);

  // Readings (rattle_velocity.cpp).
  void readReactions(const Part& part, State& state, const Loads& loads);
  void readConstraint(int k, State& state);

  /// Spring force at the nodes.
  double nodeForce(const SoftRow& row, double position) const {
    return implicitSprings_ ? 0 : row.constant - row.stiffness * position;
  }
  ForceAndSlope meanForce(int axis, double h) const;
  int rowNode(int k) const { return system_.movableBodies() + k; }

  const Model& model_;
  const SolverOptions& options_;
  ConstraintSystem& system_;
  StepReport& last_;
  SoftRows softRows_;
  bool implicitSprings_;
  double stageTime_ = 0; ///< time at the beginning of the stage

  std::vector<SoftRow> soft_;       ///< one per axis
  std::vector<double> x0_, x1_;     ///< axis positions at the beginning and at the end of the stage
  std::vector<double> softImpulse_; ///< h / 2 times the mean force of the implicit part of an axis
  std::vector<double> startRate_;   ///< rates of driven axes at the beginning of the stage
  std::vector<double> axisRate_, springForce_, axisForce_; ///< values at the end of the step
  std::vector<AxisLaw> laws_;                              ///< arguments of linearise(), one per axis
  std::vector<Vector6> x_;                                 ///< residuals in, corrections out; one per node
  std::vector<std::array<double, 6>> impulse_; ///< row impulses of the position stage, then of the velocity stage
  std::vector<std::array<double, 6>> endImpulse_;
  std::vector<double> couplingImpulse_, couplingEndImpulse_;
  std::vector<Vec3d> gyro_;           ///< gyroscopic momentum at the current iterate, one per movable body
  std::vector<double> inertiaSpread_; ///< one per movable body
  /// Ledger terms of one stage.
  StepLedger stepLedger_;
  std::vector<char> toGround_;  ///< per constraint: one body is immovable
  std::vector<Vector6> kick_;   ///< known impulses of the second half kick, one per movable body
  std::vector<Vec3d> meanSpin_; ///< angular momentum between the half kicks, one per movable body
  std::vector<Vec3d> spin_;     ///< angular momentum after the first half kick, one per movable body
  std::vector<Twist> mean_;     ///< twist over the stage, one per body
  std::vector<Twist> twist_;    ///< twist at the end of the stage, one per body
  std::vector<Pose> trialPose_;
  std::vector<Frame> frames_, trial_;
  std::vector<JointFrames> startFrames_, trialFrames_; ///< one per constraint
  std::vector<char> relinearised_;                     ///< per part: the position stage has relinearised
  std::vector<long long> factored_;                    ///< per part: linearisation at the end of the last stage, or -1
  std::vector<double> gapOf_;                          ///< per part: largest gap at the current iterate
  Mixing mixing_;
  std::vector<char> drivenThen_; ///< per axis: true if driven in the linearisation of factored_
};

/// Stability limit of omega dt [rad] for the composition of an order with explicit springs.
double stabilityLimit(int order);

} // namespace grouser::multibody::detail
