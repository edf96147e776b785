// SPDX-License-Identifier: BSD-3-Clause
// Friction with history: oblique impact, transition from sliding to rolling, inclines, the pyramid.
#include "grain_fixture.hpp"
#include "tests/device_under_test.hpp"

#include <gtest/gtest.h>

namespace grouser::terrain::testing {
namespace {

/// Psi_2 = v_ct' / (mu v_n) for an elastic oblique impact with undamped springs, kappa = k_t / k_n.
double obliqueImpact(double psi1, double kappa, int stepsPerContact, double mu = 0.3) {
  GrainModel m = ball(1);
  const double vn = 0.05; // slow: overlap / radius = 0.12 %
  m.law.friction = static_cast<float>(mu);
  m.law.tangentialStiffness = static_cast<float>(kappa * m.law.stiffness);
  const double omega0 = std::sqrt(m.law.stiffness / m.mass);
  m.timeStep = base::kPi / omega0 / stepsPerContact;
  m.maxOverlap = 1;
  Grains grains(testExec(1), m, {{floorPlane(m.law)}, {}},
                {{{0, 0, m.radius + 1.5 * m.timeStep * vn}, {psi1 * mu * vn, 0, -vn}, {}}});
  advance(grains, 2 * stepsPerContact);
  const auto s = grains.snapshot();
  EXPECT_NEAR(s.velocity[0].z, vn, 0.01 * vn);
  const double contactPoint = s.velocity[0].x - m.radius * s.spin[0].y; // v + w x (-R z)
  return contactPoint / (mu * vn);
}

/// Psi_2 over Psi_1 for kappa = 2/7, 0.5, 0.8, 1: elastic, undamped springs, with the tangential one limited to
/// friction x normal force / k_t (the spring slips with the contact; codes without this limit have other left halves).
/// Event-driven solution, checked by brute force.
struct Oblique {
  double psi1;
  double psi2[4];
};
constexpr double kKappa[] = {2.0 / 7, 0.5, 0.8, 1.0};
constexpr Oblique kOblique[] = {{0.25, {-0.25, -0.14258312, 0.10931610, 0.22340799}},
                                {0.5, {-0.5, -0.30351067, 0.17152395, 0.42491143}},
                                {1, {-1, -0.66657899, 0.13970062, 0.651666}},
                                {1.5, {-1.5, -1.06788212, -0.14976731, 0.28859407}},
                                {2, {-2, -1.494201, -0.64159851, -0.20359187}},
                                {3, {-3, -2.31138068, -1.41655461, -0.99953885}},
                                {3.5, {-3.5, -2.49984387, -1.65971474, -1.27259657}},
                                {4, {-3, -2.52481919, -1.79999317, -1.45651304}},
                                {5, {-2, -2, -1.72855754, -1.52096970}},
                                {6, {-1, -1, -1, -1}},
                                {7, {0, 0, 0, 0}},
                                {8, {1, 1, 1, 1}},
                                {10, {3, 3, 3, 3}}};

class ObliqueImpact : public ::testing::TestWithParam<int> {};

TEST_P(ObliqueImpact, MatchesEventDrivenSolutionAtEveryAngle) {
  const auto k = static_cast<std::size_t>(GetParam());
  // Discretisation, 400 steps per contact; and the lever arm is R - overlap (momentum balance), in the reference R.
  for (const Oblique& row : kOblique)
    EXPECT_NEAR(obliqueImpact(row.psi1, kKappa[k], 400), row.psi2[k], 0.01 * (1 + row.psi1)) << "Psi_1 = " << row.psi1;
}

TEST_P(ObliqueImpact, StickingThroughoutIsTheClosedForm) {
  const double kappa = kKappa[static_cast<std::size_t>(GetParam())];
  // Friction without limit: v_ct' / v_ct = cos(pi sqrt(7 kappa / 2)). One step in 400, and the lever arm, as above.
  const double friction = 1e4, psi1 = 0.3 / friction;
  EXPECT_NEAR(obliqueImpact(psi1, kappa, 400, friction) / psi1, base::cos(base::kPi * std::sqrt(3.5 * kappa)), 0.02);
}

INSTANTIATE_TEST_SUITE_P(A2, ObliqueImpact, ::testing::Range(0, 4));

TEST(SlidingBall, RollsAtFiveSeventhsOfItsSpeed) {
  const double mu = 0.3, v0 = 1;
  const GrainModel m = roughBall(2e-6, mu, 0.3);
  const double overlap = m.mass * 9.81 / m.law.stiffness;
  Grains grains(testExec(1), m, {{floorPlane(m.law)}, {}}, {{{0, 0, m.radius - overlap}, {v0, 0, 0}, {}}});
  const double tRoll = 2 * v0 / (7 * mu * 9.81); // 0.09708 s
  advance(grains, static_cast<std::int64_t>(0.5 * tRoll / m.timeStep));
  const double half = grains.snapshot().velocity[0].x;
  EXPECT_NEAR(half, v0 - mu * 9.81 * 0.5 * tRoll, 1e-4) << "constant deceleration mu g";
  advance(grains, static_cast<std::int64_t>(0.6 * tRoll / m.timeStep));
  const auto s = grains.snapshot();
  EXPECT_NEAR(s.velocity[0].x, 5 * v0 / 7, 1e-3 * 5 * v0 / 7);
  EXPECT_NEAR(s.spin[0].y * m.radius, 5 * v0 / 7, 1e-3);
}

TEST(BallOnIncline, RollsOrSlidesAsCoulombSays) {
  const double theta = base::kPi / 6, g = 9.81;
  for (const bool rolls : {true, false}) {
    const double mu = rolls ? 0.3 : 0.1; // critical: 0.16496
    GrainModel m = roughBall(2e-6, mu, 0.3);
    m.gravity = {g * base::sin(theta), 0, -g * base::cos(theta)};
    Grains grains(testExec(1), m, {{floorPlane(m.law)}, {}},
                  {{{0, 0, m.radius - m.mass * g * base::cos(theta) / m.law.stiffness}, {}, {}}});
    const int n = 50000;
    advance(grains, n);
    const auto s = grains.snapshot();
    const double a = s.velocity[0].x / (n * m.timeStep), alpha = s.spin[0].y * m.radius / (n * m.timeStep);
    EXPECT_NEAR(a, rolls ? 3.503571 : 4.055429, 4e-3) << "one spring period of tangential transient";
    EXPECT_NEAR(alpha, rolls ? 3.503571 : 2.123927, 4e-3);
  }
}

/// Three balls in a plane: two on the floor, one on top.
double pyramidSinks(double muBall, double muFloor) {
  GrainModel m = ball(5e-6);
  m.radius = 0.05;
  m.mass = sphereMass(2600, m.radius);
  m.law.stiffness = 1e6f;
  m.timeStep = 2e-5;
  m.gravity = {0, 0, -9.81};
  makeRough(m.law, 2 * 0.3 * std::sqrt(m.law.stiffness / (m.mass / 2)), muBall);
  contact::ContactLaw onFloor = m.law;
  onFloor.friction = muFloor;
  const double r = m.radius;
  Grains grains(testExec(1), m, {{floorPlane(onFloor)}, {}},
                {{{-r, 0, r}, {}, {}}, {{r, 0, r}, {}, {}}, {{0, 0, r + std::sqrt(3.0) * r}, {}, {}}});
  advance(grains, 25000); // 0.5 s
  return r + std::sqrt(3.0) * r - grains.snapshot().position[2].z;
}

TEST(Pyramid, StandsJustAboveTheCriticalFriction) {
  const double ballLimit = 0.267949, floorLimit = 0.089316; // tan(15 deg), a third of it
  EXPECT_LT(pyramidSinks(1.05 * ballLimit, 1.2 * floorLimit), 1e-4);
  EXPECT_LT(pyramidSinks(1.2 * ballLimit, 1.05 * floorLimit), 1e-4);
  EXPECT_GT(pyramidSinks(0.95 * ballLimit, 1.2 * floorLimit), 1e-2);
  EXPECT_GT(pyramidSinks(1.2 * ballLimit, 0.95 * floorLimit), 1e-2);
}

TEST(TwoBalls, RubbingKeepsTheAngularMomentum) {
  // Both forces must act at one point: with lever arms of one radius each, overlap x friction would be lost every step.
  GrainModel m = ball(2e-6);
  m.law.friction = 0.5f;
  m.law.tangentialStiffness = m.law.stiffness * 2 / 7;
  m.maxOverlap = 1;
  const base::Vec3d spin{0, 0, 400};
  Grains grains(base::cpuExec(1), m, {},
                {{{-1.001 * m.radius, 0, 0}, {1, 0, 0}, spin}, {{1.001 * m.radius, 0, 0}, {-1, 0, 0}, spin}});
  const double inertia = 0.4 * m.mass * m.radius * m.radius;
  const auto angular = [&] {
    const GrainSnapshot s = grains.snapshot();
    double l = 0;
    for (std::size_t i = 0; i < 2; ++i)
      l += m.mass * cross(s.position[i], s.velocity[i].as<double>()).z + inertia * static_cast<double>(s.spin[i].z);
    return l;
  };
  const double before = angular();
  advance(grains, 300);
  EXPECT_GT(std::fabs(grains.snapshot().velocity[0].y), 0.1) << "they have slid";
  EXPECT_NEAR(angular() / before, 1, 1e-5) << "float forces; arms of a radius would lose 2 %";
}

} // namespace
} // namespace grouser::terrain::testing
