// SPDX-License-Identifier: BSD-3-Clause
// Sinkage by its definition: along the local normal, to the middle of the pad, both at the same position.
#include "base/math.hpp"
#include "tests/vehicle/attitude.hpp"
#include "vehicle/observers.hpp"
#include "vehicle/spec_file.hpp"
#include "vehicle/wrap.hpp"

#include <gtest/gtest.h>

#include <cmath>

using namespace grouser;
using base::Pose;
using base::Quat;
using base::Vec3d;

namespace {

using grouser::vehicle::testing::kDegree;

vehicle::VehicleSpec spec() {
  return vehicle::readVehicleSpec(GROUSER_SOURCE_DIR "/assets/vehicles/light_tracked.toml");
}
/// Rotation about an axis of the world.
Quat about(const Vec3d& axis, double angle) {
  const double s = base::sin(0.5 * angle);
  return {base::cos(0.5 * angle), s * axis.x, s * axis.y, s * axis.z};
}
/// A shoe with the middle of its pad at `depth` under `foot`, along `normal`.
Pose shoeUnder(const Vec3d& foot, const Vec3d& normal, double depth, const Quat& orientation) {
  return {foot - normal * depth - base::rotate(orientation, {0, 0, spec().shoe.padBottom}), orientation};
}

} // namespace

TEST(Sinkage, OnASideSlopeOfTenDegrees_IsMeasuredSquareToIt) {
  // The shoe lies along the slope: its lower edge is 0.14 m sin(10 deg) = 24 mm below its middle.
  const double slope = base::sin(10 * kDegree) / base::cos(10 * kDegree);
  const auto surface = [&](double, double y) { return 0.3 + slope * y; };
  const Quat tilt = about({1, 0, 0}, 10 * kDegree);
  const Vec3d normal = base::rotate(tilt, {0, 0, 1});
  for (const double depth : {0.035, 0.0, -0.012})
    EXPECT_NEAR(vehicle::sinkage(spec(), shoeUnder({1, 0.4, 0.3 + slope * 0.4}, normal, depth, tilt), surface), depth,
                1e-14);
}

TEST(Sinkage, OfATiltedShoeIsThatOfItsMiddle) {
  const auto level = [](double, double) { return 0.1; };
  const Quat tilt = about({0, 1, 0}, 0.2);
  EXPECT_NEAR(vehicle::sinkage(spec(), shoeUnder({2, 1, 0.1}, {0, 0, 1}, 0.02, tilt), level), 0.02, 1e-15);
}

TEST(Sinkage, SeesNeitherHeadingNorPlace) {
  const double a = 0.1, b = -0.15, n = std::sqrt(1 + a * a + b * b);
  const auto surface = [&](double x, double y) { return a * x + b * y; };
  for (const double heading : {0.0, 1.0, 2.5})
    EXPECT_NEAR(
        vehicle::sinkage(spec(),
                         shoeUnder({3, -2, a * 3 - b * 2}, Vec3d{-a, -b, 1} * (1 / n), 0.05, about({0, 0, 1}, heading)),
                         surface),
        0.05, 1e-13);
}

TEST(Sinkage, OnACylinder_IsTheDistanceToItsAxis) {
  // A crest and a hollow of radius 3 m across the path. The secants of the slope over one pitch are steeper than its
  // tangents by some w^2 / R^2 = 7e-4, which rotates the normal by at most 1e-4 rad: second order, 1e-9 m.
  const double radius = 3;
  for (const double side : {1.0, -1.0}) {
    const auto surface = [&](double x, double) { return side * std::sqrt(radius * radius - x * x); };
    for (const double angle : {0.0, 0.15, -0.3}) {
      const Vec3d out{base::sin(angle), 0, side * base::cos(angle)};
      const Vec3d foot = out * radius, up = out * side;
      const Pose shoe = shoeUnder(foot, up, 0.06, Quat{});
      EXPECT_NEAR(vehicle::sinkage(spec(), shoe, surface), 0.06, 1e-7) << side << " at " << angle;
    }
  }
}

TEST(Sinkage, OnGrainsTheNormalIsThatOfTheShoesPlace) {
  // Bumps of 4 mm every 54 mm, similar to grains: they change the height of the foot, not the measured direction.
  const auto surface = [](double x, double y) { return 0.002 * base::sin(116 * x) * base::sin(116 * y); };
  for (int k = 0; k < 50; ++k) {
    const double x = 0.0173 * k, y = 0.0291 * k;
    const double found = vehicle::sinkage(spec(), shoeUnder({x, y, 0}, {0, 0, 1}, 0.05, Quat{}), surface);
    EXPECT_NEAR(found, 0.05, 0.0025) << x << " " << y; // 2 mm of the bump, and a direction off by 0.1 at most
  }
}
