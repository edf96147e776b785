// SPDX-License-Identifier: BSD-3-Clause
#include "vehicle/observers.hpp"

#include "base/error.hpp"
#include "base/math.hpp"
#include "vehicle/pin_reactions.hpp"
#include "vehicle/track_watch.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <optional>

namespace grouser::vehicle {
namespace {

using base::Vec3d;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
/// Minimum speeds of running tracks, and of a hull that slides on stopped tracks [m/s]; settling motions are slower.
constexpr double kRuns = 1e-4, kSlides = 0.01;
/// Minimum track speed of a reversal [m/s]; a stalled vehicle rocks at lower speeds.
constexpr double kTurnedRound = 0.01;
/// Skip threshold in pitches: slack and stretch move the track relative to the sprocket by less than half a pitch.
constexpr double kSkip = 0.75;

/// Unwraps an angle [rad]: adds full turns so that it is nearest to `last`.
double continued(double angle, double last) {
  return angle + 2 * base::kPi * std::floor((last - angle) / (2 * base::kPi) + 0.5);
}

/// Unit vector opposite to gravity; world z without gravity.
Vec3d upOf(const Vec3d& gravity) {
  const double g = base::norm(gravity);
  return g > 0 ? gravity * (-1 / g) : Vec3d{0, 0, 1};
}

/// True if the ground supports more than half of the weight.
bool stands(const Assembly& vehicle, const GroundLoads& ground, const Vec3d& gravity) {
  const Vec3d up = upOf(gravity);
  double carried = 0;
  for (std::size_t body = 0; body < ground.force.size(); ++body)
    if (static_cast<int>(body) != vehicle.chassis)
      carried += base::dot(ground.force[body], up); // the hull supports the tracks
  return carried > 0.5 * vehicle.mass * base::norm(gravity);
}

} // namespace

double padHeight(const ShoeSpec& shoe, const base::Pose& pose_W) {
  double lowest = std::numeric_limits<double>::infinity();
  for (const double x : {-shoe.halfLength, shoe.halfLength})
    for (const double y : {-shoe.padHalfWidth, shoe.padHalfWidth})
      lowest = std::min(lowest, pose_W.toWorld({x, y, shoe.padBottom}).z);
  return lowest;
}

double sinkage(const VehicleSpec& spec, const base::Pose& shoePose_W, const SurfaceHeight& surface) {
  constexpr int kIterations = 40, kHalf = 2; // points to either side
  constexpr double kConverged = 1e-9;        // [m]
  const Vec3d pad = shoePose_W.toWorld({0, 0, spec.shoe.padBottom});
  const double cell = 0.5 * spec.shoe.pitch / kHalf;
  double x = pad.x, y = pad.y, depth = kNaN;
  for (int k = 0; k < kIterations; ++k) {
    double slopeX = 0, slopeY = 0, squares = 0;
    for (int j = -kHalf; j <= kHalf; ++j)
      for (int i = -kHalf; i <= kHalf; ++i) {
        const double h = surface(x + i * cell, y + j * cell);
        slopeX += i * h, slopeY += j * h, squares += i * i;
      }
    slopeX /= squares * cell, slopeY /= squares * cell;
    const Vec3d normal = base::normalized(Vec3d{-slopeX, -slopeY, 1});
    depth = base::dot(Vec3d{x, y, surface(x, y)} - pad, normal);
    const Vec3d foot = pad + normal * depth;
    const double moved = std::fabs(foot.x - x) + std::fabs(foot.y - y);
    x = foot.x, y = foot.y;
    if (!(moved > kConverged)) break;
  }
  return depth;
}

bool onGroundRun(const Assembly& vehicle, int track, int shoe, const multibody::State& state) {
  const Track& t = vehicle.tracks[track];
  const base::Pose pose_W = vehiclePose(vehicle, state);
  const Vec3d p_V = pose_W.toBody(state.pose[t.shoes[shoe]].position);
  const Vec3d rear_V = pose_W.toBody(state.pose[t.wheels.front()].position);
  const Vec3d front_V = pose_W.toBody(state.pose[t.wheels.back()].position);
  return p_V.x >= rear_V.x && p_V.x <= front_V.x && p_V.z < std::min(rear_V.z, front_V.z);
}

double carryingLoad(const Assembly& vehicle, double gravity) {
  return 0.01 * vehicle.mass * gravity / (static_cast<double>(vehicle.tracks.size()) * vehicle.wrap.counts.ground);
}

double sidewaysShift(const Assembly& vehicle, int track, const multibody::State& state) {
  return maxLateralShift(vehicle, track, state).shift;
}

double wheelLift(const Assembly& vehicle, int track, const multibody::State& state) {
  return maxLifted(vehicle, track, state).gap;
}

double suspendedSag(const VehicleSpec& spec, double gravity) {
  const double span = spec.idler.x, load = spec.shoe.mass / spec.shoe.pitch * gravity;
  // The tensioner balances two strands, both nearly along its slide.
  return load * span * span / (8 * 0.5 * std::max(spec.idler.preload, 1.0));
}

Observer::Observer(const Assembly& vehicle, const ObserverOptions& options)
    : vehicle_(&vehicle), stone_(options.stone), step_(options.step), gravity_(options.gravity),
      heading_(options.heading) {
  for (int i = 0; i < static_cast<int>(vehicle.tracks.size()); ++i)
    travel_.emplace_back(vehicle, i, options.averageTeeth);
  driven_.resize(vehicle.tracks.size());
}

void Observer::update(const multibody::State& state, double dt) {
  step_ = dt;
  for (Travel& travel : travel_) travel.update(state, dt);
  for (std::size_t i = 0; i < driven_.size(); ++i) {
    const multibody::JointReading& sprocket = state.joint[vehicle_->tracks[i].sprocketJoint];
    driven_[i].torque += sprocket.driveForce, driven_[i].power += sprocket.driveForce * sprocket.rate;
    driven_[i].rate += sprocket.rate, driven_[i].speed += trackSpeed(*vehicle_, static_cast<int>(i), state);
  }
  ++updates_;
  const Attitude now = attitude(state);
  heading_ = now.heading, roll_ = now.roll;
}

Observer::Attitude Observer::attitude(const multibody::State& state) const {
  const base::Quat& orientation = state.pose[vehicle_->chassis].orientation;
  const Vec3d ahead = base::rotate(orientation, {1, 0, 0}), left = base::rotate(orientation, {0, 1, 0}),
              up = base::rotate(orientation, {0, 0, 1});
  return {continued(base::atan2(ahead.y, ahead.x), heading_),
          base::atan2(ahead.z, std::sqrt(ahead.x * ahead.x + ahead.y * ahead.y)),
          continued(base::atan2(left.z, up.z), roll_)};
}

/// Means of each track since restartMeans(); before the first update, values of the state.
std::vector<Observer::DriveSums> Observer::means(const multibody::State& state) const {
  std::vector<DriveSums> means = driven_;
  for (std::size_t i = 0; i < means.size(); ++i) {
    const multibody::JointReading& sprocket = state.joint[vehicle_->tracks[i].sprocketJoint];
    DriveSums& m = means[i];
    if (updates_ > 0)
      m = {m.torque / updates_, m.power / updates_, m.rate / updates_, m.speed / updates_};
    else
      m = {sprocket.driveForce, sprocket.driveForce * sprocket.rate, sprocket.rate,
           trackSpeed(*vehicle_, static_cast<int>(i), state)};
  }
  return means;
}

/// Direction of motion: 1 forward, -1 backward; 0 if the tracks run in opposite directions; empty if too slow.
/// `sums`: sums for each track over `updates` updates.
std::optional<int> Observer::motion(const std::vector<DriveSums>& sums, double updates) const {
  double most = 0, least = 0, hull = 0; // [m/s]
  for (const DriveSums& track : sums) {
    const double run = track.rate / updates * vehicle_->spec.pitchRadius();
    most = std::max(most, run), least = std::min(least, run);
    hull += track.speed / updates / static_cast<double>(sums.size());
  }
  const bool forward = most > kRuns, backward = least < -kRuns;
  if (forward && backward) return 0;
  const double speed = forward ? most : backward ? least : hull;
  const double enough = !forward && !backward ? kSlides : way_ * speed < 0 ? kTurnedRound : kRuns;
  if (!(std::fabs(speed) > enough)) return {};
  return speed > 0 ? 1 : -1;
}

void Observer::restartMeans() {
  if (const int way = updates_ > 0 ? motion(driven_, updates_).value_or(0) : 0; way != 0) way_ = way;
  driven_.assign(driven_.size(), {});
  updates_ = 0;
}

base::Alarm Observer::alarm(const multibody::State& state, const GroundLoads& ground) const {
  // A track that hangs freely, or has an unknown load, may sag off its wheels; wheels may also roll over stones.
  const double allowed =
      vehicle_->spec.shoe.hornHeight + stone_ +
      (stands(*vehicle_, ground, gravity_) ? 0.0 : suspendedSag(vehicle_->spec, base::norm(gravity_)));
  for (int i = 0; i < static_cast<int>(vehicle_->tracks.size()); ++i) {
    if (std::string thrown = thrownTrack(*vehicle_, i, state, allowed); !thrown.empty())
      return {thrown, base::Cause::thrownTrack};
    if (!(std::fabs(travel_[i].skipped()) <= kSkip))
      return {fmt::format("{} track skips: {:.2f} teeth have passed, but {:.2f} pitches; tighten the track "
                          "(idler.preload of the vehicle file, {:g} N), or drive more gently (driver)",
                          sideName(vehicle_->tracks[i].side), travel_[i].teethPassed(), travel_[i].pitchesPassed(),
                          vehicle_->spec.idler.preload),
              base::Cause::skippingTrack};
  }
  return {};
}

TrackObservation Observer::observeTrack(int track, const multibody::State& state, const GroundLoads& ground,
                                        const SurfaceHeight& surface) const {
  const Track& t = vehicle_->tracks[track];
  const VehicleSpec& spec = vehicle_->spec;
  const Travel& travel = travel_[track];
  TrackObservation o;
  const double padArea = 4 * spec.shoe.halfLength * spec.shoe.padHalfWidth;
  const double carrying = carryingLoad(*vehicle_, base::norm(gravity_));
  const Vec3d up = upOf(gravity_);
  for (std::size_t i = 0; i < t.shoes.size(); ++i) {
    const base::Pose& pose = state.pose[t.shoes[i]];
    const bool known = !ground.force.empty();
    const Vec3d force = known ? ground.force[t.shoes[i]] : Vec3d{};
    const bool carries =
        known && base::dot(force, up) > carrying && onGroundRun(*vehicle_, track, static_cast<int>(i), state);
    const double height = padHeight(spec.shoe, pose);
    o.padHeight.push_back(height);
    o.onGround.push_back(carries ? 1 : 0);
    o.sinkage.push_back(carries && surface ? vehicle::sinkage(spec, pose, surface) : kNaN);
    const auto along = [&](const Vec3d& axis) {
      return known ? base::dot(force, base::rotate(pose.orientation, axis)) : kNaN;
    };
    const double normal = along({0, 0, 1}), forward = along({1, 0, 0}), left = along({0, 1, 0});
    o.normalForce.push_back(normal), o.forwardForce.push_back(forward), o.leftForce.push_back(left);
    o.groundPressure.push_back(normal / padArea);
    o.shear.push_back(std::sqrt(forward * forward + left * left) / padArea);
  }
  for (const PinReaction& pin : pinReactions(*vehicle_, track, state, step_)) {
    o.tension.push_back(pin.tension), o.pinLateral.push_back(pin.lateral);
    o.pinMoment.push_back(pin.bending);
  }
  const multibody::JointReading& sprocket = state.joint[t.sprocketJoint];
  const multibody::JointReading& slide = state.joint[t.slideJoint];
  o.sprocketSpeed = sprocket.rate;
  o.driveTorque = sprocket.driveForce;
  const DriveSums mean = means(state)[static_cast<std::size_t>(track)];
  o.meanTorque = mean.torque, o.drivePower = mean.power;
  for (const int arm : t.armJoints) o.armAngle.push_back(state.joint[arm].position);
  o.idlerForce = slide.springForce;
  o.idlerSlide = slide.position;
  o.speed = trackSpeed(*vehicle_, track, state);
  o.slip = std::fabs(sprocket.rate) < kStanding ? kNaN : 1 - o.speed / (sprocket.rate * spec.pitchRadius());
  o.toothSpeed = travel.toothSpeed();
  o.toothSlip = travel.toothSlip();
  o.teethPassed = travel.teethPassed();
  o.pitchesPassed = travel.pitchesPassed();
  o.skipped = travel.skipped();
  o.sideways = sidewaysShift(*vehicle_, track, state);
  o.wheelLift = wheelLift(*vehicle_, track, state);
  return o;
}

Observation Observer::observe(const multibody::State& state, const GroundLoads& ground,
                              const SurfaceHeight& surface) const {
  Observation o;
  const Attitude angles = attitude(state);
  o.time = state.time;
  o.position = vehiclePose(*vehicle_, state).position;
  o.velocity = state.twist[vehicle_->chassis].v;
  o.heading = angles.heading, o.pitchAngle = angles.pitch, o.rollAngle = angles.roll;

  double torque = 0;
  for (int i = 0; i < static_cast<int>(vehicle_->tracks.size()); ++i) {
    o.tracks.push_back(observeTrack(i, state, ground, surface));
    torque += o.tracks.back().meanTorque;
  }
  o.groundForce = {kNaN, kNaN, kNaN};
  if (!ground.force.empty()) {
    Vec3d sum;
    // Sum over all bodies: a stone jammed between track and wheel pushes one of them backward, the other forward.
    for (const Vec3d& force : ground.force) sum += force;
    const Vec3d forward{base::cos(o.heading), base::sin(o.heading), 0};
    o.groundForce = {base::dot(sum, forward), base::dot(sum, Vec3d{-forward.y, forward.x, 0}), sum.z};
  }
  const int way = motion(means(state), 1).value_or(way_ < 0 ? -1 : 1);
  const double sign = way < 0 ? -1 : 1, rise = surface ? riseAhead(state, surface) : 0;
  o.along.forward = sign / std::sqrt(1 + rise * rise), o.along.up = o.along.forward * rise;
  o.grossTraction = sign * torque / vehicle_->spec.pitchRadius();
  o.netThrust = o.drawbarPull = o.along.of(o.groundForce);
  o.motionResistance = way == 0 ? kNaN : o.grossTraction - o.netThrust;
  o.alarm = alarm(state, ground);
  return o;
}

/// Slope of the ground under the vehicle along its heading [-].
double Observer::riseAhead(const multibody::State& state, const SurfaceHeight& surface) const {
  const HullMotion m = hullMotion(*vehicle_, state);
  const double middle = vehicle_->spec.roadWheel.firstX + 0.5 * vehicle_->spec.groundRun();
  return groundPlane(vehicle_->spec, m.x - m.forwardX * middle, m.y - m.forwardY * middle, m.forwardX, m.forwardY,
                     surface)
      .ahead;
}

std::vector<double> Observer::save() const {
  std::vector<double> flat;
  for (const Travel& travel : travel_) {
    const std::vector<double> one = travel.save();
    flat.insert(flat.end(), one.begin(), one.end());
  }
  for (const DriveSums& sums : driven_) flat.push_back(sums.torque), flat.push_back(sums.power);
  flat.push_back(updates_);
  for (const DriveSums& sums : driven_) flat.push_back(sums.rate), flat.push_back(sums.speed);
  flat.push_back(heading_), flat.push_back(roll_), flat.push_back(way_);
  return flat;
}

void Observer::restore(const std::vector<double>& flat) {
  const std::size_t each = travel_.empty() ? 0 : travel_.front().save().size();
  if (flat.size() != save().size())
    throw base::InputError("observers: the checkpoint belongs to another vehicle or to another program version; "
                           "restart the run with --force");
  const auto place = [&](std::size_t i) { return flat.begin() + static_cast<std::ptrdiff_t>(i * each); };
  for (std::size_t i = 0; i < travel_.size(); ++i) travel_[i].restore({place(i), place(i + 1)});
  const double* sums = flat.data() + each * travel_.size();
  for (DriveSums& driven : driven_) driven = {sums[0], sums[1]}, sums += 2;
  updates_ = *sums++;
  for (DriveSums& driven : driven_) driven.rate = sums[0], driven.speed = sums[1], sums += 2;
  heading_ = sums[0], roll_ = sums[1], way_ = static_cast<int>(sums[2]);
}

} // namespace grouser::vehicle
