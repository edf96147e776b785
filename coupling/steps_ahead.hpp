// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/device_graph.hpp"
#include "base/gate.hpp"
#include "coupling/granular_ground.hpp"
#include "coupling/vehicle_rig.hpp"
#include "terrain/grains_ahead.hpp"

namespace grouser::coupling {

/// Steps of a vehicle on grains whose work is launched before it is known where the vehicle will be. Walls, floor and
/// the grains without a listed part advance at once; part contacts and all other grains wait at a gate for the poses
/// that the host solves. So neither waits for a launch, and the same is computed as by Simulation::step().
///
/// On one GPU. Where a list of grains ends, or a grain is at fault, the device calls the next step off by itself; where
/// a list of parts is about to end, the next step is not launched ahead. A part that is thrown out of its list within
/// one such step ends the run with an error, where Simulation::step() would go on.
class StepsAhead {
public:
  /// Both outlive it.
  StepsAhead(const base::Exec& exec, GranularGround& ground, VehicleRig& vehicle);
  StepsAhead(const StepsAhead&) = delete;
  StepsAhead& operator=(const StepsAhead&) = delete;
  ~StepsAhead();

  // One step, in this order, with the poses set and the lists valid.
  /// Launches it where that has not been done ahead, and lets it pass.
  void begin();
  /// Launches the next one, unless lists end before.
  void launchNext();
  /// Computes the host contacts of this step while the device works.
  void computeOnHost();
  void awaitLoads() { gate_.await(base::Gate::kFirst); }
  /// Waits for the grains. Throws as terrain::Grains::endStep().
  void end();

  /// Whether the next step is under way: until it is over no list may be made, and nobody may wait for the device.
  bool nextIsLaunched() const { return launched_ > 0; }
  /// After an exception: waits for what is under way, and calls off what is not. Then the positions and velocities are
  /// those of the step that has begun last, but contact springs, remainders and energy sums may be those of the next
  /// one: inspect this state, but do not step it further.
  void callOff();

private:
  void launch();

  terrain::GrainsAhead grains_;
  GrainsOnParts& onParts_;
  VehicleRig& vehicle_;
  base::Gate gate_;
  base::DoubleBufferedGraph graph_;
  std::int64_t listings_{-1}; ///< of the lists that the graph holds
  int launched_{0};           ///< steps that have not begun
  bool begun_{false};         ///< one that has not ended
};

} // namespace grouser::coupling
