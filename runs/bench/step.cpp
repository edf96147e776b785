// SPDX-License-Identifier: BSD-3-Clause
#include "runs/bench/bench.hpp"

#include <chrono>

namespace grouser::bench {

namespace {

std::int64_t now() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

} // namespace

void StepBench::mark(int part) {
  base::synchronize(exec_);
  const std::int64_t at = now();
  parts_[static_cast<std::size_t>(part)].microseconds += 1e-3 * static_cast<double>(at - last_);
  last_ = at;
}

// As Simulation::step(); a test compares the bits.
void StepBench::step() {
  simulation::Simulation& s = simulation_;
  terrain::Grains* grains = s.ground_.grains.get();
  simulation::VehicleRig* vehicle = s.vehicle_.get();
  base::synchronize(exec_);
  last_ = now();
  if (vehicle) vehicle->setSurfacePoses();
  mark(kPlace);
  const bool slotsChanged = grains && grains->refreshNeighbours();
  rebuilds_ += slotsChanged;
  mark(kNeighbours);
  if (vehicle) {
    vehicle->refreshLists(grains, slotsChanged);
    mark(kLists);
    vehicle->noteTravel();
    vehicle->uploadPoses();
    mark(kUpload);
    vehicle->computeTrackContacts();
    mark(kTrack);
    vehicle->computeGroundContacts(grains, exec_);
    mark(kGround);
    vehicle->downloadLoads();
    vehicle->collectLoads();
    mark(kCollect);
  }
  if (s.surfaces_) s.surfaces_->computeContacts(*grains, s.steps_, slotsChanged);
  if (grains) grains->beginStep(s.partLoads());
  mark(kGrains);
  if (vehicle) vehicle->advance();
  if (s.mechanism_) s.mechanism_->advance();
  mark(kMultibody);
  if (grains) grains->endStep();
  if (s.surfaces_) s.surfaces_->advance(*grains, s.steps_);
  mark(kFlags);
  ++s.steps_;
  s.addGrains();
  if (vehicle && s.steps_ % simulation::Simulation::kAlarmInterval == 0) s.checkAlarm();
  mark(kAlarm);
  ++steps_;
}

} // namespace grouser::bench
