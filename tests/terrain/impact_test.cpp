// SPDX-License-Identifier: BSD-3-Clause
// One ball on a wall and two balls head on, against the closed forms of the linear spring-dashpot.
#include "grain_fixture.hpp"
#include "tests/device_under_test.hpp"

#include <gtest/gtest.h>

namespace grouser::terrain::testing {
namespace {

struct Impact {
  double restitution, deepest, duration;
};

/// Ball at 1 m/s onto a plane; `phase`: fraction of a step between start and first touch.
Impact impactOnWall(double zeta, bool attraction, double stepsPerContact, double phase) {
  GrainModel m = ball(1);
  const double omega0 = std::sqrt(m.law.stiffness / m.mass);
  m.law.damping = static_cast<float>(2 * zeta * omega0);
  m.law.attraction = attraction;
  m.timeStep = base::kPi / omega0 / stepsPerContact;
  m.maxOverlap = 1;
  const double speed = 1;
  Grains grains(testExec(1), m, {{floorPlane(m.law)}, {}},
                {{{0, 0, m.radius + (2 + phase) * m.timeStep * speed}, {0, 0, -speed}, {}}});
  Impact impact{0, 0, 0};
  for (int i = 0; i < 4 * stepsPerContact + 4; ++i) {
    advance(grains, 1);
    const auto s = grains.snapshot();
    const double overlap = m.radius - s.position[0].z;
    if (overlap > 0) impact.duration += m.timeStep;
    if (overlap > impact.deepest) impact.deepest = overlap;
    impact.restitution = s.velocity[0].z / speed;
  }
  return impact;
}

struct Case {
  double zeta;
  bool attraction;
  double restitution, deepest;
};

class LinearImpact : public ::testing::TestWithParam<Case> {};

TEST_P(LinearImpact, MatchesClosedFormWithFirstOrder) {
  const Case c = GetParam();
  // Worst error over the phase of first touch, at two resolutions. Entry and exit fall between steps: order 1.
  double worst[2] = {0, 0}, deepest = 0;
  const double steps[2] = {200, 800};
  for (int r = 0; r < 2; ++r)
    for (double phase = 0.1; phase < 1; phase += 0.2) {
      const Impact i = impactOnWall(c.zeta, c.attraction, steps[r], phase);
      worst[r] = std::max(worst[r], std::fabs(i.restitution - c.restitution));
      deepest = i.deepest;
    }
  EXPECT_NEAR(deepest, c.deepest, c.deepest * 0.008 * (1 + c.zeta)) << "discretisation: O((1 + zeta) / 800 steps)";
  EXPECT_LT(worst[1], 2e-3);
  if (worst[0] > 1e-4) { // below, float round-off hides the order
    const double order = std::log(worst[0] / worst[1]) / std::log(steps[1] / steps[0]);
    EXPECT_GT(order, 0.7) << worst[0] << " -> " << worst[1];
  }
}

INSTANTIATE_TEST_SUITE_P(
    A1, LinearImpact,
    ::testing::Values(Case{0, false, 1, 1.16677196e-4}, Case{0.05, true, 0.85446789, 1.08123827e-4},
                      Case{0.2, true, 0.52662060, 8.82237034e-5}, Case{0.5, true, 0.16303353, 6.37399375e-5},
                      Case{0.1, false, 0.74407940, 1.00645793e-4}, Case{0.2, false, 0.57174003, 8.82237034e-5},
                      Case{0.5, false, 0.29843606, 6.37399375e-5}, Case{1.0, false, 0.13533528, 4.29231418e-5},
                      Case{2.0, false, 0.04776873, 2.55010372e-5}));

TEST(LinearImpactCoarse, RestitutionAtTwentyStepsIsWithinTwoHundredths) {
  // Entry and exit have an uncertainty of one step, 1/20 of the contact; the error of the loss grows with the damping:
  // bounds from the discrete recurrence, 0.0127, 0.0193 and 0.0322, rounded up.
  const struct {
    double zeta, restitution, bound;
  } cases[] = {{0.1, 0.74407940, 0.02}, {0.2, 0.57174003, 0.02}, {0.5, 0.29843606, 0.035}};
  for (const auto& c : cases)
    for (double phase = 0; phase < 1; phase += 0.05)
      EXPECT_NEAR(impactOnWall(c.zeta, false, 20, phase).restitution, c.restitution, c.bound) << "phase " << phase;
}

TEST(LinearImpactCoarse, WorstErrorFallsWithTheFirstPowerOfTheStep) {
  // Undamped exit, zeta = 0.2, n whole steps per contact: an independent integration's worst |e - 0.52662060| over the
  // phase of first touch, two digits given.
  const struct {
    double steps, worst;
  } known[] = {{5, 0.113},   {10, 0.044},  {15, 0.027},   {20, 0.020},
               {30, 0.0126}, {50, 0.0074}, {100, 0.0036}, {200, 0.0018}};
  double first = 0, last = 0;
  for (const auto& row : known) {
    double worst = 0;
    for (double phase = 0.01; phase < 1; phase += 0.02)
      worst = std::max(worst,
                       std::fabs(impactOnWall(0.2, true, row.steps * std::sqrt(0.96), phase).restitution - 0.52662060));
    EXPECT_NEAR(worst / row.worst, 1, 0.03) << row.steps << " steps";
    (row.steps == 20 ? first : last) = worst;
  }
  EXPECT_NEAR(std::log(first / last) / std::log(10.0), 1, 0.06) << "order, from 20 to 200 steps";
}

TEST(TwoBalls, RestitutionDoesNotDependOnSpeed) {
  for (const double speed : {1e-3, 0.1, 10.0}) {
    GrainModel m = ball(2e-6);
    const double omega0 = std::sqrt(m.law.stiffness / (m.mass / 2));
    m.law.damping = static_cast<float>(2 * contact::dampingRatioFor(0.5, false) * omega0);
    m.maxOverlap = 1;
    const double gap = 20 * m.timeStep * speed;
    Grains grains(testExec(1), m, {},
                  {{{-m.radius - gap, 0, 0}, {speed, 0, 0}, {}}, {{m.radius + gap, 0, 0}, {-speed, 0, 0}, {}}});
    advance(grains, 400);
    const auto s = grains.snapshot();
    EXPECT_NEAR((s.velocity[1].x - s.velocity[0].x) / (2 * speed), 0.5, 5e-3)
        << "discretisation at 130 steps per contact";
    EXPECT_EQ(s.velocity[0].x, -s.velocity[1].x) << "momentum is bitwise exact";
  }
}

TEST(RestSphereOnPlane, SettlesAtStaticOverlap) {
  GrainModel m = ball(1e-5);
  m.gravity = {0, 0, -9.81};
  m.law.damping = static_cast<float>(2 * 0.5 * std::sqrt(m.law.stiffness / m.mass));
  Grains grains(testExec(1), m, {{floorPlane(m.law)}, {}}, {{{0, 0, m.radius}, {}, {}}});
  advance(grains, 2000);
  const double overlap = m.radius - grains.snapshot().position[0].z;
  const double expected = m.mass * 9.81 / m.law.stiffness; // 0.134 um
  EXPECT_NEAR(overlap, expected, 2 * grains.scale().unit) << "positions are whole units";
}

TEST(Column, OverlapOfContactJIsJTimesWeight) {
  GrainModel m = ball(1e-5);
  m.gravity = {0, 0, -9.81};
  m.law.damping = static_cast<float>(2 * 0.3 * std::sqrt(m.law.stiffness / m.mass));
  std::vector<GrainSpec> start;
  const int n = 5;
  for (int i = 0; i < n; ++i) start.push_back({{0, 0, m.radius * (2 * i + 1)}, {}, {}});
  Grains grains(testExec(1), m, {{floorPlane(m.law)}, {}}, start);
  advance(grains, 20000);
  const auto s = grains.snapshot();
  for (int j = 1; j < n; ++j) { // contact j from the top, between grains n-1-j and n-j
    const double overlap = 2 * m.radius - (s.position[n - j].z - s.position[n - 1 - j].z);
    EXPECT_NEAR(overlap, j * m.mass * 9.81 / m.law.stiffness, 4 * grains.scale().unit);
  }
}

TEST(FreeFall, HoldsGravityAtTinySteps) {
  GrainModel m = ball(1e-6);
  m.gravity = {0, 0, -9.81};
  Grains grains(testExec(1), m, {}, {{{0, 0, 0}, {}, {}}});
  const int n = 200000;
  advance(grains, n);
  const auto s = grains.snapshot();
  const double t = n * m.timeStep;
  EXPECT_NEAR(s.velocity[0].z / (-9.81 * t), 1, 1e-6);
  // The discrete sum of symplectic Euler: g dt^2 n (n + 1) / 2.
  const double fallen = -9.81 * m.timeStep * m.timeStep * 0.5 * n * (n + 1.0);
  EXPECT_NEAR(s.position[0].z / fallen, 1, 1e-6);
}

TEST(Pinch, BallBetweenTwoWedgeWallsCarriesItsWeightOnBoth) {
  // V of two planes at 45 degrees: each carries W / sqrt(2), overlap W / (k sqrt 2).
  GrainModel m = ball(1e-5);
  m.gravity = {0, 0, -9.81};
  m.law.damping = static_cast<float>(2 * 0.5 * std::sqrt(m.law.stiffness / m.mass));
  const double h = std::sqrt(0.5);
  Grains grains(testExec(1), m, {{{{h, 0, h}, 0.0, m.law}, {{-h, 0, h}, 0.0, m.law}}, {}},
                {{{0, 0, m.radius / h}, {}, {}}});
  advance(grains, 4000);
  const auto s = grains.snapshot();
  const double overlap = m.radius - h * s.position[0].z;
  EXPECT_NEAR(overlap, m.mass * 9.81 * h / m.law.stiffness, 2 * grains.scale().unit);
  EXPECT_NEAR(s.position[0].x, 0, grains.scale().unit);
}

} // namespace
} // namespace grouser::terrain::testing
