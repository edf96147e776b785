// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/carry.hpp"
#include "base/device_graph.hpp"
#include "contact/grain_loads.hpp"
#include "terrain/grain_system.hpp"

#include <span>

namespace grouser::terrain {

/// Outcome of the steps launched, the same on all ranks.
struct StepOutcome {
  int taken{};           ///< steps, at least one
  bool listEnded{};      ///< a grain has moved half the skin: the next step needs a new list
  std::uint64_t fault{}; ///< as StepFlags has it; kNoFault where there is none
};

/// Takes steps: launches the kernels on two streams, so that communication and boundaries overlap with the grains, and
/// reads the flags that the kernels have raised.
class GrainStepper {
public:
  explicit GrainStepper(const base::Exec& exec);

  static constexpr int kStepsPerGraph = 16;

  /// Launches contacts with walls and floor on a side stream that begin() joins. They read the grains' present state
  /// and write loads, masks and springs by slot, so slots must not change in between. Does nothing with surfaces, whose
  /// poses for this step may not be known yet: then begin() computes the contacts.
  void beginBoundaries(GrainSystem& system);
  bool boundariesBegun() const { return boundariesBegun_; }
  /// Launches one step, without waiting. `loads`: of rigid parts; null without them.
  void begin(GrainSystem& system, const contact::GrainLoadsView* loads);
  /// Waits for the step launched by begin() and reduces its flags across ranks.
  StepOutcome end(GrainSystem& system);

  // A step that is launched ahead of its loads; see GrainsAhead. Each has flags of its own, by the buffer that holds
  // the state it begins with, and does nothing where the step before it has raised one.
  bool canLaunchAhead(const GrainSystem& system) const;
  base::Watch flagsBefore(const GrainSystem& system) const;
  /// Launches walls, floor and the grains without a listed part.
  void launchUncoupled(GrainSystem& system, const contact::GrainLoadsView& loads);
  /// Launches all other grains.
  void launchGrains(GrainSystem& system, const contact::GrainLoadsView& loads);
  void joinGrains() { aside_.join(); }
  base::Parcel flagsAfter(const GrainSystem& system);
  /// Outcome of the copied flags. `further`: steps launched since. If a flag is raised, waits for the device, which has
  /// cancelled them, and swaps their buffers back.
  StepOutcome endAhead(GrainSystem& system, int further);

  /// Whether kStepsPerGraph steps can be launched as one graph, without the host in between.
  bool canBatchSteps(const GrainSystem& system) const;
  /// Launches kStepsPerGraph steps as one graph; fewer are taken if a list expires or a fault is raised.
  StepOutcome runBatch(GrainSystem& system);
  /// Must be called when slots or lists change: the graph holds their pointers and counts, so it is recorded again.
  void forgetGraph() { stepGraph_.forget(); }

private:
  /// One of several steps launched together: kernels do nothing if the previous step has raised a flag.
  struct Launch {
    GrainSystem& system;
    const contact::GrainLoadsView* loads;
    int place = 0;   ///< of its flags
    int former = -1; ///< of those of the step before it; -1: none
  };

  GrainKernelData kernelData(const Launch& step);
  void launch(const Launch& step);
  void launchImpulses(const Launch& step);
  void launchSubdomain(const Launch& step);
  void computeBoundaryContacts(const base::Exec& exec, const Launch& step);
  /// Advances the grains of `slots`; equal slots are side by side and count once.
  void advanceListed(const base::Exec& exec, const Launch& step, std::span<const std::uint32_t> slots);
  /// Advances all grains but those with a nonzero entry in `excluded`, by slot; null excludes none.
  void advanceUnless(const base::Exec& exec, const Launch& step, const std::uint32_t* excluded);
  static void advance(const base::Exec& exec, GrainSystem& s, const GrainKernelData& d, std::int64_t count);
  Launch ahead(GrainSystem& system, const contact::GrainLoadsView* loads);
  static int placeAhead(const GrainSystem& system);
  void clearFlags();
  StepOutcome readFlags(int steps);

  static_assert(kStepsPerGraph % 2 == 0, "so that the buffers of the state and of the ghosts' exchange end where they "
                                         "began, and a recorded batch can follow itself");

  base::Exec exec_;
  base::Mirrored<StepFlags> flags_; ///< of each step of a batch
  base::DoubleBufferedGraph stepGraph_;
  base::SideStream side_;  ///< highest priority: ghosts, and masters, which read them
  base::SideStream aside_; ///< lowest priority: walls and floor, and grains without a listed part
  bool boundariesBegun_{false};
};

} // namespace grouser::terrain
