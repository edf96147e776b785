// SPDX-License-Identifier: BSD-3-Clause
// Motions of one grain in closed form: sliding to rest on a damped spring, slip at the contact point of rotating bodies
// and torques below float resolution.
#include "contact/grain_loads.hpp"
#include "surface_fixture.hpp"
#include "tests/device_under_test.hpp"

#include <gtest/gtest.h>

namespace grouser::terrain::testing {
namespace {

TEST(SlidingWithDamping, EndsInADampedSwingOfTheTangentialSpring) {
  const double mu = 0.3, v0 = 0.05, g = 9.81;
  GrainModel m = roughBall(2e-7, mu, 0);
  m.law.damping = 0, m.law.tangentialDamping = 3000; // c_t = gamma_t m
  const double k = m.law.tangentialStiffness, R = m.radius, overlap = m.mass * g / m.law.stiffness;
  Grains grains(testExec(1), m, {{floorPlane(m.law)}, {}}, {{{0, 0, R - overlap}, {v0, 0, 0}, {}}});
  // The contact point slows down by mu g (1 + 5/2) while it slides, then it swings with 2/7 of the mass from the
  // spring's length at Coulomb's limit: s = s0 e^(-a t) (cos w t + a / w sin w t).
  const double slides = v0 / (3.5 * mu * g), s0 = mu * m.mass * g / k;
  const double a = 3.5 * 3000 / 2, w = std::sqrt(3.5 * k / m.mass - a * a);
  std::int64_t taken = 0;
  for (const double after : {-0.5 * slides, 0.5e-4, 1e-4, 2e-4, 3e-4, 5e-4}) {
    const auto n = static_cast<std::int64_t>(std::lround((slides + after) / m.timeStep));
    advance(grains, n - taken), taken = n;
    const double t = static_cast<double>(n) * m.timeStep - slides;
    const double slip = t < 0 ? -3.5 * mu * g * t : -s0 * base::exp(-a * t) * (a * a + w * w) / w * base::sin(w * t);
    // Angular momentum about the contact is kept: v = 5/7 v0 + 2/7 of the slip.
    const GrainSnapshot s = grains.snapshot();
    // The slip changes sign once in 25,000 steps, and the spring has 1e-4 of a period per step.
    EXPECT_NEAR(s.velocity[0].x, 5.0 / 7 * v0 + 2.0 / 7 * slip, 3e-6) << after;
    EXPECT_NEAR(s.spin[0].y * R, 5.0 / 7 * (v0 - slip), 1e-5) << after;
  }
  EXPECT_GT(s0 * w, 5e-4) << "the oscillation is far above the tolerance";
}

TEST(RollingSwing, OfABallOnAPlaneDiesOutAsItsDampingRatioSays) {
  // About the contact point 7/5 m R^2 swings on the rolling spring: w = w0 e^(-zeta o t) (cos p t - zeta o / p sin p
  // t), p = o sqrt(1 - zeta^2). Its tangential spring is 250 times as stiff.
  const double mu = 0.05, zeta = 0.3, g = 9.81;
  GrainModel m = roughBall(2e-6, 5, 0);
  m.law.rollingFriction = mu, m.law.rollingDamping = zeta;
  m.law.tangentialDamping = 1.2 * std::sqrt(m.law.stiffness / m.mass);
  const double k = m.law.stiffness, R = m.radius, overlap = m.mass * g / k;
  const double o = std::sqrt(2.25 * k * mu * mu / (1.4 * m.mass)), p = o * std::sqrt(1 - zeta * zeta);
  const double w0 = 0.3 * o * m.mass * g / (2.25 * k * mu * R); // 0.3 of the amplitude at its limit
  Grains grains(testExec(1), m, {{floorPlane(m.law)}, {}}, {{{0, 0, R - overlap}, {w0 * R, 0, 0}, {0, w0, 0}}});
  std::int64_t taken = 0;
  for (const double angle : {0.5, 1.0, 2.0, 3.0, 4.5, 6.0}) {
    const auto n = static_cast<std::int64_t>(std::lround(angle / p / m.timeStep));
    advance(grains, n - taken), taken = n;
    const double t = static_cast<double>(n) * m.timeStep;
    const double w = w0 * base::exp(-zeta * o * t) * (base::cos(p * t) - zeta * o / p * base::sin(p * t));
    EXPECT_NEAR(grains.snapshot().spin[0].y, w, 0.02 * w0) << angle << ": deflection of the tangential spring";
  }
}

/// Direction of the friction force on a grain in its first step, with full sliding.
base::Vec3d dragged(const GrainModel& m, const Boundaries& boundaries, const std::vector<GrainSpec>& start,
                    const std::vector<SurfacePose>& poses, const base::Vec3d& normal) {
  Grains grains(testExec(1), m, boundaries, start);
  if (!poses.empty()) grains.setSurfacePoses(poses);
  grains.refreshNeighbours();
  grains.step();
  const base::Vec3d f = grains.snapshot({.contactForces = true}).contactForce[0].as<double>();
  EXPECT_GT(dot(f, normal), 0);
  const base::Vec3d tangential = f - normal * dot(f, normal);
  EXPECT_NEAR(norm(tangential), 0.2 * dot(f, normal), 1e-3 * dot(f, normal)) << "it slides";
  return base::normalized(tangential);
}

/// Sliding from the first touch: the dashpot force by itself exceeds Coulomb's limit.
GrainModel slippery() {
  GrainModel m = ball(1e-6);
  makeRough(m.law, 0, 0.2);
  m.law.tangentialDamping = 1e6;
  m.maxOverlap = 1;
  return m;
}

TEST(SlipAtTheContact, OfAGrainOnATurningBoxTakesBothSpinsAndVelocities) {
  const GrainModel m = slippery();
  const Vec3d centre{0.3, -0.2, 0.1}, v{0.5, -0.7, 0}, w{11, 23, 5}, V{-0.4, 0.3, 0}, W{0, 0, 9};
  const double overlap = 1e-5;
  const Vec3d place = centre + Vec3d{0.04, 0.03, 0.02 + m.radius - overlap};
  const SurfacePose pose = placed(centre, {}, {}, V, W);
  const Boundaries boundaries{.walls = {}, .floor = {}, .surfaces = {{boxOf({0.1, 0.1, 0.02}), m.law, pose}}};
  const Vec3d is = dragged(m, boundaries, {{place, v, w}}, {pose}, {0, 0, 1});
  // The grain's lowest point, a radius minus the overlap below; the box's point there, rotating about its centre.
  const double arm = m.radius - overlap;
  const Vec3d grain = v + cross(w, Vec3d{0, 0, -arm}), box = V + cross(W, Vec3d{0.04, 0.03, 0.02});
  const Vec3d slip = grain - box;
  const Vec3d wanted = -base::normalized(Vec3d{slip.x, slip.y, 0});
  EXPECT_NEAR(norm(is - wanted), 0, 2e-4);
}

TEST(SlipAtTheContact, OfAGrainOnATurningCylinderIsTakenAtItsSurface) {
  const GrainModel m = slippery();
  const double radius = 0.05, overlap = 1e-5;
  // The axis is along y; the grain is above it to the right, where the surface moves along (0.8, 0, -0.6).
  const base::Quat aboutY = turn({1, 0, 0}, -base::kPi / 2);
  const Vec3d normal{0.6, 0, 0.8}, W{0, 12, 0}, V{0, 0.2, 0}, v{0.1, 0.1, -0.075}, w{0, 7, 0};
  const SurfacePose pose = placed({}, aboutY, {}, V, W);
  const Boundaries boundaries{.walls = {}, .floor = {}, .surfaces = {{cylinderOf(radius, 0.1), m.law, pose}}};
  const Vec3d is = dragged(m, boundaries, {{normal * (radius + m.radius - overlap), v, w}}, {pose}, normal);
  const Vec3d slip = v + cross(w, normal * -(m.radius - overlap)) - V - cross(W, normal * (radius));
  const Vec3d along = slip - normal * dot(slip, normal);
  EXPECT_NEAR(norm(is + base::normalized(along)), 0, 2e-4);
}

TEST(SlipAtTheContact, OfAGrainOnAPlaneIsThatOfItsLowestPoint) {
  const GrainModel m = slippery();
  const Vec3d v{0.3, 0.2, 0}, w{50, -20, 8};
  const Vec3d is = dragged(m, {{floorPlane(m.law)}, {}}, {{{0.1, 0.2, m.radius - 1e-5}, v, w}}, {}, {0, 0, 1});
  const Vec3d slip = v + cross(w, Vec3d{0, 0, -m.radius + 1e-5});
  EXPECT_NEAR(norm(is + base::normalized(Vec3d{slip.x, slip.y, 0})), 0, 2e-4);
}

TEST(SlipAtTheContact, OfTwoGrainsTakesEachOnesArm) {
  GrainModel m = slippery();
  const double small = 0.5 * m.radius, overlap = 1e-5;
  for (const double other : {m.radius, small}) {
    const Vec3d v{0.2, 0.1, 0}, w{5, 30, -9}, V{-0.1, 0.3, 0}, W{-40, 10, 3};
    const Vec3d is = dragged(
        m, {}, {{{0, 0, 0}, V, W, other, 0}, {{0, 0, other + m.radius - overlap}, v, w, m.radius, 0}}, {}, {0, 0, -1});
    // Velocity of the first relative to the second: both lever arms end in the middle of the overlap.
    const Vec3d slip =
        V + cross(W, Vec3d{0, 0, other - overlap / 2}) - v - cross(w, Vec3d{0, 0, -m.radius + overlap / 2});
    EXPECT_NEAR(norm(is + base::normalized(Vec3d{slip.x, slip.y, 0})), 0, 2e-4) << other;
  }
}

/// Steps a grain under a torque from a part [N m].
base::Vec3d spunBy(const base::Vec3d& torque, const base::Vec3d& spin, int steps, const GrainModel& m) {
  const base::Exec exec = base::cpuExec(1);
  Grains grains(exec, m, {}, {{{}, {}, spin}});
  const std::vector<std::uint32_t> range{1}; // one load, the first
  const std::vector<contact::GrainLoad> load{{{}, torque.as<float>(), 0}};
  std::vector<std::int64_t> received(3, 0);
  const contact::GrainLoadsView view{range.data(), load.data(), base::fixedPointFor(1, 36), received.data()};
  for (int n = 0; n < steps; ++n) {
    grains.refreshNeighbours();
    grains.step(&view);
  }
  return grains.snapshot().spin[0].as<double>();
}

TEST(SmallTorque, SpinsAGrainUpAsInExactNumbers) {
  const int steps = 100000;
  GrainModel m = ball(1e-6);
  const double inertia = 0.4 * m.mass * m.radius * m.radius;
  // One radian per second squared, two and minus a half: 1e-6 rad/s per step; a float at 0.1 rad/s loses up to
  // 4e-9.
  const base::Vec3d alpha{1, 2, -0.5}, torque = alpha * inertia;
  const base::Vec3d given = torque.as<float>().as<double>() * (1 / inertia); // the load is a float
  const base::Vec3d w = spunBy(torque, {}, steps, m);
  for (int a = 0; a < 3; ++a) EXPECT_NEAR(w[a] / (given[a] * steps * m.timeStep), 1, 1e-6) << a;
}

TEST(SmallTorque, IsNotLostBesideAFastSpin) {
  // At 100 rad/s a float's last place is 7.6e-6: 1e-6 per step would be lost. A remainder resolves 1.2e-10.
  const int steps = 100000;
  const GrainModel m = ball(1e-6);
  const double inertia = 0.4 * m.mass * m.radius * m.radius;
  const base::Vec3d w = spunBy(base::Vec3d{1, -1, 0} * inertia, {100, 100, -100}, steps, m);
  EXPECT_NEAR(w.x - 100, 0.1, 2e-5);
  EXPECT_NEAR(w.y - 100, -0.1, 2e-5);
  EXPECT_EQ(w.z, -100);
}

} // namespace
} // namespace grouser::terrain::testing
