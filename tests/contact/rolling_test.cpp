// SPDX-License-Identifier: BSD-3-Clause
// Rolling resistance and cohesion of one sphere on a plane, against closed forms.
#include "base/math.hpp"
#include "contact/restitution.hpp"
#include "contact_fixture.hpp"

#include <gtest/gtest.h>

namespace grouser::contact::testing {
namespace {

constexpr double kGravity = 9.81;

/// A ball of 1 kg and 5 cm at rest on the plane, at its static overlap.
SphereOnPlane resting(double rollingFriction) {
  SphereOnPlane s;
  s.radius = 0.05, s.mass = 1;
  s.law.stiffness = 2e5, s.law.tangentialStiffness = 2e5 * 2 / 7;
  s.law.damping = 2 * 0.3 * std::sqrt(2e5), s.law.tangentialDamping = s.law.damping / 2;
  s.law.friction = 0.5, s.law.rollingFriction = rollingFriction, s.law.rollingDamping = 0.3;
  s.gravity = {0, 0, -kGravity};
  s.position.z = s.radius - s.mass * kGravity / s.law.stiffness;
  return s;
}

TEST(RollingResistance, RollingBallStopsWhereAConstantTorqueStopsIt) {
  // Energy: (7/10) m v0^2 = mu_r m g x.
  SphereOnPlane s = resting(0.1);
  const double v0 = 1, dt = 2e-5;
  s.velocity.x = v0, s.spin.y = v0 / s.radius;
  const double x = 7 * v0 * v0 / (10 * 0.1 * kGravity), t = 7 * v0 / (5 * 0.1 * kGravity); // 0.713558 m, 1.427115 s
  EXPECT_NEAR(x, 0.713558, 1e-6);
  double stopped = 0;
  for (int i = 0; i * dt < t + 1; ++i) {
    s.step(dt);
    if (stopped == 0 && s.velocity.x <= 0) stopped = i * dt;
  }
  // The rolling spring builds up first, over mu_r R F / k_r = F / (2.25 k mu_r R) rad, i.e. 2e-4 m of travel here.
  EXPECT_NEAR(s.position.x, x, 5e-4);
  EXPECT_NEAR(stopped, t, 0.01 * t);
  // The spring oscillation decays at 57 1/s with a damping ratio of 0.3.
  EXPECT_NEAR(s.spin.y, 0, 1e-6) << "type C comes to rest";
  EXPECT_NEAR(s.velocity.x, 0, 1e-7);
}

TEST(RollingResistance, PushedSphereIsAtRestWithinASecond) {
  // Ai et al. 2011, test 1, as in Chrono.
  SphereOnPlane s = resting(0.2);
  s.radius = 0.5, s.mass = 1, s.law.friction = 0.3;
  s.position.z = s.radius - s.mass * kGravity / s.law.stiffness;
  s.velocity.x = 1;
  for (int i = 0; i < 50000; ++i) s.step(2e-5);
  EXPECT_LT(norm(s.spin), 1e-3) << "criterion of Chrono's test";
}

TEST(RollingResistance, HoldsOnASlopeUpToItsCoefficient) {
  for (const double share : {0.97, 1.03}) {
    SphereOnPlane s = resting(0.1);
    const double theta = base::atan(0.1 * share);
    s.gravity = {kGravity * base::sin(theta), 0, -kGravity * base::cos(theta)};
    for (int i = 0; i < 25000; ++i) s.step(2e-5);
    const double wound = norm(s.velocity); // after the spring has reached its limit
    for (int i = 0; i < 25000; ++i) s.step(2e-5);
    const double rolled = (norm(s.velocity) - wound) / 0.5;
    // Above the limit: a = (5/7) g (sin - mu_r cos).
    const double free = 5.0 / 7 * kGravity * (base::sin(theta) - 0.1 * base::cos(theta));
    if (share < 1)
      EXPECT_LT(norm(s.velocity), 1e-6);
    else
      EXPECT_NEAR(rolled, free, 0.01 * free) << "the difference of two forces 30 times larger";
  }
}

TEST(RollingResistance, SwappingTheSidesChangesOnlyTheSign) {
  BasicLaw<float> law;
  law.rollingFriction = 0.1f, law.rollingDamping = 0.3f;
  base::Vec3f angle{1e-4f, 2e-4f, -1e-4f}, other = -angle;
  RollingMotion<float> m{base::normalized(base::Vec3f{1, 2, 3}), {1, -2, 0.5f}, 0.01f, 1e-5f};
  float lost = 0, lostThere = 0;
  const base::Vec3f torque = rollingTorque(law, m, 10.0f, 1e5f, 1e-5f, angle, lost);
  m.normal = -m.normal, m.spin = -m.spin;
  const base::Vec3f back = rollingTorque(law, m, 10.0f, 1e5f, 1e-5f, other, lostThere);
  EXPECT_EQ(torque, -back);
  EXPECT_EQ(angle, -other);
  EXPECT_EQ(lost, lostThere);
  EXPECT_NEAR(dot(torque, m.normal), 0, 1e-6 * norm(torque)) << "twist is not resisted; float round-off";
}

TEST(RollingResistance, EnergyBalances) {
  SphereOnPlane s = resting(0.1);
  s.velocity.x = 1, s.spin.y = 1 / s.radius;
  const double before = s.energy(), dt = 1e-5;
  for (int i = 0; i < 100000; ++i) s.step(dt);
  EXPECT_NEAR((s.energy() + s.dissipated - before) / before, 0, 2e-3) << "first order in the step";
}

TEST(Cohesion, PullOffForceIsTwoPiWRadius) {
  // Hung from the plane and pulled down slowly: holds just below the pull-off force, falls just above.
  const double w = 0.05, radius = 1e-3, pull = 2 * base::kPi * w * radius;
  for (const double share : {0.99, 1.01}) {
    SphereOnPlane s;
    s.radius = radius, s.mass = 1e-5;
    s.law.stiffness = 100, s.law.pullPerRadius = 2 * base::kPi * w;
    s.law.damping = 2 * std::sqrt(100 / s.mass), s.law.attraction = true;
    s.position.z = radius - pull / s.law.stiffness; // pressed together by its own cohesion
    const double dt = 1e-6;
    const int n = 200000;
    for (int i = 0; i < n; ++i) {
      s.gravity.z = share * pull / s.mass * std::min(1.0, 2.0 * i / n);
      s.step(dt);
    }
    EXPECT_EQ(s.overlap() > 0, share < 1) << share;
  }
}

TEST(Cohesion, SlowBallSticksAndFastOneLeavesWithItsEnergy) {
  // Without damping the work of adhesion on approach equals that on separation.
  SphereOnPlane s;
  s.radius = 1e-3, s.mass = 1e-5, s.law.stiffness = 100, s.law.pullPerRadius = 0.3;
  const double dt = base::kPi * std::sqrt(s.mass / s.law.stiffness) / 4000;
  s.position.z = s.radius + 0.5 * dt * 0.1, s.velocity.z = -0.1;
  do s.step(dt);
  while (s.overlap() > 0 || s.velocity.z < 0);
  EXPECT_NEAR(s.velocity.z, 0.1, 1e-4) << "discretisation: first order at the ends";
}

} // namespace
} // namespace grouser::contact::testing
