// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/carry.hpp"
#include "base/device_graph.hpp"
#include "contact/grain_loads.hpp"
#include "terrain/grain_system.hpp"

#include <span>

namespace grouser::terrain {

/// Outcome of the launched steps, identical on all ranks.
struct StepOutcome {
  int taken{};           ///< number of steps taken, at least one
  bool listEnded{};      ///< a grain has moved half the skin: the next step needs a new list
  std::uint64_t fault{}; ///< as in StepFlags; kNoFault if there is none
};

/// Time stepper of the grains: launches the kernels on several streams, so that communication and boundaries overlap
/// with the grain step, and reads the flags raised by the kernels.
class GrainStepper {
public:
  explicit GrainStepper(const base::Exec& exec);

  static constexpr int kStepsPerGraph = 16;

  /// Launches contacts with walls and floor on a side stream, joined by begin(). They read the current grain state and
  /// write loads, masks and springs by slot, so slots must not change in between. Does nothing in scenes with
  /// surfaces, since their poses for this step may be unknown yet: begin() then computes the contacts.
  void beginBoundaries(GrainSystem& system);
  bool boundariesBegun() const { return boundariesBegun_; }
  /// Launches one step without waiting. `loads`: loads of rigid parts; null without parts.
  void begin(GrainSystem& system, const contact::GrainLoadsView* loads);
  /// Waits for the step launched by begin() and reduces its flags across ranks.
  StepOutcome end(GrainSystem& system);

  // Steps launched ahead of their loads; see GrainsAhead. Each step has its own flags, by the buffer of its initial
  // state, and is skipped if the previous step has raised a flag.
  bool canLaunchAhead(const GrainSystem& system) const;
  base::Watch flagsBefore(const GrainSystem& system) const;
  /// Launches walls, floor and the grains without listed parts.
  void launchUncoupled(GrainSystem& system, const contact::GrainLoadsView& loads);
  /// Launches all other grains.
  void launchGrains(GrainSystem& system, const contact::GrainLoadsView& loads);
  void joinGrains() { aside_.join(); }
  base::Parcel flagsAfter(const GrainSystem& system);
  /// Returns the outcome of the copied flags. `further`: steps launched since. If a flag is raised, waits for the
  /// device, which has cancelled those steps, and swaps their buffers back.
  StepOutcome endAhead(GrainSystem& system, int further);

  /// True if kStepsPerGraph steps can be launched as one graph, without the host in between.
  bool canBatchSteps(const GrainSystem& system) const;
  /// Launches kStepsPerGraph steps as one graph; fewer are executed if a list expires or a fault is raised.
  StepOutcome runBatch(GrainSystem& system);
  /// Call when slots or lists change: the graph contains their pointers and counts, and must be recorded again.
  void forgetGraph() { stepGraph_.forget(); }

private:
  /// One of several steps launched together; its kernels do nothing if the previous step has raised a flag.
  struct Launch {
    GrainSystem& system;
    const contact::GrainLoadsView* loads;
    int place = 0;   ///< index of the step's flags
    int former = -1; ///< index of the previous step's flags; -1: none
  };

  GrainKernelData kernelData(const Launch& step);
  void launch(const Launch& step);
  void launchImpulses(const Launch& step);
  void launchSubdomain(const Launch& step);
  void computeBoundaryContacts(const base::Exec& exec, const Launch& step);
  /// Advances the grains of `slots`; duplicates must be adjacent and count once.
  void advanceListed(const base::Exec& exec, const Launch& step, std::span<const std::uint32_t> slots);
  /// Advances all grains except those with a nonzero entry in `excluded`, by slot; null: no exclusions.
  void advanceUnless(const base::Exec& exec, const Launch& step, const std::uint32_t* excluded);
  static void advance(const base::Exec& exec, GrainSystem& s, const GrainKernelData& d, std::int64_t count);
  Launch ahead(GrainSystem& system, const contact::GrainLoadsView* loads);
  static int placeAhead(const GrainSystem& system);
  void clearFlags();
  StepOutcome readFlags(int steps);

  static_assert(kStepsPerGraph % 2 == 0, "so that the buffers of the state and of the ghosts' exchange end where they "
                                         "began, and a recorded batch can follow itself");

  base::Exec exec_;
  base::Mirrored<StepFlags> flags_; ///< flags of each step of a batch
  base::DoubleBufferedGraph stepGraph_;
  base::SideStream side_;  ///< highest priority: ghosts, and masters, which depend on them
  base::SideStream aside_; ///< lowest priority: walls and floor, and grains without listed parts
  bool boundariesBegun_{false};
};

} // namespace grouser::terrain
