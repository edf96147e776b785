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

/// Runs and times parts of a scene on this machine.
namespace grouser::forecast {

using support::Stopwatch;

/// Step times by part [s].
struct StepTimes {
  /// A group of consecutive steps.
  struct Group {
    double steps = 0, seconds = 0; ///< total of the group
    double lists = 0, parts = 0;   ///< shares of the time: neighbour lists; vehicle, mechanism, meshes [-]
    double grains = 0;             ///< mean number of grains
  };
  std::vector<Group> groups;

  /// Mean over the last third of the measured time.
  Group last() const;
};

/// Steps the simulation for about `seconds` of wall time, at most up to step `total`. Throws SimulationError if a step
/// fails.
StepTimes timeSteps(coupling::Simulation& simulation, const base::Exec& exec, double seconds, std::int64_t total);

/// Cost of the steps of a run [s].
struct StepCost {
  double grains = 0, lists = 0, parts = 0;
  double whole() const { return grains + lists + parts; }
};
/// Cost of a run of `steps` steps, estimated from a probe with `stride` times longer steps: list rebuilds scale with
/// simulated time, other costs with the number of steps. Later steps cost the same as the last third of the probe; if
/// grains still enter (mean number `later`), costs are extrapolated by a line fitted to the groups.
StepCost costOfRun(const StepTimes& times, double steps, double stride, double later);

/// Time of a neighbour-list rebuild [s]. The simulation cannot be stepped afterwards.
double timeOfLists(coupling::Simulation& simulation, const base::Exec& exec);

/// A small settled piece of a bed.
struct SettledTile {
  double grains = 0;
  double steps = 0;     ///< number of steps until rest
  double rebuilds = 0;  ///< neighbour list rebuilds until rest
  double seconds = 0;   ///< wall time [s]
  double falling = 0;   ///< mean time per step until rest, without lists [s]
  double resting = 0;   ///< time of a step at rest [s]
  double list = 0;      ///< time of a neighbour list rebuild [s]
  double fallen = 0;    ///< share of the steps until 0.1 s after the last grain has fallen [-]
  bool complete = true; ///< whether the tile came to rest within the time limit
};
/// Settles the tile of a part from pieceOf(). `prepared`: with the friction used to prepare a given porosity.
SettledTile settleTile(const coupling::GroundSetup& piece, bool prepared, const base::Exec& exec, double seconds);

/// The scene with a level, poured bed of at most `most` grains that is copied from a small settled tile and is large
/// enough for the vehicle.
scene::Scene pieceOf(const scene::Scene& scene, double grains, double most);
/// The scene with short drive ramps, so that the next steps cost the same as most steps of the run.
scene::Scene hurried(const scene::Scene& scene);
/// Duration of these ramps [s].
inline constexpr double kHurry = 0.03;
/// The scene with softer contacts, which allow `stride` times longer steps.
scene::Scene softened(const scene::Scene& scene, double timeStep, double stride);
/// Setup of a part of the scene with a settled bed that does not settle again.
coupling::SimulationSetup copiedBed(const scene::Scene& piece);

} // namespace grouser::forecast
