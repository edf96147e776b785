// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/exec.hpp"
#include "runs/campaigns/forecast/probe.hpp"
#include "runs/scene/scene.hpp"
#include "runs/session/output_times.hpp"

/// Typical times of the parts of a run, used without measurements on this machine.
namespace grouser::forecast {

/// Typical times on a CPU of about 2020 with SIMD, and on an H100.
struct TypicalTimes {
  double grain = 0;   ///< time per grain and step [s]
  double list = 0;    ///< neighbour-list rebuild, per grain [s]
  double parts = 0;   ///< vehicle, mechanism or meshes, per step [s]
  double placing = 0; ///< creation of parts and their tables, and placement on the ground [s]
  double cutting = 0; ///< generation of the sphere sets of a vehicle [s]
  double reading = 0; ///< reading a cached bed, per grain [s]
  session::OutputTimes output;
};

/// Number of CPU threads with a separate core; 1 on a GPU.
int usefulThreads(const base::Exec& exec);

/// Number of contacts of grains with the tracks of a vehicle on soil: one layer of grains over the ground contact area.
double pairsBelowTracks(const scene::Scene& scene);

/// Typical times for a scene of `grains` grains. `spheres`: total of the vehicle's unique sphere sets; 0: unknown, or
/// no vehicle.
TypicalTimes typicalTimes(const scene::Scene& scene, double grains, double spheres, const base::Exec& exec);

/// Tile assumed without a probe: at rest after 0.7 s, with typical times of steps and list rebuilds.
SettledTile typicalTile(const TypicalTimes& times, double timeStep);

} // namespace grouser::forecast
