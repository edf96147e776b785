// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace grouser::coupling {

/// What Simulation::step() does, in this order. What a scene does not have takes no time and is reported all the same.
enum class Stage {
  surfacePoses,   ///< poses of the vehicle's parts, on the host
  neighbourList,  ///< of the grains, made anew where it has ended
  partLists,      ///< pairs of parts with parts, grains and ground, made anew where they have ended
  boundaries,     ///< grains with walls and floor, beside what follows
  posesUploaded,  ///< to the device
  trackContacts,  ///< shoes with wheels and sprockets
  groundContacts, ///< parts with grains or rigid ground
  partLoads,      ///< to the host, summed over the ranks
  grainStep,      ///< forces on grains and their advance are launched; grains with meshes before that
  multibody,      ///< vehicle or mechanism, on the host, while the device works
  grainStepEnded, ///< the host waits for the grains; surfaces that forces move
  checks,         ///< grains that enter, alarms
};
inline constexpr int kStages = static_cast<int>(Stage::checks) + 1;

/// Called after each stage of a step, to measure where the time goes. An observed step gives the same bits, but
/// launches its work piece by piece instead of as one graph.
class StepObserver {
public:
  StepObserver() = default;
  StepObserver(const StepObserver&) = delete;
  StepObserver& operator=(const StepObserver&) = delete;
  virtual ~StepObserver() = default;
  virtual void after(Stage stage) = 0;
};

} // namespace grouser::coupling
