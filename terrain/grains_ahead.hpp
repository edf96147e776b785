// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "terrain/grains.hpp"

namespace grouser::terrain {

/// Grain steps launched before their loads are known; coupling::StepsAhead makes them wait. flagsBefore(),
/// launchUncoupled(), launchGrains(), joinGrains() and flagsAfter() form one step and may be recorded; call
/// exchangeBuffers() after its launch and end() after the flags are copied to the host. Before end() the next step may
/// be launched, and only view() of the grains may be called.
class GrainsAhead {
public:
  /// `grains` must outlive this object.
  explicit GrainsAhead(Grains& grains) : grains_(grains) {}
  /// True on one GPU without moving surfaces.
  static bool canLaunch(const Grains& grains) { return grains.stepper_.canLaunchAhead(grains.system_); }

  contact::GrainsView view() const { return grains_.view(); }
  /// Flags of the previous step: if one is raised, this step does nothing.
  base::Watch flagsBefore() const { return grains_.stepper_.flagsBefore(grains_.system_); }
  /// Launches walls, floor and the grains without listed parts. Work queued later waits for walls and floor; the grains
  /// run concurrently with work queued before joinGrains().
  void launchUncoupled(const contact::GrainLoadsView& loads) {
    grains_.stepper_.launchUncoupled(grains_.system_, loads);
  }
  /// Launches the step of all other grains.
  void launchGrains(const contact::GrainLoadsView& loads) { grains_.stepper_.launchGrains(grains_.system_, loads); }
  void joinGrains() { grains_.stepper_.joinGrains(); }
  /// Flags to be copied to the host after the step.
  base::Parcel flagsAfter() { return grains_.stepper_.flagsAfter(grains_.system_); }
  /// Makes the result of the step the current state; a second call reverts it.
  void exchangeBuffers() { grains_.system_.arrays.swapBuffers(); }
  /// Same as Grains::endStep(). `further`: steps launched since, 0 or 1. Returns false if these have been cancelled on
  /// the device; they are also cancelled if it throws.
  bool end(int further) {
    const StepOutcome outcome = grains_.stepper_.endAhead(grains_.system_, further);
    grains_.take(outcome);
    return !outcome.listEnded;
  }

private:
  Grains& grains_;
};

} // namespace grouser::terrain
