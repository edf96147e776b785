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
struct TakenOut {
  double grains{}, mass{}; ///< [-], [kg]
  double energy{};         ///< their kinetic, potential and elastic energy [J]
  base::Vec3d momentum;    ///< [N s]
};

/// State of a simulation that later steps or later output depend on. Independent of device, threads and lists.
struct SimulationState {
  std::int64_t steps{};
  std::vector<double> surface; ///< nodes of the undisturbed bed [m]; empty without one
  SettleReport settled;
  std::optional<terrain::BedStructure> bed; ///< before anything touched it
  std::vector<double> ledgerAtStart;        ///< Ledger::counted(): the ledger counts from here
  std::vector<double> guard;                ///< EnergyGuard::save()
  std::optional<terrain::GrainState> grains;
  std::optional<std::vector<double>> ground; ///< of a ground that is neither granular nor rigid, in its own form
  std::optional<SurfaceStates> surfaces;
  std::optional<VehicleState> vehicle;
  std::optional<MechanismState> mechanism;
  std::optional<FluidDomainState> fluid;
  std::vector<double> lifts;  ///< of objects placed on a settled bed [m]; empty without
  TakenOut taken;             ///< since the start
  std::vector<double> inputs; ///< Inputs::save(); empty without inputs

  /// 16 hexadecimal digits over the data that the next step depends on: equal bits, equal hash, on any number of ranks,
  /// all of which call it.
  std::string hash(const base::Comm& comm = {}) const;
};

} // namespace grouser::coupling
