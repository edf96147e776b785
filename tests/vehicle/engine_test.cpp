// SPDX-License-Identifier: BSD-3-Clause
// Engines, governors and torques against closed forms.
#include "vehicle/engine.hpp"

#include "base/error.hpp"
#include "base/math.hpp"
#include "ride.hpp"

#include <gtest/gtest.h>

#include <cmath>

using namespace grouser;
using vehicle::EngineSpec;
using vehicle::SprocketDrive;

namespace {

/// 400 N m at the shaft, gear ratio 20, efficiency 0.9: 7200 N m at the sprocket.
EngineSpec flat() {
  EngineSpec engine;
  engine.speed = {0, 300}, engine.torque = {400, 400};
  engine.ratio = 20, engine.efficiency = 0.9, engine.governedSpeed = 200, engine.droop = 10;
  engine.brakeTorque = 1000, engine.inertia = 50;
  return engine;
}

} // namespace

TEST(Engine, FullLoadIsLinearBetweenPointsAndConstantOutside) {
  EngineSpec engine = flat();
  engine.speed = {100, 200, 300}, engine.torque = {200, 400, 100};
  EXPECT_EQ(vehicle::fullLoadTorque(engine, 0), 200);
  EXPECT_EQ(vehicle::fullLoadTorque(engine, 150), 300);
  EXPECT_EQ(vehicle::fullLoadTorque(engine, 275), 175);
  EXPECT_EQ(vehicle::fullLoadTorque(engine, 900), 100);
}

TEST(Engine, GovernorGivesItsShareWithinTheDroopAndBrakesBeyond) {
  const EngineSpec engine = flat();
  EXPECT_DOUBLE_EQ(vehicle::engineTorque(engine, 5, 0), 7200);
  EXPECT_DOUBLE_EQ(vehicle::engineTorque(engine, 5, 4.75), 3600); // a quarter rad/s is half of the droop
  EXPECT_EQ(vehicle::engineTorque(engine, 5, 5), 0);
  EXPECT_DOUBLE_EQ(vehicle::engineTorque(engine, 5, 5.25), -500);
  EXPECT_DOUBLE_EQ(vehicle::engineTorque(engine, 5, 9), -1000);
  EXPECT_DOUBLE_EQ(vehicle::engineTorque(engine, -5, -4.75), -3600);
  EXPECT_DOUBLE_EQ(vehicle::engineTorque(engine, -5, -9), 1000);
  EXPECT_DOUBLE_EQ(vehicle::engineTorque(engine, 0, 0.25), -500) << "it brakes at a set speed of 0";
  EXPECT_DOUBLE_EQ(vehicle::engineTorque(engine, 0, -0.25), 500);
  EXPECT_EQ(vehicle::engineTorque(engine, 50, 10), 0) << "governed at 200 / 20 rad/s";
}

TEST(Engine, RollingBackItGivesWhatItsCurveHasAtStandstill) {
  EngineSpec engine = flat();
  engine.torque = {100, 400};
  EXPECT_DOUBLE_EQ(vehicle::engineTorque(engine, 5, -3), 0.9 * 20 * 100);
}

/// J w' = torque: full throttle up to the droop, then exponential with the time constant J / slope.
TEST(Engine, FlywheelRunsUpAndComesNearAsTheClosedFormSays) {
  const EngineSpec engine = flat();
  const double J = 60, dt = 1e-5, droop = 0.5, slope = vehicle::governorSlope(engine);
  EXPECT_DOUBLE_EQ(slope, 7200 / droop);
  const double full = J * (5 - droop) / 7200; // [s]
  double w = 0, t = 0;
  while (t < full - 0.5 * dt) w += dt * vehicle::engineTorque(engine, 5, w) / J, t += dt;
  EXPECT_NEAR(w, 5 - droop, 7200 / J * dt); // one step
  while (t < full + 2 * J / slope - 0.5 * dt) w += dt * vehicle::engineTorque(engine, 5, w) / J, t += dt;
  // Euler's error of an exponential over two time constants, 2 (dt slope / J) / 2 of it, and the step above.
  EXPECT_NEAR(5 - w, droop * std::exp(-2.0), 2e-3 * droop + 7200 / J * dt);
}

TEST(Engine, UnderLoadItTurnsSlowerByItsShareOfTheDroop) {
  const EngineSpec engine = flat();
  double w = 0;
  for (int i = 0; i < 200000; ++i) w += 1e-5 * (vehicle::engineTorque(engine, 5, w) - 1800) / 60;
  EXPECT_NEAR(w, 5 - 0.5 * 1800 / 7200, 1e-12); // a fixed point of the recurrence
}

namespace {

/// Pins with little damping: its loss depends on the speed, which differs between the two torques.
vehicle::VehicleSpec easyRunning() {
  vehicle::VehicleSpec spec = test::readySpec();
  spec.shoe.pinDamping = 0.1;
  return spec;
}

/// Speed gained per second by torques on the sprockets [m/s2].
double pulled(double torque) {
  vehicle::DriverOptions driver;
  driver.driveRamp = 0.1, driver.drive = SprocketDrive::torque, driver.torques = {{0}, {torque}, {torque}};
  test::Ride ride = test::rideOnGround(easyRunning(), driver);
  ride.until(0.45);
  EXPECT_NEAR(ride.motion().speed, 0, 0.02) << "locked until the drive starts";
  ride.until(0.8);
  const double before = ride.motion().speed;
  EXPECT_NEAR(ride.observe().tracks[0].driveTorque, torque, 1e-9 * torque);
  ride.until(1.4);
  return (ride.motion().speed - before) / 0.6;
}

} // namespace

/// Difference between two torques: resistance hardly depends on torque and cancels. In a loop running about a hull
/// the sum of m (v + u)^2 / 2 over all directions u of size v is m v^2: its shoes count twice; wheels add I / r^2.
TEST(Torque, AcceleratesMassAndEverythingThatTurns) {
  const vehicle::VehicleSpec s = easyRunning();
  const double light = 1000, strong = 2500;
  const auto turning = [](double inertia, double radius) { return inertia / (radius * radius); };
  const double R = s.pitchRadius();
  const double mass =
      s.totalMass() + 2 * (46 * s.shoe.mass + 5 * turning(s.roadWheel.inertia.y, s.roadWheel.radius) +
                           3 * turning(s.roller.inertia.y, s.roller.radius) +
                           turning(s.idler.inertia.y, s.idler.radius) + turning(s.sprocket.inertia.y, R));
  const double gained = pulled(strong) - pulled(light);
  const double wanted = 2 * (strong - light) / (R * mass);
  // Losses in contact dashpots grow with speed, some 700 N s/m, and the faster run is ahead by 0.9 m/s in the
  // middle: its acceleration is smaller by up to a tenth, never larger.
  EXPECT_LT(gained, wanted);
  EXPECT_GT(gained, 0.9 * wanted);
}

TEST(EngineDrive, ReachesTheSpeedItIsAskedForLessTheDroop) {
  vehicle::VehicleSpec spec = test::readySpec();
  spec.engine = flat();
  spec.engine->brakeTorque = 7200; // teeth make the speed ripple about its set value: equal slopes on both sides
  vehicle::DriverOptions driver;
  driver.drive = SprocketDrive::engine, driver.speeds = {{0}, {3}, {3}};
  test::Ride ride = test::rideOnGround(spec, driver);
  ride.until(2.0);
  double speed = 0, torque = 0;
  int n = 0;
  ride.until(3.0, [&] {
    for (const vehicle::Track& t : ride.vehicle().tracks) {
      speed += ride.state.joint[static_cast<std::size_t>(t.sprocketJoint)].rate;
      torque += ride.state.joint[static_cast<std::size_t>(t.sprocketJoint)].driveForce;
      ++n;
    }
  });
  speed /= n, torque /= n;
  EXPECT_GT(torque, 0) << "the torque exceeds the resistance of the pins";
  // The governor is linear there: means are exact up to the speed change within a step.
  EXPECT_NEAR(3 - speed, 0.5 * torque / 7200, 1e-4);
  EXPECT_LT(3 - speed, 0.1);
}

TEST(EngineDrive, NeedsAnEngine) {
  vehicle::AssemblyOptions options;
  options.drive = SprocketDrive::engine;
  EXPECT_THROW(vehicle::assemble(test::readySpec(), options), base::InputError);
}
