// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace grouser::coupling {

/// Stages of Simulation::step() in order. Stages that a scene lacks take no time but are reported.
enum class Stage {
  surfacePoses,   ///< poses of the vehicle's parts, on the host
  neighbourList,  ///< of the grains, rebuilt if it has expired
  partLists,      ///< pairs of parts with parts, grains and ground, rebuilt if they have expired
  boundaries,     ///< grains with walls and floor, concurrent with the following stages
  posesUploaded,  ///< to the device
  trackContacts,  ///< shoes with wheels and sprockets
  groundContacts, ///< parts with grains or rigid ground
  partLoads,      ///< to the host, summed over the ranks
  grainStep,      ///< forces on grains and their advance are launched; grains with meshes before that
  multibody,      ///< vehicle or mechanism, on the host, while the device works
  grainStepEnded, ///< the host waits for the grains; force-driven surfaces
  checks,         ///< grains that enter, alarms
};
inline constexpr int kStages = static_cast<int>(Stage::checks) + 1;

/// Called after each stage of a step, for time measurements. An observed step gives the same bits, but launches its
/// work stage by stage instead of as one graph.
class StepObserver {
public:
  StepObserver() = default;
  StepObserver(const StepObserver&) = delete;
  StepObserver& operator=(const StepObserver&) = delete;
  virtual ~StepObserver() = default;
  virtual void after(Stage stage) = 0;
};

} // namespace grouser::coupling
