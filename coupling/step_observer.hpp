// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace grouser::coupling {

/// Stages of Simulation::step() in order. Stages absent from a scene take no time but are reported.
enum class Stage {
  surfacePoses,   ///< poses of the vehicle parts, on the host
  neighbourList,  ///< neighbour list of the grains, rebuilt if expired
  partLists,      ///< pairs of parts with parts, grains and ground, rebuilt if expired
  boundaries,     ///< grains with walls and floor, concurrent with the following stages
  posesUploaded,  ///< copy of the poses to the device
  trackContacts,  ///< shoes with wheels and sprockets
  groundContacts, ///< parts with grains or rigid ground
  partLoads,      ///< copy of the loads to the host, summed over the ranks
  grainStep,      ///< launch of the kernels for grain forces and time integration, after the grain-mesh contacts
  multibody,      ///< vehicle or mechanism, on the host, while the device works
  grainStepEnded, ///< wait for the grains; force-driven surfaces
  checks,         ///< entering grains, alarms
};
inline constexpr int kStages = static_cast<int>(Stage::checks) + 1;

/// Observer called after each stage of a step, for time measurements. An observed step has bitwise identical results,
/// but launches its work stage by stage instead of as one graph.
class StepObserver {
public:
  StepObserver() = default;
  StepObserver(const StepObserver&) = delete;
  StepObserver& operator=(const StepObserver&) = delete;
  virtual ~StepObserver() = default;
  virtual void after(Stage stage) = 0;
};

} // namespace grouser::coupling
