// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/exec.hpp"
#include "coupling/simulation.hpp"
#include "runs/session/run_request.hpp"
#include "runs/setup/record_setup.hpp"
#include "runs/storage/bed_cache.hpp"
#include "runs/storage/checkpoint.hpp"
#include "runs/storage/sphere_cache.hpp"

#include <memory>
#include <optional>

/// From a compiled scene to a simulation that is ready to step: settled or resumed.
namespace grouser::session {

/// Preparation of the bed, or of the tile from which the bed is copied; null without a target porosity.
const coupling::PreparationSetup* preparationOf(const coupling::GroundSetup& ground);

/// Caches of settled beds and sphere sets; empty: not used.
struct Caches {
  std::optional<storage::BedCache> beds;
  std::optional<storage::SphereCache> spheres;
  double settling = 0; ///< wall time of settling; 0 for a cached bed [s]
};
/// The user's caches, if the request allows caches. `beds`: whether the scene's bed may be cached (terrain.cache).
Caches cachesOf(bool beds, const RunRequest& request);

/// Reads the checkpoint of a run to be resumed and compares the scenes; null for a run from the start.
std::unique_ptr<storage::Checkpoint> formerRun(const setup::Provenance& provenance, const RunRequest& request);

/// Throws InputError if the scene's automatic time step differs from that of the checkpoint.
void requireSameStep(const storage::Checkpoint& former, double timeStep, const setup::Provenance& provenance,
                     const RunRequest& request);

/// Simulation at the checkpoint, or at the start after settling the bed, with progress on stderr. An error of settling
/// leaves a FailedBed. Throws Stopped, SimulationError, InputError.
std::unique_ptr<coupling::Simulation> makeSimulation(coupling::SimulationSetup setup, const setup::RecordSetup& record,
                                                     const base::Exec& exec, const storage::Checkpoint* former,
                                                     const RunRequest& request, Caches& kept);

} // namespace grouser::session
