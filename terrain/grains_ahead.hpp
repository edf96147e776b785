// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "terrain/grains.hpp"

namespace grouser::terrain {

/// Steps of grains that are launched before their loads are known; coupling::StepsAhead has them wait. What
/// flagsBefore(), launchUncoupled(), launchGrains(), joinGrains() and flagsAfter() give makes up one step and may be
/// recorded; exchangeBuffers() comes after its launch, end() once its flags have been carried to the host. While one is
/// under way the next one may be launched, and nothing else be done with the grains but view().
class GrainsAhead {
public:
  /// `grains` outlive it.
  explicit GrainsAhead(Grains& grains) : grains_(grains) {}
  /// On one GPU, without moving surfaces.
  static bool canLaunch(const Grains& grains) { return grains.stepper_.canLaunchAhead(grains.system_); }

  contact::GrainsView view() const { return grains_.view(); }
  /// Raised by the step before: then this one does nothing.
  base::Watch flagsBefore() const { return grains_.stepper_.flagsBefore(grains_.system_); }
  /// Launches walls, floor and the grains without a listed part. Later queued work waits for walls and floor; the
  /// grains run concurrently with all that is queued before joinGrains().
  void launchUncoupled(const contact::GrainLoadsView& loads) {
    grains_.stepper_.launchUncoupled(grains_.system_, loads);
  }
  /// Queues the step of all other grains.
  void launchGrains(const contact::GrainLoadsView& loads) { grains_.stepper_.launchGrains(grains_.system_, loads); }
  void joinGrains() { grains_.stepper_.joinGrains(); }
  /// To be carried to the host behind it.
  base::Parcel flagsAfter() { return grains_.stepper_.flagsAfter(grains_.system_); }
  /// Makes what the step writes the state; a second time takes that back.
  void exchangeBuffers() { grains_.system_.arrays.swapBuffers(); }
  /// As Grains::endStep(). `further`: steps launched since, 0 or 1. False where they have been called off, which the
  /// device has then done with; they are too where it throws.
  bool end(int further) {
    const StepOutcome outcome = grains_.stepper_.endAhead(grains_.system_, further);
    grains_.take(outcome);
    return !outcome.listEnded;
  }

private:
  Grains& grains_;
};

} // namespace grouser::terrain
