// SPDX-License-Identifier: BSD-3-Clause
#include "runs/simulation/vehicle_rig.hpp"

#include "base/error.hpp"

#include <cstring>

namespace grouser::simulation {

std::vector<std::uint32_t> VehicleState::words() const {
  std::vector<std::uint32_t> words;
  for (const double v : bodies) {
    std::uint32_t raw[2];
    std::memcpy(raw, &v, sizeof raw);
    words.insert(words.end(), raw, raw + 2);
  }
  for (const std::vector<std::uint32_t>& more : {track.words(), ground.words(), bed.memories})
    words.insert(words.end(), more.begin(), more.end());
  return words;
}

VehicleState VehicleRig::save() const {
  VehicleState s;
  s.bodies = state_.save();
  s.observers = observer_->save();
  s.track = track_->save();
  if (rigidGround_) s.ground = rigidGround_->save();
  if (bed_) s.bed = bed_->save();
  s.groundForces = groundForceSums_;
  s.meanSteps = meanSteps_;
  s.alarmForces = alarmForceSums_;
  s.alarmSteps = alarmSteps_;
  s.impulseOnParts = impulseOnParts_;
  return s;
}

void VehicleRig::restore(const VehicleState& s) {
  if (s.groundForces.size() > contactParts_.size() || s.alarmForces.size() > contactParts_.size())
    throw base::InputError("the checkpoint is of another vehicle; resume with the scene that was run");
  state_.restore(s.bodies);
  observer_->restore(s.observers);
  track_->restore(s.track);
  if (rigidGround_) rigidGround_->restore(s.ground);
  if (bed_) bed_->restore(s.bed);
  groundForceSums_ = s.groundForces;
  meanSteps_ = s.meanSteps;
  alarmForceSums_ = s.alarmForces;
  alarmSteps_ = s.alarmSteps;
  impulseOnParts_ = s.impulseOnParts;
  // The lists belong to another place: the next step makes them anew.
  relativeTravel_ = absoluteTravel_ = kNeverListed;
}

} // namespace grouser::simulation
