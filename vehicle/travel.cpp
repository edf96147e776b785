// SPDX-License-Identifier: BSD-3-Clause
#include "vehicle/travel.hpp"

#include "base/error.hpp"
#include "base/math.hpp"

#include <cmath>
#include <limits>

namespace grouser::vehicle {
namespace {

/// `step` minus the multiple of n that brings it into [-n/2, n/2).
double nearestTurn(double step, double n) { return step - n * std::floor(step / n + 0.5); }

} // namespace

Travel::Travel(const Assembly& vehicle, int track, int teeth) : vehicle_(&vehicle), track_(track), teeth_(teeth) {
  // The gate is half-way from the sprocket to the next support of the top run, so that little slack can lie between.
  const VehicleSpec& spec = vehicle.spec;
  double next = 0.5 * vehicle.wrap.idlerX;
  if (!spec.roller.x.empty()) next = spec.roller.x.front();
  for (const double x : spec.roller.x)
    if (std::fabs(x) < std::fabs(next)) next = x;
  gateX_ = 0.5 * next;
}

double Travel::loopCoordinate(const multibody::State& state) const {
  const Track& track = vehicle_->tracks[track_];
  const base::Pose pose_W = vehiclePose(*vehicle_, state);
  const double halfPitch = 0.5 * vehicle_->spec.shoe.pitch;
  const base::Mat3d R_WV = pose_W.orientation.matrix();
  const double n = static_cast<double>(track.shoes.size());
  // Find the shoe of the top run at the gate; if an oscillating track has several, take the one nearest to the last.
  double best = std::numeric_limits<double>::quiet_NaN();
  double bestJump = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < track.shoes.size(); ++i) {
    const base::Pose& shoe = state.pose[track.shoes[i]];
    const base::Vec3d centre = base::transposedTimes(R_WV, shoe.position - pose_W.position);
    if (centre.z <= 0 || std::fabs(centre.x - gateX_) > halfPitch) continue;
    const double halfX = halfPitch * base::transposedTimes(R_WV, base::rotate(shoe.orientation, {1, 0, 0})).x;
    const double rear = centre.x - halfX, front = centre.x + halfX;
    if ((rear < gateX_) == (front < gateX_)) continue;
    const double coordinate = static_cast<double>(i) + (rear - gateX_) / (rear - front);
    const double jump = begun_ ? std::fabs(nearestTurn(coordinate - lastCoordinate_, n)) : 0;
    if (jump < bestJump) best = coordinate, bestJump = jump;
  }
  return best;
}

void Travel::update(const multibody::State& state, double dt) {
  const Track& track = vehicle_->tracks[track_];
  const double turns = state.joint[track.sprocketJoint].position / (2 * base::kPi);
  const double teeth = turns * vehicle_->spec.sprocket.teeth;
  const double coordinate = loopCoordinate(state);
  if (!begun_) {
    begun_ = true;
    time_ = state.time, firstTeeth_ = teeth, lastCoordinate_ = coordinate;
    return;
  }
  // Without a shoe at the gate (a torn or thrown track) the pitch count stops and its difference from the teeth grows.
  if (!std::isnan(coordinate)) {
    pitchesPassed_ += nearestTurn(coordinate - lastCoordinate_, static_cast<double>(track.shoes.size()));
    lastCoordinate_ = coordinate;
  }
  const double timeBefore = time_, distanceBefore = distance_, teethBefore = teethPassed_;
  time_ = state.time;
  distance_ += trackSpeed(*vehicle_, track_, state) * dt;
  teethPassed_ = teeth - firstTeeth_;
  recordPassage(teethBefore, teethPassed_, timeBefore, time_, distanceBefore);
}

void Travel::recordPassage(double teethBefore, double teethNow, double timeBefore, double timeNow,
                           double distanceBefore) {
  const double cellBefore = std::floor(teethBefore), cellNow = std::floor(teethNow);
  if (cellBefore == cellNow) return;
  const double boundary = teethNow > teethBefore ? cellNow : cellBefore;
  const double s = (boundary - teethBefore) / (teethNow - teethBefore);
  const Passage passage{boundary, timeBefore + s * (timeNow - timeBefore),
                        distanceBefore + s * (distance_ - distanceBefore)};
  // A mean over whole teeth is defined for one direction of rotation: restart after a reversal of the sprocket.
  if (passages_.size() >= 2 &&
      (boundary - passages_.back().tooth) * (passages_.back().tooth - passages_.front().tooth) <= 0)
    passages_.erase(passages_.begin(), passages_.end() - 1);
  if (!passages_.empty() && passages_.back().tooth == boundary) passages_.clear();
  passages_.push_back(passage);
  while (static_cast<int>(passages_.size()) > teeth_ + 1) passages_.pop_front();
}

double Travel::toothSpeed() const {
  if (static_cast<int>(passages_.size()) <= teeth_) return std::numeric_limits<double>::quiet_NaN();
  return (passages_.back().distance - passages_.front().distance) / (passages_.back().time - passages_.front().time);
}

double Travel::toothSlip() const {
  if (static_cast<int>(passages_.size()) <= teeth_) return std::numeric_limits<double>::quiet_NaN();
  return 1 - (passages_.back().distance - passages_.front().distance) /
                 ((passages_.back().tooth - passages_.front().tooth) * vehicle_->spec.shoe.pitch);
}

std::vector<double> Travel::save() const {
  std::vector<double> flat{begun_ ? 1.0 : 0.0, time_,          firstTeeth_, lastCoordinate_,
                           teethPassed_,       pitchesPassed_, distance_,   static_cast<double>(passages_.size())};
  // Constant length: unused entries are zero.
  for (int i = 0; i <= teeth_; ++i) {
    const Passage p = i < static_cast<int>(passages_.size()) ? passages_[i] : Passage{};
    flat.insert(flat.end(), {p.tooth, p.time, p.distance});
  }
  return flat;
}

void Travel::restore(const std::vector<double>& flat) {
  if (flat.size() != save().size())
    throw base::InputError(
        "track travel: the checkpoint belongs to another vehicle; resume with the scene that wrote it");
  begun_ = flat[0] != 0;
  time_ = flat[1], firstTeeth_ = flat[2], lastCoordinate_ = flat[3];
  teethPassed_ = flat[4], pitchesPassed_ = flat[5], distance_ = flat[6];
  passages_.clear();
  for (int i = 0; i < static_cast<int>(flat[7]); ++i)
    passages_.push_back({flat[8 + 3 * i], flat[9 + 3 * i], flat[10 + 3 * i]});
}

base::Pose vehiclePose(const Assembly& vehicle, const multibody::State& state) {
  return multibody::compose(state.pose[vehicle.chassis], {-vehicle.spec.chassis.centre, {}});
}

double trackSpeed(const Assembly& vehicle, int track, const multibody::State& state) {
  const base::Pose& chassis = state.pose[vehicle.chassis];
  const multibody::Twist& twist = state.twist[vehicle.chassis];
  const base::Vec3d lever =
      base::rotate(chassis.orientation, base::Vec3d{0, vehicle.tracks[track].y, 0} - vehicle.spec.chassis.centre);
  return base::dot(twist.v + base::cross(twist.w, lever), base::rotate(chassis.orientation, {1, 0, 0}));
}

} // namespace grouser::vehicle
