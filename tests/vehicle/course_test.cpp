// SPDX-License-Identifier: BSD-3-Clause
// The closed-loop driver on simple plants with known motion, and on the complete vehicle.
#include "vehicle/course.hpp"

#include "base/error.hpp"
#include "base/math.hpp"
#include "ride.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

using namespace grouser;
using vehicle::Course;
using vehicle::CourseOptions;
using vehicle::HullMotion;

namespace {

CourseOptions plain() {
  CourseOptions o;
  o.speed = 2, o.acceleration = 100, o.lookAhead = 1.5;
  o.speedGain = 0.5, o.speedIntegral = 1, o.turnGain = 0.5, o.turnIntegral = 2;
  o.maxSprocketSpeed = 100, o.tread = 1.9, o.pitchRadius = 0.25;
  return o;
}

/// A hull with the instantaneous speed and yaw rate of its tracks, minus slip and skid.
struct Plant {
  double slip = 0, skid = 0; ///< [-]
  double x = 0, y = 0, heading = 0, speed = 0, turnRate = 0;

  HullMotion motion() const { return {x, y, base::cos(heading), base::sin(heading), speed, turnRate}; }
  void step(Course& course, double time, double dt) {
    const auto [left, right] = course.sprocketSpeeds(motion(), time, dt);
    const CourseOptions& o = course.options();
    speed = (1 - slip) * 0.5 * (left + right) * o.pitchRadius;
    turnRate = (1 - skid) * (right - left) * o.pitchRadius / o.tread;
    x += dt * speed * base::cos(heading), y += dt * speed * base::sin(heading), heading += dt * turnRate;
  }
};

/// Distance of a hull from the nearest segment of a path [m].
double awayFrom(const CourseOptions& path, const HullMotion& m) {
  double nearest = 1e300;
  for (std::size_t i = 1; i < path.x.size(); ++i) {
    const double dx = path.x[i] - path.x[i - 1], dy = path.y[i] - path.y[i - 1];
    const double x = m.x - path.x[i - 1], y = m.y - path.y[i - 1];
    const double s = std::clamp((x * dx + y * dy) / (dx * dx + dy * dy), 0.0, 1.0);
    nearest = std::min(nearest, std::hypot(x - s * dx, y - s * dy));
  }
  return nearest;
}

} // namespace

TEST(Course, WithoutErrorsItAsksForTheKinematicSpeeds) {
  CourseOptions o = plain();
  o.curvature = 0.2;
  Course course(o);
  // 2 m/s and 0.4 rad/s: tracks at 2 -+ 0.38 m/s.
  const auto [left, right] = course.sprocketSpeeds({0, 0, 1, 0, 2, 0.4}, 10, 1e-3);
  EXPECT_NEAR(left, (2 - 0.38) / 0.25, 1e-14);
  EXPECT_NEAR(right, (2 + 0.38) / 0.25, 1e-14);
}

TEST(Course, SpeedRisesWithTheAcceleration) {
  CourseOptions o = plain();
  o.acceleration = 0.5, o.speedGain = o.speedIntegral = 0;
  Course course(o);
  EXPECT_NEAR(course.sprocketSpeeds({0, 0, 1, 0, 0, 0}, 1.5, 1e-3)[0], 0.75 / 0.25, 1e-14);
  EXPECT_NEAR(course.sprocketSpeeds({0, 0, 1, 0, 0, 0}, 9, 1e-3)[0], 2 / 0.25, 1e-14);
  o.speed = -2;
  EXPECT_NEAR(Course(o).sprocketSpeeds({0, 0, 1, 0, 0, 0}, 1.5, 1e-3)[1], -0.75 / 0.25, 1e-14);
  // Hull speed at takeover is 1 m/s.
  EXPECT_NEAR(Course(o).sprocketSpeeds({0, 0, 1, 0, 0, 0}, 1.5, 1e-3, 1)[1], (1 - 0.75) / 0.25, 1e-14);
  EXPECT_NEAR(Course(o).sprocketSpeeds({0, 0, 1, 0, 0, 0}, 90, 1e-3, 1)[1], -2 / 0.25, 1e-14);
}

/// speed = (1 - s)(v* + p e + I), e = v* - speed, I' = i e: e falls as exp(-(1 - s) i t / (1 + (1 - s) p)). Here the
/// plant follows by a step.
TEST(Course, SlipIsMadeUpForAsTheClosedFormSays) {
  Course course(plain());
  Plant plant;
  plant.slip = 0.3, plant.speed = 0.7 * 2 / (1 + 0.7 * 0.5) * 1.5; // the instantaneous speed at I = 0
  const double dt = 1e-4, rate = 0.7 * 1 / (1 + 0.7 * 0.5);
  const double first = 2 - plant.speed;
  for (int i = 0; i < 20000; ++i) plant.step(course, 10, dt);
  EXPECT_NEAR(2 - plant.speed, first * std::exp(-rate * 2), 1e-3 * first);
  for (int i = 0; i < 400000; ++i) plant.step(course, 10, dt);
  EXPECT_NEAR(plant.speed, 2, 1e-8) << "no steady-state error";
}

TEST(Course, CircleHasItsRadiusThoughTheTracksSkid) {
  CourseOptions o = plain();
  o.curvature = -0.125;
  Course course(o);
  Plant plant;
  plant.skid = 0.4;
  for (int i = 0; i < 200000; ++i) plant.step(course, 10, 1e-4);
  EXPECT_NEAR(plant.speed / plant.turnRate, -8, 1e-6);
}

/// Pure pursuit of a straight line, small offsets, no slip: y'' + 2 y' / L + 2 y / L^2 = 0 along the path, hence
/// y = y0 exp(-x / L)(cos(x / L) + sin(x / L)).
TEST(Course, OffsetFromALineDiesOutAsTheClosedFormSays) {
  CourseOptions o = plain();
  o.x = {-1, 100}, o.y = {0, 0};
  Course course(o);
  Plant plant;
  plant.y = 0.01, plant.speed = 2;
  const double dt = 1e-4, L = o.lookAhead;
  for (int i = 0; i < 20000; ++i) {
    plant.step(course, 10, dt);
    const double s = plant.x / L, wanted = 0.01 * std::exp(-s) * (std::cos(s) + std::sin(s));
    // Second order in y0 / L, first order in the step.
    ASSERT_NEAR(plant.y, wanted, 1e-2 * 0.01) << plant.x;
  }
}

/// On a polygonal circle the deviation is within the cut corners and the look-ahead error.
TEST(Course, FollowsACircleOfPointsAndStopsAtItsEnd) {
  CourseOptions o = plain();
  const double R = 8;
  for (int i = 0; i <= 60; ++i) {
    const double a = 1.5 * base::kPi * i / 60;
    o.x.push_back(R * base::sin(a)), o.y.push_back(R * (1 - base::cos(a)));
  }
  o.acceleration = 1;
  Course course(o);
  Plant plant;
  plant.skid = 0.3;
  double worst = 0;
  for (int i = 0; i < 400000; ++i) {
    plant.step(course, 1e-4 * i, 1e-4);
    worst = std::max(worst, std::fabs(std::sqrt(plant.x * plant.x + (plant.y - R) * (plant.y - R)) - R));
  }
  EXPECT_LT(worst, 0.1); // the skid is estimated over the first metres
  EXPECT_NEAR(course.travelled(), course.length(), 0.02);
  EXPECT_LT(plant.speed, 0.1);
}

TEST(Course, PathThatCrossesItselfIsFollowedInItsOrder) {
  CourseOptions o = plain();
  o.x = {0, 10, 10, 5, 5}, o.y = {0, 0, 5, 5, -8}, o.lookAhead = 1, o.speed = 1; // first crossing at (5, 0)
  Course course(o);
  Plant plant;
  double way = 0;
  for (int i = 0; i < 400000; ++i) {
    plant.step(course, 1e-4 * i, 1e-4);
    ASSERT_GE(course.travelled(), way);
    way = course.travelled();
  }
  EXPECT_NEAR(plant.x, 5, 0.1);
  EXPECT_LT(plant.y, -7.8);
}

TEST(Course, AtItsMostBothSidesAreScaledAndNothingAddsUp) {
  CourseOptions o = plain();
  o.maxSprocketSpeed = 6, o.curvature = 0.2;
  Course course(o);
  const auto [left, right] = course.sprocketSpeeds({0, 0, 1, 0, 2, 0.4}, 10, 1e-3);
  EXPECT_NEAR(right, 6, 1e-14);
  EXPECT_NEAR(left / right, 1.62 / 2.38, 1e-14);
  EXPECT_EQ(course.save(), (std::vector<double>{0, 0, 0}));
}

TEST(Course, GoesOnFromWhatItSaved) {
  CourseOptions o = plain();
  o.x = {0, 5, 9}, o.y = {0, 1, -3};
  Course straight(o);
  Plant plant;
  plant.slip = 0.2, plant.skid = 0.3;
  for (int i = 0; i < 10000; ++i) plant.step(straight, 1e-4 * i, 1e-4);
  Course resumed(o);
  const std::vector<double> saved = straight.save();
  for (const double value : saved) EXPECT_NE(value, 0);
  resumed.restore(saved.data());
  EXPECT_EQ(resumed.sprocketSpeeds(plant.motion(), 1, 1e-4), straight.sprocketSpeeds(plant.motion(), 1, 1e-4));
}

TEST(Course, BadPathsAreRefused) {
  const auto refused = [](auto change) {
    CourseOptions o = plain();
    change(o);
    EXPECT_THROW(Course{o}, base::InputError);
  };
  refused([](CourseOptions& o) { o.x = {0, 1}, o.y = {0}; });
  refused([](CourseOptions& o) { o.x = {0}, o.y = {0}; });
  refused([](CourseOptions& o) { o.x = {0, 0}, o.y = {1, 1}; });
  refused([](CourseOptions& o) { o.x = {0, 1}, o.y = {1, 1}, o.speed = -1; });
  refused([](CourseOptions& o) { o.acceleration = 0; });
}

namespace {

vehicle::DriverOptions driving(const vehicle::VehicleSpec& spec, CourseOptions o) {
  o.acceleration = 1, o.lookAhead = spec.roadWheel.spacing * (spec.roadWheel.count - 1);
  o.tread = 2 * spec.trackOffset, o.pitchRadius = spec.pitchRadius();
  vehicle::DriverOptions driver;
  driver.course = o;
  return driver;
}

} // namespace

TEST(CourseOfAVehicle, HoldsTheHullsSpeedOnRigidGround) {
  CourseOptions o = plain();
  o.speed = 0.8;
  test::Ride ride = test::rideOnGround(test::readySpec(), driving(test::readySpec(), o));
  ride.until(3.5);
  double speed = 0;
  int n = 0;
  ride.until(4.5, [&] { speed += ride.motion().speed, ++n; });
  EXPECT_NEAR(speed / n, 0.8, 0.004); // teeth cause a ripple; mean over some of them: 0.5 %
  EXPECT_NEAR(ride.motion().y, 0, 1e-5);
}

TEST(CourseOfAVehicle, TurnsInTheCircleThatIsAskedFor) {
  CourseOptions o = plain();
  o.speed = 0.8, o.curvature = 0.125;
  test::Ride ride = test::rideOnGround(test::readySpec(), driving(test::readySpec(), o));
  ride.until(5);
  double speed = 0, turn = 0;
  ride.until(7, [&] { speed += ride.motion().speed, turn += ride.motion().turnRate; });
  EXPECT_NEAR(speed / turn, 8, 0.16);
  EXPECT_EQ(ride.observe().alarm.text, "");
}

TEST(CourseOfAVehicle, StaysBesideAPathThatSwervesByLessThanAQuarterOfALookAhead) {
  CourseOptions o = plain();
  o.speed = 1, o.x = {0, 3, 7, 12}, o.y = {0, 0, 1, 1};
  test::Ride ride = test::rideOnGround(test::readySpec(), driving(test::readySpec(), o));
  double worst = 0;
  ride.until(9, [&] { worst = std::max(worst, awayFrom(o, ride.motion())); });
  EXPECT_GT(ride.motion().x, 7);
  EXPECT_LT(worst, 0.25 * 4 * 0.4458);
  EXPECT_NEAR(ride.motion().y, 1, 0.1) << "finally on the line";
  EXPECT_EQ(ride.observe().alarm.text, "");
}
