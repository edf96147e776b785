// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/exec.hpp"
#include "runs/campaigns/forecast/probe.hpp"
#include "runs/scene/scene.hpp"
#include "runs/session/output_times.hpp"

/// Typical times of the parts of a run, without measurements on this machine.
namespace grouser::forecast {

/// Typical times on a CPU with SIMD of about 2020, and on an H100.
struct TypicalTimes {
  double grain = 0;   ///< step of a grain [s]
  double list = 0;    ///< neighbour list rebuild, a grain [s]
  double parts = 0;   ///< step of a vehicle, mechanism or meshes [s]
  double placing = 0; ///< parts with their tables, placed on the ground [s]
  double cutting = 0; ///< sphere sets of a vehicle [s]
  double reading = 0; ///< reading a grain of a cached bed [s]
  session::OutputTimes output;
};

/// CPU threads that have a core of their own; 1 on a GPU.
int usefulThreads(const base::Exec& exec);

/// Contacts of the grains below the tracks of a vehicle on soil: one layer of grains over the ground contact.
double pairsBelowTracks(const scene::Scene& scene);

/// Typical times for a scene of `grains` grains. `spheres`: total of the vehicle's unique sphere sets; 0: unknown, or
/// no vehicle.
TypicalTimes typicalTimes(const scene::Scene& scene, double grains, double spheres, const base::Exec& exec);

/// Assumed tile without a probe: at rest after 0.7 s, with typical times of steps and lists.
SettledTile typicalTile(const TypicalTimes& times, double timeStep);

} // namespace grouser::forecast
