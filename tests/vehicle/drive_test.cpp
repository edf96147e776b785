// SPDX-License-Identifier: BSD-3-Clause
// The complete vehicle on level rigid ground with analytic contact: requirements before any sphere set exists.
#include "base/math.hpp"
#include "ride.hpp"
#include "tests/vehicle/ground_shoes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

using namespace grouser;
using base::Vec3d;

namespace {

using test::Ride;

Ride onGround(double left, double right, double driveRamp = 0.5) {
  return test::rideOnGround(test::readySpec(), {.driveRamp = driveRamp, .speeds = {{0}, {left}, {right}}});
}

} // namespace

TEST(Drive, WeightlessTensionedTrack_HoldsTheIdlerByTwoStrands) {
  vehicle::AssemblyOptions options;
  options.fixChassis = true;
  options.right = false;
  // No weight: only the tensioner acts.
  Ride ride(test::readySpec(), options, {.tensionRamp = 0.2, .weightRamp = 10, .driveStart = 20}, -10);
  ride.until(0.2);
  double tension = 0, force = 0;
  int samples = 0;
  ride.until(0.25, [&] {
    const vehicle::Track& track = ride.vehicle().tracks[0];
    // A pin in the middle of the upper strand's last free stretch, and one of the front strand.
    for (const int pin : {30, test::lastGroundShoe(ride.vehicle().wrap) + 2})
      tension += 0.5 * base::norm(ride.state.joint[track.shoeJoints[pin]].force);
    force += ride.state.joint[track.slideJoint].springForce;
    ++samples;
  });
  tension /= samples, force /= samples;
  // T = F / (1 + cos(front strand)). The strands still oscillate and the wheels carry some of it: 3 %.
  const double frontStrand = ride.vehicle().wrap.kinks[2];
  EXPECT_NEAR(tension, force / (1 + base::cos(frontStrand)), 0.03 * tension);
  EXPECT_GT(force, 8000);
  EXPECT_LT(force, 9200);
}

TEST(Drive, RigidGround_KeepsShoesLevelAndSpeedAtThePitchRadius) {
  Ride ride = onGround(1, 1);
  ride.until(1.5);
  double up = 0, lowest = 1e9, highest = -1e9;
  int samples = 0, steps = 0;
  ride.until(2.9, [&] {
    for (const Vec3d& f : ride.ground().force) up += f.z;
    ++samples;
    if (++steps % 50) return;
    const auto o = ride.observe();
    for (const auto& track : o.tracks)
      for (std::size_t i = 0; i < track.padHeight.size(); ++i)
        if (track.onGround[i] == 1) {
          lowest = std::min(lowest, track.padHeight[i]);
          highest = std::max(highest, track.padHeight[i]);
        }
    ASSERT_EQ(o.alarm.text, "") << "at t = " << o.time;
  });
  const auto o = ride.observe();
  // Reference for the height of a shoe: constant within 1 mm, a grouser's height above ground minus the overlap.
  EXPECT_LT(highest - lowest, 1e-3);
  EXPECT_NEAR(0.5 * (highest + lowest), 0.015, 1e-3);
  // Mean over 1.4 s of a hull that still pitches: 0.5 %.
  EXPECT_NEAR(up / samples, 5018 * 9.81, 0.005 * 5018 * 9.81);
  for (const auto& track : o.tracks) {
    EXPECT_NEAR(track.toothSpeed, ride.vehicle().spec.pitchRadius(), 0.01 * ride.vehicle().spec.pitchRadius());
    EXPECT_LT(std::fabs(track.skipped), 0.05);
    EXPECT_LT(track.sideways, 1e-3);
    EXPECT_GT(track.idlerForce, 8000);
    EXPECT_LT(track.idlerForce, 11500);
  }
  EXPECT_NEAR(o.position.y, 0, 1e-6);
  EXPECT_NEAR(o.heading, 0, 1e-6);
}

TEST(Drive, NegativeSpeed_GoesBackwards) {
  Ride ride = onGround(-2, -2, 0.3);
  ride.until(1.3);
  const auto o = ride.observe();
  EXPECT_NEAR(o.tracks[0].pitchesPassed, o.tracks[0].teethPassed, 0.05);
  EXPECT_LT(o.position.x, -0.2);
  EXPECT_LT(o.tracks[0].speed, -0.4);
}

TEST(Drive, FasterLeftTrack_TurnsRight) {
  Ride ride = onGround(3, 1, 0.3);
  ride.until(1.6);
  const auto o = ride.observe();
  EXPECT_LT(o.heading, -0.02);
  EXPECT_GT(o.tracks[0].speed, o.tracks[1].speed);
  // The outer track drives, the inner one is dragged along.
  EXPECT_GT(o.tracks[0].driveTorque, o.tracks[1].driveTorque);
  EXPECT_EQ(o.alarm.text, "");
}
