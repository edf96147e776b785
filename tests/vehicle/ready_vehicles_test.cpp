// SPDX-License-Identifier: BSD-3-Clause
// The vehicles of assets/vehicles: each closes, has the correct mass, rests, and drives on rigid ground.
#include "base/math.hpp"
#include "ride.hpp"
#include "tests/vehicle/ground_shoes.hpp"
#include "vehicle/wrap.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <ostream>

using namespace grouser;
using vehicle::VehicleSpec;
using vehicle::Wrap;

namespace {

struct Ready {
  const char* name;
  double mass;   ///< [kg]
  double length; ///< ground contact, from first to last road wheel [m]
  test::RideNumbers numbers;
};
std::ostream& operator<<(std::ostream& out, const Ready& r) { return out << r.name; }

class ReadyVehicle : public ::testing::TestWithParam<Ready> {
protected:
  VehicleSpec spec() const { return test::readySpec(GetParam().name); }
};

INSTANTIATE_TEST_SUITE_P(All, ReadyVehicle,
                         ::testing::Values(Ready{"light_tracked", 5018, 1.7832, {}},
                                           Ready{"m113_like", 10400, 2.668, {6e7, 1e-4}},
                                           Ready{"robot", 200, 0.62412, {4e6, 5e-5}}),
                         [](const auto& ready) { return std::string(ready.param.name); });

TEST_P(ReadyVehicle, HasItsMassAndLengthAndCloses) {
  const VehicleSpec s = spec();
  EXPECT_NEAR(s.totalMass(), GetParam().mass, 0.01);
  EXPECT_NEAR(s.roadWheel.spacing * (s.roadWheel.count - 1), GetParam().length, 1e-9);
  EXPECT_LE(vehicle::wrapTrack(s).closure(), 5e-15);
}

TEST_P(ReadyVehicle, StandsAndDrivesForwardsOnRigidGround) {
  const VehicleSpec s = spec();
  const double speed = 0.25 / s.pitchRadius(); // [rad/s] of 0.25 m/s
  test::Ride ride = test::rideOnGround(s, {.driveStart = 0.9, .driveRamp = 0.5, .speeds = {{0}, {speed}, {speed}}},
                                       GetParam().numbers);
  ride.until(0.8);
  double up = 0;
  int n = 0;
  ride.until(0.9, [&] {
    for (const base::Vec3d& f : ride.ground().force) up += f.z;
    ++n;
  });
  // The hull still pitches on its bars, for a tenth of a second: 3 %.
  EXPECT_NEAR(up / n, GetParam().mass * 9.81, 0.03 * GetParam().mass * 9.81);
  const auto standing = ride.observe();
  EXPECT_EQ(standing.alarm.text, "");
  EXPECT_NEAR(standing.pitchAngle, 0, 0.02);
  for (const auto& track : standing.tracks) EXPECT_NEAR(track.idlerForce, s.idler.preload, 0.25 * s.idler.preload);
  ride.until(1.6);
  const double from = ride.motion().x;
  ride.until(2.6);
  const auto o = ride.observe();
  EXPECT_EQ(o.alarm.text, "");
  EXPECT_NEAR(ride.motion().x - from, 0.25, 0.01) << "within one second, not over whole teeth: 4 %";
  EXPECT_NEAR(ride.motion().y, 0, 1e-4);
  for (const auto& track : o.tracks) {
    EXPECT_LT(std::fabs(track.skipped), 0.1);
    EXPECT_GT(track.pitchesPassed, 0.35 / s.shoe.pitch);
    EXPECT_LT(track.sideways, 2e-3);
  }
}

/// A mirror image has its pins at the original positions, front and rear exchanged, and the same sense of rotation.
TEST(FrontSprocket, LoopIsTheMirrorImage) {
  const VehicleSpec rear = test::readySpec();
  VehicleSpec front = rear;
  front.idler.x = -rear.idler.x;
  front.roadWheel.firstX = -(rear.roadWheel.firstX + 4 * rear.roadWheel.spacing);
  for (double& x : front.roller.x) x = -x;
  const Wrap a = vehicle::wrapTrack(rear), b = vehicle::wrapTrack(front);
  ASSERT_EQ(b.pins.size(), a.pins.size());
  for (std::size_t i = 0; i < 46; ++i) {
    EXPECT_EQ(b.pins[i].x, -a.pins[(46 - i) % 46].x);
    EXPECT_EQ(b.pins[i].z, a.pins[(46 - i) % 46].z);
  }
  EXPECT_EQ(b.idlerX, -a.idlerX);
  for (int i = test::firstGroundShoe(b); i <= test::lastGroundShoe(b); ++i) {
    EXPECT_NEAR(b.shoeCentre(i).z, front.groundPinHeight(), 1e-15);
    EXPECT_EQ(b.shoeAngle(i), 0) << "forwards";
  }
  EXPECT_EQ(test::lastGroundShoe(b) - test::firstGroundShoe(b), test::lastGroundShoe(a) - test::firstGroundShoe(a));
  const vehicle::PlanePoint onIdler = b.pins[static_cast<std::size_t>(b.counts.top)];
  EXPECT_NEAR(base::atan2(onIdler.z - front.idler.z, onIdler.x - b.idlerX), b.idlerFirstAngle, 1e-12);
}

TEST(FrontSprocket, EngagedPinsLieInItsGapsWithAnyNumberOfTeeth) {
  for (const int teeth : {10, 11}) {
    VehicleSpec spec = test::readySpec("m113_like");
    spec.sprocket.teeth = teeth;
    spec.idler.slideMin = -0.09, spec.idler.slideMax = 0.09;
    const Wrap wrap = vehicle::wrapTrack(spec);
    const std::size_t n = wrap.pins.size();
    for (std::size_t i = 0; i <= static_cast<std::size_t>(wrap.counts.sprocket); ++i) {
      const vehicle::PlanePoint p = wrap.pins[(n - i) % n];
      const double gaps = (base::atan2(p.z, p.x) - wrap.sprocketPhase) / (2 * base::kPi / teeth);
      EXPECT_NEAR(std::sqrt(p.x * p.x + p.z * p.z), spec.sprocketPinRadius(), 1e-14);
      EXPECT_NEAR(gaps, std::floor(gaps + 0.5), 1e-13) << teeth;
    }
  }
}

TEST(FrontSprocket, TensionerPushesTheIdlerBack) {
  const vehicle::Assembly v = vehicle::assemble(test::readySpec("m113_like"));
  multibody::State state = multibody::makeState(v.model);
  multibody::Loads loads = multibody::makeLoads(v.model);
  multibody::Solver solver(v.model);
  loads.gravity = {};
  for (int i = 0; i < 20; ++i) solver.step(state, loads, 1e-5);
  for (const vehicle::Track& t : v.tracks) {
    EXPECT_LT(state.twist[static_cast<std::size_t>(t.idler)].v.x, 0);
    EXPECT_GT(state.joint[static_cast<std::size_t>(t.slideJoint)].position, 0) << "away from the sprocket";
  }
}

TEST(RigidArms, WheelsKeepTheirPlacesInTheHullUnderAnyLoad) {
  VehicleSpec spec = test::readySpec();
  spec.arm.suspension = vehicle::Suspension::rigid, spec.arm.preload = 0;
  test::Ride ride = test::rideOnGround(spec, {});
  ride.until(0.8);
  const vehicle::Assembly& v = ride.vehicle();
  const base::Pose hull = vehicle::vehiclePose(v, ride.state);
  for (const vehicle::Track& t : v.tracks) {
    EXPECT_TRUE(t.armSprings.empty());
    for (std::size_t i = 0; i < t.wheels.size(); ++i) {
      const base::Vec3d axle = hull.toBody(ride.state.pose[static_cast<std::size_t>(t.wheels[i])].position);
      // The solver satisfies positions to 1e-10 m.
      EXPECT_NEAR(axle.x, spec.roadWheel.firstX + static_cast<double>(i) * spec.roadWheel.spacing, 1e-9);
      EXPECT_NEAR(axle.z, spec.roadWheel.z, 1e-9);
    }
  }
  // Overlaps of wheels and plates and of shoes and ground, some 5 kN on 3e7 N/m each.
  EXPECT_NEAR(hull.position.z, -spec.groundHeight(), 2e-3);
  EXPECT_EQ(ride.observe().alarm.text, "");
}

} // namespace
