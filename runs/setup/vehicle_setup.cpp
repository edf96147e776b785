// SPDX-License-Identifier: BSD-3-Clause
#include "runs/setup/vehicle_setup.hpp"

#include "base/math.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/obstacles.hpp"
#include "runs/setup/placement.hpp"
#include "vehicle/spec_file.hpp"

#include <algorithm>
#include <cmath>

namespace grouser::setup {

namespace {

/// Sphere radius of a hull [m].
constexpr double kHullSphereRadius = 0.02;

vehicle::CourseOptions courseOptions(const scene::Course& c, const vehicle::VehicleSpec& spec) {
  vehicle::CourseOptions o;
  o.speed = c.speed, o.acceleration = c.acceleration, o.curvature = c.radius ? 1 / *c.radius : 0;
  o.x = c.x, o.y = c.y;
  o.lookAhead = c.lookAhead.value_or(spec.roadWheel.spacing * (spec.roadWheel.count - 1));
  o.speedGain = c.speedGain, o.speedIntegral = c.speedIntegral;
  o.turnGain = c.turnGain, o.turnIntegral = c.turnIntegral, o.maxSprocketSpeed = c.maxSprocketSpeed;
  o.tread = 2 * spec.trackOffset, o.pitchRadius = spec.pitchRadius();
  return o;
}

vehicle::DriverOptions driverOptions(const scene::Driver& d, const vehicle::VehicleSpec& spec) {
  vehicle::DriverOptions options;
  options.tensionRamp = d.tensionRamp, options.weightRamp = d.weightRamp;
  // Because of rounding, the sum of the ramps may exceed the given start.
  options.driveStart = std::max(d.driveBegins(), d.tensionRamp + d.weightRamp);
  options.driveRamp = d.rampOfDrive(), options.changeRamp = d.rampOfChange();
  if (!d.driveStart) options.rest = vehicle::RestBounds{d.restSpeed, d.restLoad, d.restTimeLimit};
  const scene::SpeedTable table = d.speeds();
  options.speeds = {table.time, table.left, table.right};
  const scene::TorqueTable torques = d.torques();
  options.drive = d.drive, options.torques = {torques.time, torques.left, torques.right};
  if (d.course) options.course = courseOptions(*d.course, spec);
  return options;
}

vehicle::HitchOptions hitchOptions(const scene::Hitch& h, const vehicle::VehicleSpec& spec) {
  vehicle::HitchOptions o;
  o.kind = h.kind;
  o.point = h.position.value_or(spec.sprocketInFront() ? base::Vec3d{spec.idler.x, 0, spec.idler.z} : base::Vec3d{});
  o.start = h.start, o.ramp = h.ramp;
  o.force = h.force.value_or(0), o.rate = h.rate.value_or(0);
  o.mass = h.mass.value_or(0), o.friction = h.friction.value_or(0), o.length = h.length.value_or(0);
  o.slip = h.slip.value_or(0);
  o.stiffness = hitchStiffness(h, spec);
  o.damping = 2 * h.dampingRatio * std::sqrt(o.stiffness * hitchedMass(h, spec));
  return o;
}

} // namespace

double hitchedMass(const scene::Hitch& hitch, const vehicle::VehicleSpec& spec) {
  const double hull = spec.chassis.mass;
  return hitch.mass ? hull * *hitch.mass / (hull + *hitch.mass) : hull;
}

double hitchStiffness(const scene::Hitch& hitch, const vehicle::VehicleSpec& spec) {
  constexpr double kRate = 2 * base::kPi * 10; // [rad/s]
  if (hitch.kind != vehicle::HitchKind::sled && hitch.kind != vehicle::HitchKind::speed) return 0;
  return hitch.stiffness.value_or(hitchedMass(hitch, spec) * kRate * kRate);
}

void removeVehicle(scene::Scene& scene) {
  scene.vehicle.reset(), scene.driver = {}, scene.hitch.reset(), scene.stop = {};
  scene.output.shoeForces = scene.output.gearContacts = false;
}

coupling::VehicleSetup vehicleSetup(const scene::Scene& scene) {
  const scene::Vehicle& v = *scene.vehicle;
  coupling::VehicleSetup setup;
  setup.spec = vehicleSpec(scene);
  checkSections(scene, setup.spec);
  setup.shapes = setup.spec.shapes && v.gearContactModel != vehicle::GearContactModel::samples;
  setup.place = placeVehicle(scene, setup.spec);
  setup.clearance = v.clearance, setup.onTerrain = scene.terrain.has_value();
  setup.fixChassis = v.chassis == scene::ChassisMount::fixed;
  if (v.chassis == scene::ChassisMount::guided) setup.guide = vehicle::HullGuide::pitching;
  if (v.chassis == scene::ChassisMount::level) setup.guide = vehicle::HullGuide::level;
  setup.single = v.tracks == scene::Tracks::single;
  setup.sphereRadius = v.sphereRadius.value_or(scene::Vehicle::kSphereRadius);
  setup.sphereRadiusGiven = v.sphereRadius.has_value();
  setup.sphereRefinement = v.sphereRefinement;
  setup.soilTouchesShoesOnly = v.soilContact == scene::SoilContact::shoes;
  setup.hullTouches = hullTouches(scene);
  setup.hullSphereRadius = v.hullSphereRadius.value_or(std::max(kHullSphereRadius, setup.sphereRadius));
  setup.hullSphereRadiusGiven = v.hullSphereRadius.has_value();
  setup.stop = {scene.stop.distance, scene.stop.edge, scene.stop.immobile};
  setup.driver = driverOptions(scene.driver, setup.spec);
  if (scene.hitch) setup.hitch = hitchOptions(*scene.hitch, setup.spec);
  // Without ground force (hull fixed, no terrain or no gravity), there is no check for rest.
  if (setup.fixChassis || !setup.onTerrain || base::norm(scene.run.gravity) == 0) setup.driver.rest.reset();
  return setup;
}

} // namespace grouser::setup
