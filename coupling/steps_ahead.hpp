// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/device_graph.hpp"
#include "base/gate.hpp"
#include "coupling/granular_ground.hpp"
#include "coupling/vehicle_rig.hpp"
#include "terrain/grains_ahead.hpp"

namespace grouser::coupling {

/// Steps of a vehicle on grains; their work is launched before the vehicle poses are known. Walls, floor and the grains
/// without listed parts advance at once; part contacts and all other grains wait at a gate for the poses computed by
/// the host. Launch latency is hidden, and the results are those of Simulation::step().
///
/// For one GPU. If a grain list expires, or at a grain fault, the device cancels the next step; if a part list is about
/// to expire, the next step is not launched ahead. A part that leaves its list within one such step ends the run with
/// an error, where Simulation::step() would continue.
class StepsAhead {
public:
  /// Both arguments must outlive it.
  StepsAhead(const base::Exec& exec, GranularGround& ground, VehicleRig& vehicle);
  StepsAhead(const StepsAhead&) = delete;
  StepsAhead& operator=(const StepsAhead&) = delete;
  ~StepsAhead();

  // One step, in this order, with the poses set and the lists valid.
  /// Launches the step unless it was launched ahead, and opens its gate.
  void begin();
  /// Launches the next step, unless lists expire first.
  void launchNext();
  /// Computes the host contacts of this step while the device works.
  void computeOnHost();
  void awaitLoads() { gate_.await(base::Gate::kFirst); }
  /// Waits for the grains. Throws like terrain::Grains::endStep().
  void end();

  /// True if the next step is launched: until it ends, no list may be built, and no thread may wait for the device.
  bool nextIsLaunched() const { return launched_ > 0; }
  /// Call after an exception: waits for running work, and cancels the rest. Positions and velocities are then those of
  /// the last step begun, but contact springs, remainders and energy sums may be those of the next one: this state may
  /// be inspected, but not stepped further.
  void callOff();

private:
  void launch();

  terrain::GrainsAhead grains_;
  GrainsOnParts& onParts_;
  VehicleRig& vehicle_;
  base::Gate gate_;
  base::DoubleBufferedGraph graph_;
  std::int64_t listings_{-1}; ///< PartContacts::listings() of the lists used by the graph
  int launched_{0};           ///< number of launched steps that have not begun
  bool begun_{false};         ///< a step has begun and not ended
};

} // namespace grouser::coupling
