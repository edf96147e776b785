// SPDX-License-Identifier: BSD-3-Clause
// Steps with complementarity contacts against closed forms for a few grains.
#include "grain_fixture.hpp"
#include "tests/device_under_test.hpp"

#include <gtest/gtest.h>

namespace grouser::terrain::testing {
namespace {

using contact::Compliance;
using contact::ImpulseFriction;

constexpr double kG = 9.81;

/// The reference ball in steps of `timeStep`, with a solver tolerance far below the tolerances of the tests.
GrainModel impulsive(double timeStep, double friction, Compliance compliance = Compliance::rigid) {
  GrainModel m = roughBall(timeStep, friction, 0);
  m.precision = Precision::double_;
  contact::ComplementarityOptions o;
  o.compliance = compliance, o.residual = 1e-12, o.iterations = 20000, o.recovery = 0.1;
  o.impact = 5 * kG * timeStep;
  m.complementarity = o;
  m.law.restitution = 0;
  m.skin = 1;
  return m;
}

base::Vec3d velocityOf(const Grains& grains, std::size_t k = 0) { return grains.snapshot().velocity[k].as<double>(); }

const ImpulseReport& report(const Grains& grains) { return grains.system().impulses->report(); }

/// Gravity on a plane inclined by `angle`: along x, downhill.
base::Vec3d tilted(double angle) { return {kG * base::sin(angle), 0, -kG * base::cos(angle)}; }

TEST(Complementarity, ABallRollsDownAnInclineUntilItSlips) {
  const double mu = 0.2, h = 1e-3;
  for (const double tangent : {0.3, 0.69, 0.71, 1.5}) {
    const double angle = std::atan(tangent);
    GrainModel m = impulsive(h, mu);
    m.gravity = tilted(angle);
    Grains grains(testExec(1), m, {{floorPlane(m.law)}, {}}, {{{0, 0, m.radius}, {}, {}}});
    advance(grains, 100);
    const bool slips = tangent > 3.5 * mu;
    const double rolls = 5.0 / 7 * kG * base::sin(angle), slides = kG * (base::sin(angle) - mu * base::cos(angle));
    EXPECT_NEAR(velocityOf(grains).x, 0.1 * (slips ? slides : rolls), 1e-6) << tangent;
    EXPECT_NEAR(velocityOf(grains).z, 0, 1e-7) << "no dilation";
    EXPECT_EQ(report(grains).met, true);
  }
}

TEST(Complementarity, ASlidingBallRollsAtFiveSeventhsOfItsSpeed) {
  const double mu = 0.5, v = 1, h = 1e-3;
  GrainModel m = impulsive(h, mu);
  Grains grains(testExec(1), m, {{floorPlane(m.law)}, {}}, {{{0, 0, m.radius}, {v, 0, 0}, {}}});
  const double slides = 2 * v / (7 * mu * kG);
  advance(grains, 40);
  EXPECT_NEAR(velocityOf(grains).x, v - mu * kG * 0.04, 1e-6);
  advance(grains, 60);
  EXPECT_LT(slides, 0.1);
  EXPECT_NEAR(velocityOf(grains).x, 5.0 / 7 * v, 1e-6);
  EXPECT_NEAR(grains.snapshot().position[0].z, m.radius, 1e-9);
  // Until slip ends the distance is v^2 12 / (49 mu g), with end-of-step velocities; then it rolls.
  const double way = 12 * v * v / (49 * mu * kG) + 5.0 / 7 * v * (0.1 - slides);
  EXPECT_NEAR(grains.snapshot().position[0].x, way, 0.5 * h * (v - 5.0 / 7 * v) + 1e-6);
}

TEST(Complementarity, TheConvexRelaxationLiftsWhatSlides) {
  const double mu = 0.5, v = 1;
  for (const double h : {1e-3, 2e-4}) {
    GrainModel m = impulsive(h, mu);
    m.complementarity->friction = ImpulseFriction::associated;
    Grains grains(testExec(1), m, {{floorPlane(m.law)}, {}}, {{{0, 0, m.radius}, {v, 0, 0}, {}}});
    advance(grains, 1);
    // It parts with mu times its slip: u_n = mu u_t, u_t = v - 3.5 mu p, u_n = p - g h for the impulse p over the mass.
    const double p = (mu * v + kG * h) / (1 + 3.5 * mu * mu);
    EXPECT_NEAR(velocityOf(grains).z, mu * (v - 3.5 * mu * p), 1e-6) << "at any step";
  }
}

TEST(Complementarity, TwoBallsPartWithTheirRestitutionAtAnyPhase) {
  for (const double e : {0.0, 0.35, 1.0})
    for (const double gap : {1e-9, 2e-4, 3.7e-4, 9e-4}) {
      GrainModel m = impulsive(1e-3, 0.3);
      m.gravity = {}, m.law.restitution = e;
      Grains grains(testExec(1), m, {}, {{{0, 0, 0}, {0.5, 0, 0}, {}}, {{2 * m.radius + gap, 0, 0}, {-0.3, 0, 0}, {}}});
      advance(grains, 3);
      EXPECT_NEAR(velocityOf(grains, 0).x, 0.1 - e * 0.4, 1e-7) << e << " " << gap;
      EXPECT_NEAR(velocityOf(grains, 1).x, 0.1 + e * 0.4, 1e-7);
    }
}

TEST(Complementarity, AnObliqueImpactSticksOrSlipsAsCoulombSays) {
  const double e = 0.5, mu = 0.2, down = 0.4;
  for (const double along : {0.1, 0.35, 0.6, 0.9}) {
    GrainModel m = impulsive(1e-3, mu);
    m.gravity = {}, m.law.restitution = e;
    Grains grains(testExec(1), m, {{floorPlane(m.law)}, {}}, {{{0, 0, m.radius + 1e-4}, {along, 0, -down}, {}}});
    advance(grains, 1);
    const bool sticks = along <= 3.5 * mu * (1 + e) * down;
    EXPECT_NEAR(velocityOf(grains).z, e * down, 1e-6);
    EXPECT_NEAR(velocityOf(grains).x, sticks ? 5.0 / 7 * along : along - mu * (1 + e) * down, 1e-6) << along;
  }
}

TEST(Complementarity, ACradleSendsAllButTheFirstAway) {
  GrainModel m = impulsive(1e-3, 0);
  m.gravity = {}, m.law.restitution = 1;
  std::vector<GrainSpec> row;
  for (int k = 0; k < 5; ++k) row.push_back({{2 * m.radius * k, 0, 0}, {k == 0 ? 1.0 : 0.0, 0, 0}, {}});
  Grains grains(testExec(1), m, {}, row);
  advance(grains, 1);
  EXPECT_NEAR(velocityOf(grains, 0).x, -0.6, 1e-6);
  for (std::size_t k = 1; k < 5; ++k) EXPECT_NEAR(velocityOf(grains, k).x, 0.4, 1e-6);
}

TEST(Complementarity, AColumnBearsItsWeight) {
  const int n = 8;
  GrainModel m = impulsive(1e-3, 0.5, Compliance::law);
  m.law.stiffness = 500, m.law.damping = 1000; // overlaps of a million length units
  std::vector<GrainSpec> column;
  for (int k = 0; k < n; ++k) column.push_back({{0, 0, (2 * k + 1) * m.radius}, {}, {}});
  Grains grains(testExec(1), m, {{floorPlane(m.law)}, {}}, column);
  advance(grains, 3000);
  const auto s = grains.snapshot();
  const double weight = m.mass * kG;
  EXPECT_NEAR((m.radius - s.position[0].z) * m.law.stiffness, n * weight, 1e-6 * n * weight);
  for (int k = 1; k < n; ++k) {
    const auto i = static_cast<std::size_t>(k);
    const double overlap = 2 * m.radius - norm(s.position[i] - s.position[i - 1]);
    EXPECT_NEAR(overlap * m.law.stiffness, (n - k) * weight, 1e-6 * n * weight) << k;
  }
}

TEST(Complementarity, AWedgeWithoutFrictionIsHeldByBothWalls) {
  // Walls at 30 degrees from the vertical carry m g each.
  GrainModel m = impulsive(1e-3, 0, Compliance::law);
  m.law.stiffness = 500, m.law.damping = 1000;
  const double c = std::sqrt(0.75);
  const std::vector<Wall> walls{{{c, 0, 0.5}, 0, m.law}, {{-c, 0, 0.5}, 0, m.law}};
  Grains grains(testExec(1), m, {walls, {}}, {{{0, 0, 2 * m.radius}, {}, {}}});
  advance(grains, 1000);
  const double sunk = m.radius - 0.5 * grains.snapshot().position[0].z;
  EXPECT_NEAR(sunk * m.law.stiffness, m.mass * kG, 1e-6 * m.mass * kG);
}

TEST(Complementarity, RollingResistanceHoldsAndStops) {
  const double rho = 0.1, h = 1e-3; // relative to the radius
  for (const double tangent : {0.08, 0.12}) {
    GrainModel m = impulsive(h, 0.8);
    m.law.rollingFriction = rho;
    const double angle = std::atan(tangent);
    m.gravity = tilted(angle);
    Grains grains(testExec(1), m, {{floorPlane(m.law)}, {}}, {{{0, 0, m.radius}, {}, {}}});
    advance(grains, 100);
    const double rolls = 5.0 / 7 * kG * (base::sin(angle) - rho * base::cos(angle));
    EXPECT_NEAR(velocityOf(grains).x, tangent > rho ? 0.1 * rolls : 0, 1e-6) << tangent;
  }
}

TEST(Complementarity, ABallThatIsHeldDoesNotCreep) {
  GrainModel m = impulsive(1e-3, 0.8, Compliance::law);
  m.law.rollingFriction = 0.2, m.law.rollingDamping = 0.3, m.law.damping = 1000, m.law.tangentialDamping = 500;
  m.gravity = tilted(std::atan(0.1));
  const double sunk = m.mass * kG / m.law.stiffness;
  Grains grains(testExec(1), m, {{floorPlane(m.law)}, {}}, {{{0, 0, m.radius - sunk}, {}, {}}});
  advance(grains, 1000);
  const double rests = grains.snapshot().position[0].x;
  EXPECT_GT(rests, 1e-8) << "its springs yield";
  advance(grains, 1000);
  EXPECT_NEAR(grains.snapshot().position[0].x, rests, 1e-9);
}

TEST(Complementarity, CohesionHoldsUpToItsForce) {
  for (const double share : {0.99, 1.01}) {
    GrainModel m = impulsive(1e-3, 0.5, Compliance::law);
    m.law.pullPerRadius = share * m.mass * kG / m.radius; // share of its weight, on a wall
    m.law.stiffness = 500, m.law.damping = 1000;
    const Wall ceiling{{0, 0, -1}, -0.1, m.law};
    const double presses = 0.01 * m.mass * kG / m.law.stiffness; // larger pull exceeds its weight
    Grains grains(testExec(1), m, {{ceiling}, {}}, {{{0, 0, 0.1 - m.radius + presses}, {}, {}}});
    advance(grains, 80);
    if (share < 1)
      EXPECT_LT(grains.snapshot().position[0].z, 0.1 - 1.02 * m.radius);
    else
      EXPECT_NEAR(grains.snapshot().position[0].z, 0.1 - m.radius, 1e-6);
  }
}

} // namespace
} // namespace grouser::terrain::testing
