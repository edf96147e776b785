// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "coupling/fluid_domain_setup.hpp"
#include "coupling/mechanism_state.hpp"
#include "coupling/settled_ground.hpp"
#include "coupling/surface_state.hpp"
#include "coupling/vehicle_state.hpp"
#include "terrain/grain_state.hpp"

#include <optional>
#include <string>
#include <vector>

namespace grouser::coupling {

/// Grains that were crushed to their centre and removed.
struct CrushedGrains {
  double grains{}, mass{}; ///< [-], [kg]
  double energy{};         ///< their kinetic, potential and elastic energy [J]
  base::Vec3d momentum;    ///< [N s]
};

/// Simulation state that later steps or output depend on. Independent of device, threads and lists.
struct SimulationState {
  std::int64_t steps{};
  std::vector<double> surface; ///< node heights of the undisturbed bed [m]; empty without a bed
  SettleReport settled;
  std::optional<terrain::BedStructure> bed; ///< structure of the bed before any contact
  std::vector<double> ledgerAtStart;        ///< Ledger::counted() at the reference time of the ledger
  std::vector<double> guard;                ///< EnergyGuard::save()
  std::optional<terrain::GrainState> grains;
  std::optional<std::vector<double>> ground; ///< state of a ground that is neither granular nor rigid, in its format
  std::optional<SurfaceStates> surfaces;
  std::optional<VehicleState> vehicle;
  std::optional<MechanismState> mechanism;
  std::optional<FluidDomainState> fluid;
  std::vector<double> lifts;  ///< lifts of objects placed on a settled bed [m]; empty without such objects
  CrushedGrains taken;        ///< grains removed since the start
  std::vector<double> inputs; ///< Inputs::save(); empty without inputs

  /// Hash of the data that the next step depends on, as 16 hexadecimal digits: equal bits, equal hash, for any
  /// number of ranks. Collective.
  std::string hash(const base::Comm& comm = {}) const;
};

} // namespace grouser::coupling
