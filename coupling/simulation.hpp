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

/// A scene that runs: grains, vehicle, or both, or a mechanism. Built settled; `step()` is the whole of the physics.
/// On several ranks all of them have one and call the same; each has its share of the grains, and all of the vehicle.
class Simulation {
public:
  /// `beds`, `spheres`: where settled beds and sphere sets come from; null: settles, or cuts, by itself.
  Simulation(SimulationSetup setup, const base::Exec& exec, const SettleProgress& progress, const base::Comm& comm = {},
             SettledBeds* beds = nullptr, SphereSets* spheres = nullptr);
  /// Goes on from a saved state of the same scene: the bits that follow are those of a run straight through. Throws
  /// InputError when the state is of another scene.
  Simulation(SimulationSetup setup, const base::Exec& exec, const SimulationState& state, const base::Comm& comm = {},
             SphereSets* spheres = nullptr);
  ~Simulation();
  Simulation(const Simulation&) = delete; // its parts refer to setup_ and to each other
  Simulation& operator=(const Simulation&) = delete;
  SimulationState save() const;

  /// One step of length timeStep(). Throws SimulationError at a fault.
  void step(StepObserver* observer = nullptr);
  /// At least one step, at most `most`: as many as can be launched as one graph, or ahead of each other. Returns how
  /// many were taken. Where it throws some may have been.
  std::int64_t advance(std::int64_t most);

  /// Sets these from outside, from the next step on, whatever step they name: all or, where it throws, none. They are
  /// kept in checkpoints, and in the state hash as long as they act. All ranks call it alike. Throws base::InputError
  /// where the scene has nothing of the kind, or a value is no number or out of range.
  void set(std::vector<Input> inputs);
  const Inputs& inputs() const { return inputs_; }

  const SimulationSetup& setup() const { return setup_; }
  double timeStep() const { return setup_.timeStep; }
  std::int64_t steps() const { return steps_; }
  double time() const { return static_cast<double>(steps_) * setup_.timeStep; } ///< since the bed has settled [s]

  const base::Comm& comm() const { return comm_; }
  const LaidGround& ground() const { return laid_; } ///< height-map, floor and grains as they lie
  /// What acts on the vehicle, or moves by itself; null where the vehicle hangs, and of a mechanism.
  const Ground* actingGround() const { return ground_.get(); }
  const GranularGround* granularGround() const { return granular_; } ///< the same where it is grains; else null
  const VehicleRig* vehicle() const { return vehicle_.get(); }
  const Mechanism* mechanism() const { return mechanism_.get(); }
  const Surfaces* surfaces() const { return surfaces_.get(); } ///< null without
  /// Restarts the means of the observers: those of the rows after every row. Only a vehicle has those of a watch.
  void restartMeans(Means of = Means::rows) {
    if (vehicle_) vehicle_->restartMeans(of);
    if (of == Means::watch) return;
    if (ground_) ground_->restartMeans();
    if (surfaces_) surfaces_->restartMeans();
    if (mechanism_) mechanism_->restartMeans();
  }
  const TakenOut& takenOut() const { return taken_; } ///< since the start
  /// By a part or mesh since restartMeans(); empty where grains meet none. All ranks call it.
  std::optional<PressedMost> pressedMost() const;
  const SettleReport& settled() const { return settled_; }

  /// Counted from the first step. All ranks call it.
  Ledger ledger();

  /// Throws SimulationError where the steps make or lose far more energy than is credible, with the likely cause. Done
  /// within the steps every EnergyGuard::kInterval; for the end of a run, which may fall in between.
  void checkEnergy();

  /// Hash over the state sorted by id, as 16 hexadecimal digits: equal bits, equal hash.
  std::string stateHash() const;

private:
  friend FluidDomain* fluidOf(const Simulation& simulation);
  friend terrain::SoilFields fieldsOf(Simulation& simulation, const terrain::FieldGrid& grid);
  void command();
  bool canStepAhead() const;
  void stepAhead(bool last);
  BodiesInContact* movingBodies(); ///< null without
  void checkAlarm();
  void addGrains();
  void takeOutCrushed();
  void afterStep();
  /// Since the grains, bodies and surfaces were made.
  Ledger wholeLedger();
  double partsElastic() const;
  std::string energyVerdict(const Ledger& now) const;
  double energyHeld(const Ledger& now) const;
  double weightHeld() const; ///< m g radius of all grains [J]
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
  /// Whether the bed settles alone, and what the scene has beyond it comes afterwards.
  bool isPutOnBed() const { return hasBed() && setup_.ground.grains->bed->alone; }
  /// In which the bed settles.
  const GroundSetup& bedGround() const { return isPutOnBed() ? *setup_.ground.grains->bed->alone : setup_.ground; }

  SimulationSetup setup_; ///< changes no more once things stand on the settled bed
  base::Exec exec_;
  base::Comm comm_;
  LaidGround laid_;
  std::unique_ptr<Ground> ground_;    ///< null without; refers to laid_
  GranularGround* granular_{nullptr}; ///< ground_ where it is grains
  SettleReport settled_;
  std::vector<double> lifts_;          ///< of what is put on a settled bed; see liftsOnto()
  std::unique_ptr<Surfaces> surfaces_; ///< null without
  std::unique_ptr<VehicleRig> vehicle_;
  std::unique_ptr<Mechanism> mechanism_;
  std::unique_ptr<FluidDomain> fluid_; ///< null without
  BodiesInContact* touching_{nullptr}; ///< vehicle, or mechanism with shapes; null without
  std::unique_ptr<StepsAhead> ahead_;  ///< of steps that can be launched ahead; made by the first
  EnergyGuard guard_;
  Inputs inputs_;       ///< from outside
  base::Vec3d gravity_; ///< now [m/s2]
  std::int64_t steps_{0};
  TakenOut taken_;
  Ledger start_; ///< before the first step; the ledger counts from here
};

/// Throws base::InputError if Simulation::set() would refuse the input. Not collective: one rank may call it alone.
void require(const Simulation& simulation, const Input& input);

/// Place of a body among those of the vehicle or mechanism, for InputKind::bodyLoad. Throws base::InputError with the
/// nearest name.
std::int32_t bodyIndex(const Simulation& simulation, const std::string& name);

/// Its fluid, which probing does not change; null without.
FluidDomain* fluidOf(const Simulation& simulation);

/// How the meshes of vehicle and scene were cut; those of parts that touch nothing have no entry.
std::vector<spheredecomp::CutReport> cutReports(const Simulation& simulation);

/// Fields of the soil now, of a scene with grains; see terrain::measureFields(). All ranks call it.
terrain::SoilFields fieldsOf(Simulation& simulation, const terrain::FieldGrid& grid);

} // namespace grouser::coupling
