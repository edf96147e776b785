// SPDX-License-Identifier: BSD-3-Clause
// Hitch force on points with known motion: closed forms and the discrete recurrence.
#include "vehicle/hitch.hpp"

#include "base/error.hpp"
#include "base/math.hpp"

#include <gtest/gtest.h>

#include <cmath>

using namespace grouser;
using base::Vec3d;
using vehicle::Hitch;
using vehicle::HitchKind;
using vehicle::HitchMotion;
using vehicle::HitchOptions;

namespace {

const Vec3d kHitchGravity{0, 0, -9.81};

HitchOptions of(HitchKind kind) {
  HitchOptions o;
  o.kind = kind, o.mass = 400, o.friction = 0.6, o.length = 3;
  o.stiffness = 1e6, o.damping = 2e4;
  return o;
}

HitchMotion at(double x, double speed, double trackSpeed = 0) { return {{x, 0, 0.4}, {speed, 0, 0}, 1, 0, trackSpeed}; }

/// A block on level ground without friction, subject to the hitch only, by symplectic Euler.
struct Block {
  double mass = 1000, x = 0, speed = 0, time = 0;
  double step(Hitch& hitch, double dt, double thrust = 0, double trackSpeed = 0) {
    const Vec3d force = hitch.step(at(x, speed, trackSpeed), time, dt, kHitchGravity);
    speed += (force.x + thrust) / mass * dt, x += speed * dt, time += dt;
    return force.x;
  }
};

} // namespace

TEST(Hitch, ForceOnAFreeBlockIsMassTimesAcceleration) {
  HitchOptions o = of(HitchKind::force);
  o.force = 250;
  Hitch hitch(o);
  Block block;
  for (int i = 0; i < 2000; ++i) block.step(hitch, 1e-3);
  // The recurrence: v_n = -n F dt / m, x_n = -n (n + 1) / 2 F dt^2 / m.
  EXPECT_NEAR(block.speed, -2000 * 0.25 * 1e-3, 1e-12);
  EXPECT_NEAR(block.x, -2000. * 2001. / 2 * 0.25 * 1e-6, 1e-12);
}

TEST(Hitch, AddedUnderWayTakesHoldThereAndComesOnFromThere) {
  HitchOptions o = of(HitchKind::ramp);
  o.force = 100, o.rate = 50, o.start = 1;
  Hitch hitch(o);
  hitch.holdFrom(3);
  const HitchMotion ahead{{0, 0, 0}, {0, 0, 0}, 1, 0, 0};
  EXPECT_EQ(hitch.step(ahead, 2.9, 1e-3, kHitchGravity), Vec3d{});
  EXPECT_EQ(hitch.step(ahead, 3, 1e-3, kHitchGravity).x, -100);
  Hitch resumed(o);
  resumed.restore(hitch.save());
  EXPECT_EQ(resumed.step(ahead, 5, 1e-3, kHitchGravity).x, -200);
  Hitch early(o);
  early.holdFrom(0.5);
  EXPECT_EQ(early.save(), Hitch(o).save()) << "the ramp has not started";
}

TEST(Hitch, ForceActsAgainstTheHeadingFromItsStartOnAndComesOnSmoothly) {
  HitchOptions o = of(HitchKind::force);
  o.force = 250, o.start = 1, o.ramp = 0.5;
  Hitch hitch(o);
  const HitchMotion aslant{{0, 0, 0}, {0, 0, 0}, 0.6, 0.8, 0};
  EXPECT_EQ(hitch.step(aslant, -1, 1e-3, kHitchGravity), Vec3d{});
  EXPECT_EQ(hitch.step(aslant, 0.99, 1e-3, kHitchGravity), Vec3d{});
  EXPECT_FALSE(hitch.holds());
  const Vec3d half = hitch.step(aslant, 1.25, 1e-3, kHitchGravity), all = hitch.step(aslant, 2, 1e-3, kHitchGravity);
  EXPECT_NEAR(half.x, -0.6 * 125, 1e-12);
  EXPECT_NEAR(half.y, -0.8 * 125, 1e-12);
  EXPECT_NEAR(norm(all), 250, 1e-12);
  EXPECT_EQ(all.z, 0);
}

TEST(Hitch, RampGrowsAtItsRate) {
  HitchOptions o = of(HitchKind::ramp);
  o.force = 100, o.rate = 40, o.start = 0.5;
  Hitch hitch(o);
  EXPECT_EQ(hitch.step(at(0, 0), 0.4, 1e-3, kHitchGravity).x, 0);
  EXPECT_NEAR(hitch.step(at(0, 0), 0.5, 1e-3, kHitchGravity).x, -100, 1e-12);
  EXPECT_NEAR(hitch.step(at(0, 0), 3, 1e-3, kHitchGravity).x, -200, 1e-12);
}

TEST(Hitch, AForceTowsNothingAndHasNoSpeed) {
  for (const HitchKind kind : {HitchKind::force, HitchKind::ramp}) {
    Hitch hitch(of(kind));
    hitch.step(at(0, 0.7), 0, 1e-3, kHitchGravity);
    EXPECT_TRUE(hitch.holds());
    EXPECT_EQ(hitch.towedSpeed(), 0);
    EXPECT_EQ(hitch.way(), 0);
  }
}

TEST(Hitch, SledAtConstantSpeedPullsWithItsFriction) {
  Hitch hitch(of(HitchKind::sled));
  double pull = 0;
  for (int i = 0; i < 200000; ++i) pull = hitch.step(at(0.5 * 1e-4 * i, 0.5), 1e-4 * i, 1e-4, kHitchGravity).x;
  EXPECT_NEAR(pull, -0.6 * 400 * 9.81, 1e-6 * 0.6 * 400 * 9.81) << "residual oscillation of the rope after 20 s";
  EXPECT_NEAR(hitch.towedSpeed(), 0.5, 1e-9);
  EXPECT_NEAR(hitch.way(), 10, 0.01) << "less by the stretch of the rope, mu m g / k = 2.4 mm";
}

TEST(Hitch, SledHoldsUntilItsFrictionIsOvercome) {
  Hitch hitch(of(HitchKind::sled));
  const double limit = 0.6 * 400 * 9.81; // 2354 N: a stretch of 2.354 mm
  double pull = 0;
  for (int i = 0; i < 1000; ++i) pull = hitch.step(at(0.99 * limit / 1e6, 0), 1e-4 * i, 1e-4, kHitchGravity).x;
  // The hitch engages at the current position: distance counts from there.
  EXPECT_EQ(pull, 0);
  for (int i = 0; i < 1000; ++i) pull = hitch.step(at(1.98 * limit / 1e6, 0), 0.1 + 1e-4 * i, 1e-4, kHitchGravity).x;
  EXPECT_NEAR(pull, -0.99 * limit, 1e-9 * limit);
  EXPECT_EQ(hitch.way(), 0);
  for (int i = 0; i < 1000; ++i) pull = hitch.step(at(2.2 * limit / 1e6, 0), 0.2 + 1e-4 * i, 1e-4, kHitchGravity).x;
  EXPECT_GT(hitch.way(), 0);
}

TEST(Hitch, RopeOfASledDoesNotPush) {
  Hitch hitch(of(HitchKind::sled));
  hitch.step(at(0, 0), 0, 1e-4, kHitchGravity);
  EXPECT_EQ(hitch.step(at(-0.5, -1), 1, 1e-4, kHitchGravity), Vec3d{});
}

/// Block and sled move together under a constant thrust: a = (thrust - mu m g) / (M + m), T = mu m g + m a.
TEST(Hitch, SledAddsItsMass) {
  Hitch hitch(of(HitchKind::sled));
  Block block;
  double pull = 0, mean = 0;
  for (int i = 0; i < 100000; ++i) {
    pull = block.step(hitch, 1e-4, 5000);
    if (i >= 50000) mean += pull / 50000;
  }
  const double friction = 0.6 * 400 * 9.81, acceleration = (5000 - friction) / 1400;
  EXPECT_NEAR(-mean, friction + 400 * acceleration, 1e-4 * friction) << "residual oscillation after 5 s";
}

TEST(Hitch, SledFollowsAndPullsTowardsItself) {
  Hitch hitch(of(HitchKind::sled));
  hitch.step(at(0, 0), 0, 1e-4, kHitchGravity); // the sled is at (-3, 0)
  HitchMotion aside = at(1.2, 0);
  aside.position.y = 1.2; // to (1.2, 1.2): the direction to the sled is (-4.2, -1.2)
  const Vec3d force = hitch.step(aside, 1e-4, 1e-4, kHitchGravity);
  EXPECT_NEAR(force.y / force.x, 1.2 / 4.2, 1e-12);
  EXPECT_LT(force.x, 0);
}

TEST(Hitch, CarriageHoldsTheSpeedThatTheSlipSays) {
  HitchOptions o = of(HitchKind::speed);
  o.slip = 0.3;
  o.damping = 2 * 0.7 * std::sqrt(o.stiffness * 1000);
  Hitch hitch(o);
  Block block;
  double pull = 0;
  for (int i = 0; i < 30000; ++i) pull = block.step(hitch, 1e-4, 3000, 0.8);
  EXPECT_NEAR(block.speed, 0.7 * 0.8, 1e-9);
  EXPECT_NEAR(pull, -3000, 1e-6) << "a driving force counts as pull";
  EXPECT_NEAR(block.x - hitch.way(), 3000 / 1e6, 1e-9) << "it yields by F / k";
  // If the thrust is too small for the carriage's speed, the carriage pushes.
  for (int i = 0; i < 30000; ++i) pull = block.step(hitch, 1e-4, -500, 0.8);
  EXPECT_NEAR(pull, 500, 1e-6);
}

TEST(Hitch, CarriageTakesOverAMovingHullSmoothly) {
  HitchOptions o = of(HitchKind::speed);
  o.slip = 0.5, o.ramp = 0.4;
  o.stiffness = 1e8, o.damping = 2 * 0.7 * std::sqrt(o.stiffness * 1000); // its period is short compared with the ramp
  Hitch hitch(o);
  Block block;
  block.speed = 1;
  EXPECT_EQ(block.step(hitch, 1e-4, 0, 1), 0) << "at the hull's initial speed";
  double most = 0;
  for (int i = 0; i < 8000; ++i) most = std::fmax(most, -block.step(hitch, 1e-4, 0, 1));
  EXPECT_NEAR(block.speed, 0.5, 1e-6);
  // The ramp 3 s^2 - 2 s^3 is steepest in its middle, 1.5 / ramp: 1000 kg x 0.5 m/s x 1.5 / 0.4 s.
  EXPECT_NEAR(most, 1875, 0.01 * 1875) << "1 % is the lag at 316 rad/s behind a ramp of 0.4 s";
}

TEST(Hitch, SavedAndRestoredItGoesOnAlike) {
  for (const HitchKind kind : {HitchKind::force, HitchKind::ramp, HitchKind::sled, HitchKind::speed}) {
    HitchOptions o = of(kind);
    o.force = 30, o.rate = 7, o.slip = 0.2, o.ramp = 0.5;
    Hitch one(o), other(o);
    Block block;
    for (int i = 0; i < 500; ++i) block.step(one, 1e-3, 4000, 0.5);
    other.restore(one.save());
    Block copy = block;
    for (int i = 0; i < 500; ++i) EXPECT_EQ(block.step(one, 1e-3, 4000, 0.5), copy.step(other, 1e-3, 4000, 0.5));
    EXPECT_EQ(one.save(), other.save());
    EXPECT_THROW(other.restore({1, 2}), base::InputError);
  }
}

TEST(Hitch, RefusesWhatIsOutOfRange) {
  HitchOptions o = of(HitchKind::sled);
  o.mass = 0;
  EXPECT_THROW(Hitch{o}, base::InputError);
  o = of(HitchKind::speed), o.stiffness = 0;
  EXPECT_THROW(Hitch{o}, base::InputError);
  o = of(HitchKind::force), o.start = -1;
  EXPECT_THROW(Hitch{o}, base::InputError);
}
