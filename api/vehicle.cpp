// SPDX-License-Identifier: BSD-3-Clause
#include <grouser/vehicle.hpp>

#include "api/detail/run.hpp"
#include "vehicle/assembly.hpp"

#include <cmath>

namespace grouser {

namespace {

using coupling::InputKind;

Track trackOf(const vehicle::TrackObservation& t) {
  Track track;
  track.sprocketSpeed = t.sprocketSpeed, track.driveTorque = t.meanTorque, track.drivePower = t.drivePower;
  track.speed = t.speed, track.slip = t.slip;
  track.tension = t.tension, track.sinkage = t.sinkage, track.normalForce = t.normalForce;
  for (std::size_t i = 0; i < t.forwardForce.size(); ++i)
    track.shearForce.push_back(std::sqrt(t.forwardForce[i] * t.forwardForce[i] + t.leftForce[i] * t.leftForce[i]));
  return track;
}

} // namespace

VehicleState Vehicle::state() const {
  const coupling::VehicleRig& rig = run_->rig();
  const vehicle::Observation o = rig.observe(coupling::Means::watch);
  const vehicle::HullMotion hull = vehicle::hullMotion(rig.assembly(), rig.state());
  VehicleState s;
  s.time = run_->now().time();
  const base::Vec3d& centre = rig.state().pose[static_cast<std::size_t>(rig.assembly().chassis)].position;
  s.centre = {centre.x, centre.y, centre.z};
  s.position = {o.position.x, o.position.y, o.position.z}, s.velocity = {o.velocity.x, o.velocity.y, o.velocity.z};
  s.speed = hull.speed, s.heading = o.heading, s.pitch = o.pitchAngle, s.roll = o.rollAngle, s.turnRate = hull.turnRate;
  s.groundForce = {o.groundForce.x, o.groundForce.y, o.groundForce.z}, s.drawbarPull = o.drawbarPull;
  // Round to a whole number of steps, since the vehicle sums its time step by step.
  if (const auto start = rig.driveStart()) {
    const double step = run_->now().timeStep();
    s.driveStart = std::round(*start / step) * step;
  }
  s.left = trackOf(o.tracks.front());
  if (o.tracks.size() > 1) s.right = trackOf(o.tracks[1]);
  return s;
}

double Vehicle::mass() const { return run_->rig().assembly().mass; }
double Vehicle::pitchRadius() const { return run_->rig().assembly().spec.pitchRadius(); }
int Vehicle::shoes() const { return run_->rig().assembly().spec.shoe.count; }

void Vehicle::setSprocketSpeed(double left, double right) { run_->setTracks(InputKind::sprocketSpeed, left, right); }
void Vehicle::setSprocketTorque(double left, double right) { run_->setTracks(InputKind::sprocketTorque, left, right); }
void Vehicle::setThrottle(double left, double right) { run_->setTracks(InputKind::throttle, left, right); }

void Vehicle::releaseSprockets() {
  run_->release({InputKind::sprocketSpeed, InputKind::sprocketTorque, InputKind::throttle});
}

void Vehicle::setHitchForce(double force) { run_->set({{0, InputKind::hitchForce, 0, false, {force}}}); }
void Vehicle::setHitchSpeed(double speed) { run_->set({{0, InputKind::hitchSpeed, 0, false, {speed}}}); }
void Vehicle::releaseHitch() { run_->release({InputKind::hitchForce, InputKind::hitchSpeed}); }

} // namespace grouser
