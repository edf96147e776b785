// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/cause.hpp"
#include "coupling/applied_loads.hpp"
#include "coupling/bodies_in_contact.hpp"
#include "coupling/inputs.hpp"
#include "coupling/ledger.hpp"
#include "coupling/simulation_setup.hpp"
#include "coupling/swing_growth.hpp"
#include "coupling/towing.hpp"
#include "coupling/vehicle_parts.hpp"
#include "coupling/vehicle_state.hpp"
#include "multibody/readings.hpp"
#include "multibody/solver.hpp"
#include "vehicle/assembly.hpp"
#include "vehicle/driver.hpp"
#include "vehicle/observers.hpp"

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace grouser::coupling {

/// Vehicle of a scene: bodies and joints, driver, contacts of its parts, and observers.
class VehicleRig : public BodiesInContact {
public:
  /// Reads the meshes, cuts them into spheres, and places the vehicle on the ground, raised by `lift` [m]; if empty,
  /// just enough to avoid contact. `ground` must outlive it; null if the vehicle hangs. `kept` as in VehicleParts.
  VehicleRig(const SimulationSetup& setup, const base::Exec& exec, Ground* ground,
             const std::function<double(double, double)>& surfaceHeight, SphereSets* kept,
             std::optional<double> lift = {});
  ~VehicleRig() override { contacts_.reset(); } // before the parts that they refer to

  void actuate() override;
  void advance() override;
  /// Sets the fluid force on all bodies in this step [N]; it counts as support in the rest check of the vehicle.
  /// Call it before alarm().
  void setFluidForce(const base::Vec3d& force) { fluidForce_ = force; }

  const multibody::Model& model() const override { return assembly_.model; }
  const multibody::Solver& solver() const override { return *solver_; }
  multibody::Solver& stepSolver() override { return *solver_; }
  const vehicle::Assembly& assembly() const { return assembly_; }
  double carriedMass() const { return carried_; } ///< mass supported by the ground at rest [kg]: with all other bodies
  const VehicleParts& parts() const { return *parts_; }

  /// Throws base::InputError if the vehicle does not have this input.
  void require(const Input& input) const;
  /// Applies the active inputs to the following steps; all have passed require().
  void command(const Inputs& inputs, const base::Vec3d& gravity);

  /// Returns an observation. Ground loads are means since the last restartMeans() of the same kind, since single steps
  /// fluctuate on grains. Means of Means::watch start with its first restart.
  vehicle::Observation observe(Means of = Means::rows) const;
  void restartMeans(Means of = Means::rows);
  const Towing* towing() const { return towing_ ? &*towing_ : nullptr; } ///< null without a hitch
  /// Mean ground force on all parts since restartMeans() [N].
  base::Vec3d meanGroundForce() const { return groundForce(rowMeans_); }
  /// Start time of the drive [s]; empty until the vehicle is at rest.
  std::optional<double> driveStart() const { return driver_.driveStart(); }
  /// Interval of alarm(), and of the track tension check, which takes a millisecond [steps].
  static constexpr std::int64_t kAlarmInterval = 50, kTensionInterval = 2000;
  /// Message about a thrown or skipping track, an excessive part rotation per step, a track tension too high for the
  /// step, a shoe beyond the terrain, or a vehicle that does not come to rest; else empty. Uses the loads since the
  /// last call, also to decide when a vehicle at rest starts to drive: call it at fixed step intervals.
  base::Alarm alarm(std::int64_t step);

  /// Message with the [stop] condition that ended the run, found by alarm(). Empty: the run continues.
  const std::string& ended() const { return ended_; }

  /// Adds the bodies' energies and momenta, and those of contacts of parts with parts and ground.
  void addTo(Ledger& ledger) const;

  /// Returns bodies, contact history and sums, for hash and checkpoint.
  VehicleState save() const;
  /// Throws InputError if the state belongs to another vehicle.
  void restore(const VehicleState& state);

private:
  /// Observer for callers that step the simulation.
  struct Watch {
    vehicle::Observer observer;
    ForceMeans forces{};
  };
  std::array<ForceMeans*, 3> means() override { return {&rowMeans_, &alarmMeans_, watch_ ? &watch_->forces : nullptr}; }
  double timeStep() const override { return timeStep_; }
  vehicle::ObserverOptions observerOptions() const;
  vehicle::GroundLoads groundLoads(const ForceMeans& means) const;
  base::Vec3d groundForce(const ForceMeans& means) const; ///< sum over all parts [N]
  vehicle::Controls controls();
  std::string judgeRest();
  std::string judgeTurns() const;
  std::string judgeTension();
  bool stalls() const;
  std::string judgeEnd() const;

  double timeStep_, largestTurn_;
  StopSetup stop_;
  base::Vec3d gravity_;
  std::optional<terrain::Rectangle> area_; ///< extent of the terrain; the vehicle must stay inside
  std::function<double(double, double)> surfaceHeight_;
  std::unique_ptr<VehicleParts> parts_;
  double lift_; ///< [m]
  vehicle::Assembly assembly_;
  std::unique_ptr<multibody::Solver> solver_;
  vehicle::Driver driver_;
  vehicle::Commands commands_; ///< external commands
  AppliedLoads applied_;       ///< external loads on bodies
  vehicle::Controls asked_;    ///< controls of the last step
  std::optional<Towing> towing_;
  double thickestStone_, heading_; ///< for observers [m], [rad]
  std::unique_ptr<vehicle::Observer> observer_;
  std::optional<Watch> watch_;
  double carried_;         ///< mass supported by the ground at rest [kg]: vehicle and all other moving bodies
  base::Vec3d fluidForce_; ///< fluid force on all bodies in this step [N]
  vehicle::BlowMeter blows_;
  PartContacts::RunningGear gear_;
  ForceMeans alarmMeans_;
  SwingGrowth swings_;          ///< oscillations of track and arms
  std::int64_t stalledSteps_{}; ///< steps in which driven tracks have not moved the hull
  std::string ended_;
};

} // namespace grouser::coupling
