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

/// Pieces of a scene's work, run and timed on this machine.
namespace grouser::forecast {

using support::Stopwatch;

/// How long a step takes, by what works in it [s].
struct StepTimes {
  /// Steps that have been taken in turn.
  struct Group {
    double steps = 0, seconds = 0; ///< of all of them
    double lists = 0, parts = 0;   ///< shares of the time: neighbour lists; vehicle, mechanism, meshes [-]
    double grains = 0;             ///< mean number
  };
  std::vector<Group> groups;

  /// Mean of the last third of the time.
  Group last() const;
};

/// Steps the simulation for about so long, at most up to step `total`. Throws SimulationError as its steps do.
StepTimes timeSteps(coupling::Simulation& simulation, const base::Exec& exec, double seconds, std::int64_t total);

/// What a run's steps take [s].
struct StepCost {
  double grains = 0, lists = 0, parts = 0;
  double whole() const { return grains + lists + parts; }
};
/// Of a run of `steps` steps that the probe has begun, each `stride` times as long: lists end as often in a second of
/// the run, all else in a step. What comes after the probe's steps costs what their last third did; where grains still
/// enter (`later` of them will be there in the mean), along the line through the groups.
StepCost costOfRun(const StepTimes& times, double steps, double stride, double later);

/// One list of neighbours made anew [s]; the simulation takes no step afterwards.
double timeOfLists(coupling::Simulation& simulation, const base::Exec& exec);

/// A small piece of a bed that has come to rest.
struct SettledTile {
  double grains = 0;
  double steps = 0;     ///< until it rested
  double rebuilds = 0;  ///< neighbour lists made until then
  double seconds = 0;   ///< all that took [s]
  double falling = 0;   ///< mean time a step until then, lists left out [s]
  double resting = 0;   ///< of a step at rest [s]
  double list = 0;      ///< of a neighbour list [s]
  double fallen = 0;    ///< share of the steps until the last grain has fallen, and a tenth of a second [-]
  bool complete = true; ///< it came to rest within the time given
};
/// Settles the tile of a piece made by pieceOf(): prepared as a porosity asks, where the scene has one.
SettledTile settleTile(const coupling::GroundSetup& piece, bool prepared, const base::Exec& exec, double seconds);

/// The scene on a level bed of at most `most` grains, copied from a small settled tile, as poured; a vehicle keeps the
/// room that it stands on.
scene::Scene pieceOf(const scene::Scene& scene, double grains, double most);
/// The scene with its drive come on at once, so that the steps that follow cost what most of the run's do.
scene::Scene hurried(const scene::Scene& scene);
/// How long the ramps of that take [s].
inline constexpr double kHurry = 0.03;
/// The scene with contacts so much softer that steps may be `stride` times as long: it comes to pass in fewer of them.
scene::Scene softened(const scene::Scene& scene, double timeStep, double stride);
/// Its setup, with a bed that is not settled again.
coupling::SimulationSetup copiedBed(const scene::Scene& piece);

} // namespace grouser::forecast
