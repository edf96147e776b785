// SPDX-License-Identifier: BSD-3-Clause
#include "terrain/grain_stepper.hpp"

#include "base/gate.hpp"
#include "terrain/grain_kernels.cuh"

#include <algorithm>
#include <cstring>
#include <functional>
#include <utility>

namespace grouser::terrain {

GrainStepper::GrainStepper(const base::Exec& exec)
    : exec_(exec), flags_(exec, kStepsPerGraph), stepGraph_(exec), side_(exec, true), aside_(exec) {
  std::fill_n(flags_.host(), flags_.size(), kNoFlags);
  flags_.upload();
}

GrainKernelData GrainStepper::kernelData(const Launch& step) {
  GrainKernelData d = step.system.kernelData();
  if (step.loads) d.features |= kLoads, d.loads = *step.loads;
  d.flags = flags_.device().data() + step.place;
  d.former = step.former >= 0 ? flags_.device().data() + step.former : nullptr;
  return d;
}

void GrainStepper::advance(const base::Exec& exec, GrainSystem& s, const GrainKernelData& d, std::int64_t count) {
  const GrainModel& model = s.constants.model;
  if (model.precision == Precision::single)
    runGrainStep(exec, d, s.forceData<float>(), count, model);
  else
    runGrainStep(exec, d, s.forceData<double>(), count, model);
}

void GrainStepper::advanceListed(const base::Exec& exec, const Launch& step, std::span<const std::uint32_t> slots) {
  GrainKernelData d = kernelData(step);
  d.active = slots.data();
  advance(exec, step.system, d, static_cast<std::int64_t>(slots.size()));
}

void GrainStepper::advanceUnless(const base::Exec& exec, const Launch& step, const std::uint32_t* excluded) {
  GrainKernelData d = kernelData(step);
  d.excluded = excluded;
  advance(exec, step.system, d, d.count);
}

void GrainStepper::computeBoundaryContacts(const base::Exec& exec, const Launch& step) {
  GrainSystem& s = step.system;
  s.boundaries.clearSurfaceLoads();
  if (!s.boundaries.any()) return;
  const auto near = static_cast<std::int64_t>(s.boundaries.grainsListed());
  const GrainModel& model = s.constants.model;
  if (model.precision == Precision::single)
    runBoundaryContacts(exec, kernelData(step), s.forceData<float>(), near, model);
  else
    runBoundaryContacts(exec, kernelData(step), s.forceData<double>(), near, model);
}

void GrainStepper::beginBoundaries(GrainSystem& system) {
  if (system.boundaries.hasSurfaces() || system.impulses) return;
  aside_.fork();
  computeBoundaryContacts(aside_.exec(), {system, nullptr});
  boundariesBegun_ = true;
}

bool GrainStepper::canLaunchAhead(const GrainSystem& system) const {
  return base::Gate::canWait(exec_) && !system.distribution && !system.boundaries.hasSurfaces() && !system.impulses;
}

/// Index of the flags of a step launched ahead: the same as the index of the buffer with its initial state.
int GrainStepper::placeAhead(const GrainSystem& system) {
  const auto& position = system.arrays.fields().position;
  return std::less<>()(position.next.data(), position.now.data()) ? 1 : 0;
}

base::Watch GrainStepper::flagsBefore(const GrainSystem& system) const {
  base::Watch watch{flags_.device().data() + 1 - placeAhead(system)};
  static_assert(sizeof watch.idle == sizeof kNoFlags);
  std::memcpy(watch.idle, &kNoFlags, sizeof kNoFlags);
  return watch;
}

GrainStepper::Launch GrainStepper::ahead(GrainSystem& system, const contact::GrainLoadsView* loads) {
  const int place = placeAhead(system);
  return {system, loads, place, 1 - place};
}

void GrainStepper::launchUncoupled(GrainSystem& system, const contact::GrainLoadsView& loads) {
  const Launch step = ahead(system, nullptr);
  aside_.fork();
  computeBoundaryContacts(aside_.exec(), step);
  aside_.join(); // waits for the boundaries, but not for the grains queued after them
  advanceUnless(aside_.exec(), step, loads.range);
}

void GrainStepper::launchGrains(GrainSystem& system, const contact::GrainLoadsView& loads) {
  advanceListed(exec_, ahead(system, &loads), {loads.slot, static_cast<std::size_t>(loads.count)});
}

base::Parcel GrainStepper::flagsAfter(const GrainSystem& system) {
  const int place = placeAhead(system);
  return {flags_.host() + place, flags_.device().data() + place, sizeof(StepFlags)};
}

StepOutcome GrainStepper::endAhead(GrainSystem& system, int further) {
  // The buffers have been swapped once for this step and once for each later step.
  const StepFlags flags = flags_.host()[(placeAhead(system) + 1 + further) % 2];
  if (flags.raised()) {
    base::synchronize(exec_);
    clearFlags();
    if (further % 2 != 0) system.arrays.swapBuffers();
  }
  return {1, flags.stale != 0, flags.fault};
}

void GrainStepper::launch(const Launch& step) {
  GrainSystem& s = step.system;
  if (s.impulses) return launchImpulses(step);
  if (std::exchange(boundariesBegun_, false))
    aside_.join();
  else
    computeBoundaryContacts(exec_, step);
  if (s.distribution)
    launchSubdomain(step);
  else
    advanceUnless(exec_, step, nullptr);
  s.arrays.swapBuffers();
}

/// Solves all contacts of the step together, with the host in between.
void GrainStepper::launchImpulses(const Launch& step) {
  GrainSystem& s = step.system;
  s.boundaries.clearSurfaceLoads();
  s.finishGhostUpdate();
  s.impulses->step(s, kernelData(step));
  if (s.distribution) s.distribution->packGhosts(exec_, s.arrays);
  s.arrays.swapBuffers();
}

/// Main stream: the uniques, which have no ghost among their neighbours. Side stream, of higher priority: waits for the
/// ghosts' states and unpacks them into their slots, advances the masters, which read them, and packs the new master
/// states for other ranks. The two streams write different slots.
void GrainStepper::launchSubdomain(const Launch& step) {
  GrainSystem& s = step.system;
  const Subdomain& subdomain = s.distribution->subdomain();
  side_.fork();
  // On a CPU: over the list of uniques, in SIMD. On a GPU: over all slots, with early return for masters and slaves,
  // since reading the slot from a list would add one memory latency before every other load.
  if (exec_.onCpu())
    advanceListed(exec_, step, {subdomain.uniques().data(), subdomain.uniques().size()});
  else
    advanceUnless(exec_, step, subdomain.roles());
  s.distribution->finishGhostUpdate(side_.exec(), s.arrays);
  advanceListed(side_.exec(), step, {subdomain.masters().data(), subdomain.masters().size()});
  s.distribution->packGhosts(side_.exec(), s.arrays);
  side_.join();
}

void GrainStepper::begin(GrainSystem& system, const contact::GrainLoadsView* loads) {
  launch({system, loads});
  flags_.download();
  system.boundaries.downloadSurfaceLoads();
}

StepOutcome GrainStepper::end(GrainSystem& system) {
  StepOutcome outcome = readFlags(1);
  if (!system.distribution) return outcome;
  std::uint64_t all[] = {outcome.fault, outcome.listEnded ? 0u : 1u};
  system.comm.minimum(all, 2);
  outcome.fault = all[0], outcome.listEnded = all[1] == 0;
  return outcome;
}

/// False with SIMD on a CPU: its kernel does not check the flags of the previous step (the scalar kernel does, for
/// tests). False with surfaces: the host uploads their poses for every step. On several ranks, false in the first step
/// after a rebuild: a recorded batch begins by unpacking a halo exchange, and no exchange is pending then.
bool GrainStepper::canBatchSteps(const GrainSystem& s) const {
  const bool lanes = exec_.onCpu() && s.constants.model.maxSimdLanes > 1;
  if (lanes || s.boundaries.hasSurfaces() || s.impulses) return false;
  return !s.distribution ||
         (s.distribution->subdomain().stepsTogether() && s.distribution->subdomain().haloExchange().underWay());
}

/// On several ranks the GPUs reduce the flags after each step (base::PeerReduction), so that all of them skip the same
/// steps.
StepOutcome GrainStepper::runBatch(GrainSystem& system) {
  Subdomain* const subdomain = system.distribution ? &system.distribution->subdomain() : nullptr;
  if (subdomain) subdomain->haloExchange().arrive();
  const unsigned halo = subdomain ? subdomain->haloExchange().bufferIndex() : 0;
  stepGraph_.from(system.arrays.fields().position.now.data(), halo).run([&] {
    for (int place = 0; place < kStepsPerGraph; ++place) {
      launch({system, nullptr, place, place - 1});
      if (!subdomain) continue;
      subdomain->agreement().run(exec_, reinterpret_cast<std::uint64_t*>(flags_.device().data() + place));
      subdomain->haloExchange().publish();
    }
    flags_.download();
  });
  const StepOutcome outcome = readFlags(kStepsPerGraph);
  // A batch swaps the buffers an even number of times, but skipped steps do not advance grains: after an odd number of
  // executed steps the newest state is in `next`.
  if ((kStepsPerGraph - outcome.taken) % 2 != 0) system.arrays.swapBuffers();
  if (subdomain) {
    subdomain->haloExchange().countRuns(outcome.taken - (outcome.listEnded ? 1 : 0));
    if (outcome.listEnded) subdomain->haloExchange().discard();
  }
  return outcome;
}

void GrainStepper::clearFlags() {
  std::fill_n(flags_.host(), flags_.size(), kNoFlags);
  flags_.upload();
}

/// Waits for the launched steps and counts the executed ones: up to the first that raised a flag (expired list, or
/// fault). Clears raised flags on the device for the next launch.
StepOutcome GrainStepper::readFlags(int steps) {
  base::synchronize(exec_);
  const StepFlags* const flag = flags_.host();
  int taken = 1;
  while (taken < steps && !flag[taken - 1].raised()) ++taken;
  const StepFlags last = flag[taken - 1];
  if (last.raised()) clearFlags();
  return {taken, last.stale != 0, last.fault};
}

} // namespace grouser::terrain
