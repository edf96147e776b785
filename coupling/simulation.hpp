// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "coupling/energy_guard.hpp"
#include "coupling/granular_ground.hpp"
#include "coupling/inputs.hpp"
#include "coupling/ledger.hpp"
#include "coupling/mechanism.hpp"
#include "coupling/pressed_grain.hpp"
#include "coupling/settled_beds.hpp"
#include "coupling/settled_ground.hpp"
#include "coupling/simulation_setup.hpp"
#include "coupling/simulation_state.hpp"
#include "coupling/step_observer.hpp"
#include "coupling/steps_ahead.hpp"
#include "coupling/surfaces.hpp"
#include "coupling/vehicle_rig.hpp"

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

namespace grouser::terrain {
class GrainFault;
}

namespace grouser::coupling {

class FluidDomain;

/// Running scene: grains, a vehicle, both, or a mechanism. The constructor settles the bed; `step()` contains all
/// physics. All members are collective; each rank has its share of the grains, and the whole vehicle.
class Simulation {
public:
  /// `beds`, `spheres`: sources of settled beds and sphere sets; null: the simulation creates them itself.
  Simulation(SimulationSetup setup, const base::Exec& exec, const SettleProgress& progress, const base::Comm& comm = {},
             SettledBeds* beds = nullptr, SphereSets* spheres = nullptr);
  /// Resumes a saved state of the same scene, bitwise identical to an uninterrupted run. Throws InputError if the state
  /// belongs to another scene.
  Simulation(SimulationSetup setup, const base::Exec& exec, const SimulationState& state, const base::Comm& comm = {},
             SphereSets* spheres = nullptr);
  ~Simulation();
  Simulation(const Simulation&) = delete; // its parts refer to setup_ and to each other
  Simulation& operator=(const Simulation&) = delete;
  SimulationState save() const;

  /// Advances one step of length timeStep(). Throws SimulationError on a fault.
  void step(StepObserver* observer = nullptr);
  /// Advances at least one step and at most `most`: as many as can be launched as one graph or ahead of one another.
  /// Returns the number of steps. If it throws, some steps may have been completed.
  std::int64_t advance(std::int64_t most);

  /// Sets inputs for the following steps, regardless of their `step`; if it throws, it sets no input. Inputs are stored
  /// in checkpoints, and in the state hash while active. Collective, with the same inputs. Throws base::InputError if
  /// the scene lacks the input, or a value is not finite or out of range.
  void set(std::vector<Input> inputs);
  const Inputs& inputs() const { return inputs_; }

  const SimulationSetup& setup() const { return setup_; }
  double timeStep() const { return setup_.timeStep; }
  std::int64_t steps() const { return steps_; }
  double time() const { return static_cast<double>(steps_) * setup_.timeStep; } ///< since the end of settling [s]

  const base::Comm& comm() const { return comm_; }
  const LaidGround& ground() const { return laid_; } ///< height map, floor and current grains
  /// Ground in contact with vehicle and bodies, or grains alone; null if the scene has neither terrain nor grains.
  const Ground* actingGround() const { return ground_.get(); }
  const GranularGround* granularGround() const { return granular_; } ///< actingGround() if granular, else null
  const VehicleRig* vehicle() const { return vehicle_.get(); }
  const Mechanism* mechanism() const { return mechanism_.get(); }
  const Surfaces* surfaces() const { return surfaces_.get(); } ///< null if there are none
  /// Restarts the means of the observers: Means::rows after every output row. Only a vehicle has Means::watch.
  void restartMeans(Means of = Means::rows) {
    if (vehicle_) vehicle_->restartMeans(of);
    if (of == Means::watch) return;
    if (ground_) ground_->restartMeans();
    if (surfaces_) surfaces_->restartMeans();
    if (mechanism_) mechanism_->restartMeans();
  }
  const CrushedGrains& crushedGrains() const {
    return taken_;
  } ///< grains removed since the start because they were crushed
  /// Deepest overlap with a part or mesh since restartMeans(); empty without grains in contact. Collective.
  std::optional<DeepestPartOverlap> deepestPartOverlap() const;
  const SettleReport& settled() const { return settled_; }

  /// Ledger counted from the first step. Collective.
  Ledger ledger();

  /// Throws SimulationError, with the likely cause, if time integration creates or loses too much energy. Steps call it
  /// every EnergyGuard::kInterval; call it also at the end of a run, which may be between two checks.
  void checkEnergy();

  /// Hash of the state sorted by id, as 16 hexadecimal digits: equal states have equal hashes.
  std::string stateHash() const;

private:
  friend FluidDomain* fluidOf(const Simulation& simulation);
  friend terrain::SoilFields fieldsOf(Simulation& simulation, const terrain::FieldGrid& grid);
  void command();
  bool canStepAhead() const;
  void collectLoads();
  void stepAhead(bool last);
  BodiesInContact* movingBodies(); ///< null if there are none
  void checkAlarm();
  void addGrains();
  void takeOutCrushed();
  void afterStep();
  /// Ledger since the creation of grains, bodies and surfaces.
  Ledger wholeLedger();
  double partsElastic() const;
  std::string energyVerdict(const Ledger& now) const;
  double energyHeld(const Ledger& now) const;
  double weightHeld() const; ///< m g radius of all grains [J]
  /// Energy error since the last check that the solver of complementarity contacts may cause [J]; empty without it.
  std::optional<double> solverError() const;
  void checkEnergy(const Ledger& now);
  template <class Advance> void namingCause(const Advance& advance);
  base::Alarm alarmOf(const terrain::GrainFault& fault);
  PressedGrain pressed(std::uint32_t grain);
  std::string impactNote(const Ledger& now) const;
  void makeActingGround();
  void makeMechanism(SphereSets* spheres);
  void makeFluid(const FluidDomainState* former);
  void addFluidLoads();
  void makeVehicle(SphereSets* spheres, std::optional<double> lift = {});
  void requireRoomForBodies();
  void makeSurfaces(const SurfaceStates* former);
  void makeMeshContacts(SphereSets* spheres);
  bool hasBed() const { return setup_.ground.grains && setup_.ground.grains->bed; }
  /// True if the bed settles first and the rest of the scene is added afterwards.
  bool isPutOnBed() const { return hasBed() && setup_.ground.grains->bed->alone; }
  /// Ground in which the bed settles.
  const GroundSetup& bedGround() const { return isPutOnBed() ? *setup_.ground.grains->bed->alone : setup_.ground; }

  SimulationSetup setup_; ///< constant once objects are placed on the settled bed
  base::Exec exec_;
  base::Comm comm_;
  LaidGround laid_;
  std::unique_ptr<Ground> ground_;    ///< null if there is none; refers to laid_
  GranularGround* granular_{nullptr}; ///< ground_ if it is granular
  SettleReport settled_;
  std::vector<double> lifts_;          ///< lifts of objects placed on a settled bed; see liftsOnto()
  std::unique_ptr<Surfaces> surfaces_; ///< null if there are none
  std::unique_ptr<VehicleRig> vehicle_;
  std::unique_ptr<Mechanism> mechanism_;
  std::unique_ptr<FluidDomain> fluid_; ///< null if there is none
  BodiesInContact* touching_{nullptr}; ///< vehicle, or mechanism with shapes; else null
  std::unique_ptr<StepsAhead> ahead_;  ///< steps launched ahead; created by the first such step
  EnergyGuard guard_;
  Inputs inputs_;       ///< external inputs
  base::Vec3d gravity_; ///< current gravity [m/s2]
  std::int64_t steps_{0};
  CrushedGrains taken_;
  Ledger start_; ///< reference: ledger before the first step
};

/// Throws base::InputError if Simulation::set() would reject the input. Not collective: a single rank may call it.
void require(const Simulation& simulation, const Input& input);

/// Index of a body of the vehicle or mechanism, for InputKind::bodyLoad. Throws base::InputError with the nearest name.
/// The index is InputKind::bodyLoad's target.
std::int32_t bodyIndex(const Simulation& simulation, const std::string& name);

/// The fluid of a simulation; null if there is none.
FluidDomain* fluidOf(const Simulation& simulation);

/// Sphere cuts of the meshes of vehicle and scene; parts without contacts have no entry.
std::vector<spheredecomp::CutReport> cutReports(const Simulation& simulation);

/// Current soil fields of a scene with grains; see terrain::measureFields(). Collective.
terrain::SoilFields fieldsOf(Simulation& simulation, const terrain::FieldGrid& grid);

} // namespace grouser::coupling
