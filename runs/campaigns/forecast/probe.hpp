// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "coupling/simulation.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/simulation_setup.hpp"
#include "runs/support/stopwatch.hpp"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

/// Pieces of a scene, run and timed on this machine.
namespace grouser::forecast {

using support::Stopwatch;

/// Step times by part [s].
struct StepTimes {
  /// A group of consecutive steps.
  struct Group {
    double steps = 0, seconds = 0; ///< total of the group
    double lists = 0, parts = 0;   ///< shares of the time: neighbour lists; vehicle, mechanism, meshes [-]
    double grains = 0;             ///< mean number
  };
  std::vector<Group> groups;

  /// Mean over the last third of the time.
  Group last() const;
};

/// Steps the simulation for about `seconds` of wall time, at most up to step `total`. Throws SimulationError of a step.
StepTimes timeSteps(coupling::Simulation& simulation, const base::Exec& exec, double seconds, std::int64_t total);

/// Cost of the steps of a run [s].
struct StepCost {
  double grains = 0, lists = 0, parts = 0;
  double whole() const { return grains + lists + parts; }
};
/// Cost of a run of `steps` steps from a probe whose steps are `stride` times as long: list rebuilds per simulated
/// time, other costs per step. Later steps cost as the last third of the probe; while grains enter (mean number
/// `later`), costs are extrapolated by the line through the groups.
StepCost costOfRun(const StepTimes& times, double steps, double stride, double later);

/// Time of a neighbour list rebuild [s]; the simulation takes no step afterwards.
double timeOfLists(coupling::Simulation& simulation, const base::Exec& exec);

/// A small settled piece of a bed.
struct SettledTile {
  double grains = 0;
  double steps = 0;     ///< until rest
  double rebuilds = 0;  ///< neighbour list rebuilds until rest
  double seconds = 0;   ///< wall time [s]
  double falling = 0;   ///< mean time per step until rest, without lists [s]
  double resting = 0;   ///< time of a step at rest [s]
  double list = 0;      ///< time of a neighbour list rebuild [s]
  double fallen = 0;    ///< share of the steps until 0.1 s after the last grain has fallen [-]
  bool complete = true; ///< it came to rest within the time given
};
/// Settles the tile of a piece from pieceOf(); `prepared`: with the preparation for a porosity.
SettledTile settleTile(const coupling::GroundSetup& piece, bool prepared, const base::Exec& exec, double seconds);

/// The scene on a level, poured bed of at most `most` grains, copied from a small settled tile, but large enough for
/// the vehicle.
scene::Scene pieceOf(const scene::Scene& scene, double grains, double most);
/// The scene with short ramps of the drive, so that the next steps cost as most steps of the run.
scene::Scene hurried(const scene::Scene& scene);
/// Duration of these ramps [s].
inline constexpr double kHurry = 0.03;
/// The scene with softer contacts that allow steps `stride` times as long.
scene::Scene softened(const scene::Scene& scene, double timeStep, double stride);
/// Setup of a piece whose bed is not settled again.
coupling::SimulationSetup copiedBed(const scene::Scene& piece);

} // namespace grouser::forecast
