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

/// Moving mechanism of a scene: model, state and solver, with drives that follow their laws over time.
class Mechanism : public BodiesInContact {
public:
  /// `ground`: ground in contact with the bodies' shapes; may be null; must outlive this object. `obstacles`: surfaces
  /// at rest in contact with the shapes. `kept` as in VehicleParts.
  Mechanism(const MechanismSetup& setup, double timeStep, const base::Exec& exec = base::cpuExec(1),
            Ground* ground = nullptr, const std::vector<Obstacle>& obstacles = {}, SphereSets* kept = nullptr);

  bool touches() const { return contacts_ != nullptr; }

  /// Throws base::InputError if the mechanism does not have this input.
  void require(const Input& input) const;
  /// Applies the active inputs to the following steps; all have passed require().
  void command(const Inputs& inputs, const base::Vec3d& gravity);

  void actuate() override;
  /// Advances one step, after actuate(). Throws base::SimulationError, also if the motion is too fast for the step: the
  /// rotation of each body and the tension of joints and springs are checked every kJudgeInterval steps.
  void advance() override;
  static constexpr std::int64_t kJudgeInterval = 50;

  const multibody::Model& model() const override { return model_; }
  const multibody::Solver& solver() const override { return solver_; }
  multibody::Solver& stepSolver() override { return solver_; }

  void addTo(Ledger& ledger) const;

  /// Kinetic energy added by the drives at the start [J], if the initial velocities of the scene do not match theirs.
  double startBlow() const { return startBlow_; }

  /// Longest step for which transverse oscillations under the tension of joints and springs do not grow [s]; infinite
  /// without tension. `part`, if given, receives the name of the joint or spring that contributes most.
  double stableStepUnderTension(std::string* part = nullptr) {
    return solver_.stabilityLimit() / solver_.geometricStiffnessRate(state_, loads_, part);
  }
  /// Message with the time and place at which the tension of joints and springs first required a shorter step, and the
  /// length of that step; empty if that has not happened so far.
  const std::string& tensionStepWarning();
  /// Message about an end stop with too few steps per bounce; empty if there is none, or if steps are error-controlled.
  std::string bounceNote();

  /// Constraint errors of the joints.
  struct Drift {
    double position = 0;   ///< maximum since the last restartMeans() [m, rad]
    double velocity = 0;   ///< current value [m/s, rad/s]
    int iterations = 0;    ///< maximum number of iterations per step since then
    int singularSteps = 0; ///< number of steps through a singular position since then
  };
  Drift drift() const;
  void restartMeans() { worst_ = {}, rowMeans_.restart(); }

  /// The step controller; null for fixed steps.
  const StepController* controller() const { return controller_.get(); }

  MechanismState save() const;
  /// Throws base::InputError if the state belongs to another mechanism.
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
  double boundedTension_ = 0; ///< maximum force in joints and springs for which the step is short enough [N]
  std::string tensionStepWarning_;
  bool overTension_ = false; ///< the tension exceeded the step's limit at the last check
  SwingGrowth swings_;
  std::unique_ptr<StepController> controller_; ///< null: fixed steps
  std::vector<double> startTurn_;              ///< rotation of each body in the first step [rad]
  AppliedLoads applied_;                       ///< external loads, if bodies have contacts
  double maxTravel_ = 0;                       ///< maximum travel of a surface point in a step [m]
};

} // namespace grouser::coupling
