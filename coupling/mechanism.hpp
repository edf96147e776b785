// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/math.hpp"
#include "coupling/applied_loads.hpp"
#include "coupling/bodies_in_contact.hpp"
#include "coupling/inputs.hpp"
#include "coupling/ledger.hpp"
#include "coupling/mechanism_setup.hpp"
#include "coupling/mechanism_state.hpp"
#include "coupling/step_controller.hpp"
#include "coupling/swing_growth.hpp"
#include "multibody/solver.hpp"
#include "multibody/state.hpp"

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace grouser::coupling {

/// A mechanism of a scene that moves: model, state and solver, with drives that follow their laws over time.
class Mechanism : public BodiesInContact {
public:
  /// `ground`: touches the bodies' shapes, and outlives it; null without. `obstacles`: surfaces at rest that the shapes
  /// touch. `kept` as in VehicleParts.
  Mechanism(const MechanismSetup& setup, double timeStep, const base::Exec& exec = base::cpuExec(1),
            Ground* ground = nullptr, const std::vector<Obstacle>& obstacles = {}, SphereSets* kept = nullptr);

  bool touches() const { return contacts_ != nullptr; }

  /// Throws base::InputError where the mechanism has nothing that the input could set.
  void require(const Input& input) const;
  /// From the next step on what acts among these; all have passed require().
  void command(const Inputs& inputs, const base::Vec3d& gravity);

  void actuate() override;
  /// One step, after actuate(). Throws base::SimulationError, also where the motion has become too quick for the step:
  /// at every kJudgeInterval-th step the turn of each body and the pull in joints and springs are judged.
  void advance() override;
  static constexpr std::int64_t kJudgeInterval = 50;

  const multibody::Model& model() const override { return model_; }
  const multibody::Solver& solver() const override { return solver_; }
  multibody::Solver& stepSolver() override { return solver_; }

  void addTo(Ledger& ledger) const;

  /// Kinetic energy that the drives gave in an impact, since the velocities of the scene did not fit theirs [J].
  double startBlow() const { return startBlow_; }

  /// Up to which step a swing across the tension of joints and springs does not grow [s]; infinite without. `part`, if
  /// given, receives the name of what has the greatest part in it.
  double stableStepUnderTension(std::string* part = nullptr) {
    return solver_.stabilityLimit() / solver_.geometricStiffnessRate(state_, loads_, part);
  }
  /// What the last judgement of a pull above what the step bears says: when and where the tension of joints and springs
  /// first needed a shorter step, and which; empty: never, nor now.
  const std::string& tensionStepWarning();
  /// End stops off which a bounce has too few steps, in words; empty: none, or steps follow an error.
  std::string bounceNote();

  /// How well the joints are closed.
  struct Drift {
    double position = 0;   ///< largest since the last call of restartMeans() [m, rad]
    double velocity = 0;   ///< now [m/s, rad/s]
    int iterations = 0;    ///< most of a step since then
    int singularSteps = 0; ///< steps through a singular position since then
  };
  Drift drift() const;
  void restartMeans() { worst_ = {}, rowMeans_.restart(); }

  /// What its steps were; null where they are fixed.
  const StepController* controller() const { return controller_.get(); }

  MechanismState save() const;
  /// Throws base::InputError where the state is of another mechanism.
  void restore(const MechanismState& saved);

private:
  std::array<ForceMeans*, 3> means() override { return {&rowMeans_, nullptr, nullptr}; }
  double timeStep() const override { return timeStep_; }
  void checkTravel() const;
  void watchDrift();
  void judge();
  void judgeTurns() const;
  void judgeTension();
  void watchTension();
  double checkTension();
  [[noreturn]] void fail(base::Cause cause, const std::string& message) const;

  const double timeStep_, largestTurn_;
  const multibody::Model model_;
  multibody::Solver solver_;
  double startBlow_;
  Drift worst_;
  std::int64_t steps_ = 0;
  double boundedTension_ = 0; ///< up to this force in joints and springs the step is short enough [N]
  std::string tensionStepWarning_;
  bool overTension_ = false; ///< the pull was above what the step bears when last looked at
  SwingGrowth swings_;
  std::unique_ptr<StepController> controller_; ///< null: fixed steps
  std::vector<double> startTurn_;              ///< of each body in the first step [rad]
  AppliedLoads applied_;                       ///< from outside, where bodies touch something
  double mostTravel_ = 0;                      ///< largest travel of a surface point in a step [m]
};

} // namespace grouser::coupling
