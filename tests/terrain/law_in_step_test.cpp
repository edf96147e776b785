// SPDX-License-Identifier: BSD-3-Clause
// The laws in the grains' step: impacts, rolling, chains, gases, stability limits.
#include "base/error.hpp"
#include "base/random.hpp"
#include "grain_fixture.hpp"
#include "tests/device_under_test.hpp"

#include <gtest/gtest.h>

namespace grouser::terrain::testing {
namespace {

using base::Vec3d;

TEST(HertzInStep, TwoGlassSpheresMatchTheClosedForm) {
  // Chung and Ooi test 1 at a tenth of the speed: float forces, integer positions.
  GrainModel m;
  m.radius = 0.01, m.mass = 2800 * 4.0 / 3 * base::kPi * 1e-6, m.skin = 0.5;
  const double effective = 4.8e10 / (2 * (1 - 0.04));
  m.law.hertz = true, m.law.stiffness = 4.0 / 3 * effective;
  for (const Precision precision : {Precision::single, Precision::double_})
    for (const double e : {1.0, 0.6}) {
      const auto closed = contact::hertzImpact(effective, m.radius / 2, m.mass / 2, 2);
      m.precision = precision;
      m.law.rootDamping = 2 * contact::hertzDampingRatioFor(e, false) * std::sqrt(2 * effective);
      m.timeStep = closed.duration / 400;
      const double gap = 3.5 * m.timeStep;
      Grains grains(testExec(1), m, {},
                    {{{-m.radius - gap, 0, 0}, {1, 0, 0}, {}}, {{m.radius + gap, 0, 0}, {-1, 0, 0}, {}}});
      double deepest = 0;
      for (int i = 0; i < 600; ++i) {
        advance(grains, 1);
        const auto s = grains.snapshot();
        deepest = std::max(deepest, 2 * m.radius - (s.position[1].x - s.position[0].x));
      }
      const auto s = grains.snapshot();
      EXPECT_NEAR((s.velocity[1].x - s.velocity[0].x) / 2, e, 4e-3) << "O(1 / 400 steps)";
      if (e == 1) {
        EXPECT_NEAR(deepest, closed.deepest, 1e-3 * closed.deepest);
      }
    }
}

TEST(HertzInStep, BallOnPlaneRestsAtItsStaticOverlap) {
  GrainModel m = ball(1e-5);
  m.law.hertz = true, m.law.stiffness = 4.0 / 3 * 1e8, m.law.damping = 0;
  m.law.rootDamping = 2 * 0.4 * std::sqrt(2e8);
  m.gravity = {0, 0, -9.81};
  Grains grains(testExec(1), m, {{floorPlane(m.law)}, {}}, {{{0, 0, m.radius}, {}, {}}});
  advance(grains, 6000);
  const double expected = base::pow(m.mass * 9.81 / (m.law.stiffness * std::sqrt(m.radius)), 2.0 / 3);
  EXPECT_NEAR(m.radius - grains.snapshot().position[0].z, expected, 4 * grains.scale().unit + 1e-5 * expected);
}

TEST(RollingInStep, BallOnPlaneStopsAndStays) {
  GrainModel m = ball(5e-6);
  m.radius = 0.05, m.mass = 2600 * 4.0 / 3 * base::kPi * 0.05 * 0.05 * 0.05;
  m.gravity = {0, 0, -9.81};
  m.law.stiffness = 2e6, m.law.tangentialStiffness = 2e6 * 2 / 7;
  m.law.damping = 2 * 0.3 * std::sqrt(2e6 / m.mass), m.law.tangentialDamping = m.law.damping / 2;
  m.law.friction = 0.5, m.law.rollingFriction = 0.2, m.law.rollingDamping = 0.3;
  m.timeStep = 4e-5;
  const double v0 = 0.5, x = 7 * v0 * v0 / (10 * 0.2 * 9.81);
  Grains grains(testExec(1), m, {{floorPlane(m.law)}, {}},
                {{{0, 0, m.radius - m.mass * 9.81 / m.law.stiffness}, {v0, 0, 0}, {0, v0 / m.radius, 0}}});
  advance(grains, 20000); // 0.8 s; it stops at 0.36 s
  const auto s = grains.snapshot();
  EXPECT_NEAR(s.position[0].x, x, 0.01 * x) << "winding of the rolling spring, and arm R - overlap";
  EXPECT_LT(norm(s.spin[0]), 1e-3f);
}

/// A row of spheres pressed between two planes: contact j has the overlap `pressed` at rest.
struct Chain {
  GrainModel model = ball(1e-5);
  std::vector<GrainSpec> start;
  Boundaries boundaries;
  int n;
  double pitch, pressed = 1e-4;

  explicit Chain(int count) : n(count), pitch(2 * model.radius - 1e-4) {
    model.precision = Precision::double_;
    boundaries.walls = {{{1, 0, 0}, -(model.radius - pressed), model.law},
                        {{-1, 0, 0}, -((n - 1) * pitch + model.radius - pressed), model.law}};
    for (int i = 0; i < n; ++i) start.push_back({{i * pitch, 0, 0}, {}, {}});
  }
};

TEST(Chain, NormalModeSwingsAtTheFrequencyOfTheDiscreteScheme) {
  // A7. Fixed ends at half a spacing: modes sin(q (i + 1)) with q = pi k / (n + 1) belong to n masses and n + 1
  // springs.
  Chain c(7);
  const double k = c.model.law.stiffness, mass = c.model.mass;
  for (const int mode : {1, 3, 7}) {
    const double q = base::kPi * mode / (c.n + 1), omega = 2 * std::sqrt(k / mass) * base::sin(q / 2);
    const double dt = 0.2 / omega;
    Chain chain = c;
    chain.model.timeStep = dt;
    const double speed = 2e-5 * omega; // 20 um: 1/5 of the amplitude that opens a contact
    for (int i = 0; i < c.n; ++i) chain.start[static_cast<std::size_t>(i)].velocity.x = speed * base::sin(q * (i + 1));
    Grains grains(testExec(1), chain.model, chain.boundaries, chain.start);
    // From the rest position the scheme's velocity after m steps is v_0 cos(omegaNum (m - 1/2) dt) / cos(omegaNum
    // dt / 2), exactly, with omegaNum = 2 / dt asin(omega dt / 2).
    const double phase = 2 * base::asin(omega * dt / 2);
    double worst = 0;
    for (int step = 1; step <= 400; ++step) {
      advance(grains, 1);
      const auto s = grains.snapshot();
      double amplitude = 0, shape = 0;
      for (int i = 0; i < c.n; ++i) {
        const double w = base::sin(q * (i + 1));
        amplitude += w * static_cast<double>(s.velocity[static_cast<std::size_t>(i)].x), shape += w * w;
      }
      const double expected = base::cos(phase * (step - 0.5)) / base::cos(phase / 2);
      worst = std::max(worst, std::fabs(amplitude / shape / speed - expected));
    }
    // Overlaps are whole units of 1e-8 of a diameter: 7e-11 m of an amplitude of 2e-5 m, a random walk of 400 steps.
    EXPECT_LT(worst, 2e-4) << "mode " << mode;
  }
}

TEST(Chain, StepIsStableJustBelowItsLimitAndNotAbove) {
  // A9: omega_max of the chain with fixed ends, 2 sqrt(k/m) cos(pi / (2 (n + 1))); limit 2 / omega_max.
  for (const double share : {0.97, 1.03}) {
    Chain chain(7);
    const double omega = 2 * std::sqrt(chain.model.law.stiffness / chain.model.mass) * base::cos(base::kPi / 16);
    chain.model.timeStep = share * 2 / omega;
    chain.model.maxOverlap = 1, chain.model.skin = 1.5;
    for (int i = 0; i < chain.n; ++i) chain.start[static_cast<std::size_t>(i)].velocity.x = 1e-4 * (i % 2 ? 1 : -1);
    Grains grains(testExec(1), chain.model, chain.boundaries, chain.start);
    double fastest = 0;
    for (int i = 0; i < 60; ++i) {
      advance(grains, 1);
      for (const auto& v : grains.snapshot().velocity) fastest = std::max(fastest, std::fabs(static_cast<double>(v.x)));
    }
    if (share < 1)
      EXPECT_LT(fastest, 2e-3);
    else
      EXPECT_GT(fastest, 1e-2) << "growth by 1.6 per step";
  }
}

/// Growth over many steps of one damped, permanent contact: a ball pressed between two planes.
double pinchedGrowth(double zeta, double share) {
  GrainModel m = ball(1);
  // Two springs: omega_0^2 = 2 k / m, and damping 2 gamma.
  const double omega0 = std::sqrt(2 * m.law.stiffness / m.mass);
  m.law.damping = zeta * omega0;
  m.timeStep = share * contact::stableStep(omega0, zeta);
  m.maxOverlap = 1, m.skin = 1.9, m.precision = Precision::double_;
  const double pressed = 2e-4, v0 = 1e-5 * omega0 * 1e-2;
  Grains grains(testExec(1), m,
                {{{{0, 0, 1}, -(m.radius - pressed), m.law}, {{0, 0, -1}, -(m.radius - pressed), m.law}}, {}},
                {{{0, 0, 0}, {0, 0, v0}, {}}});
  double fastest = 0;
  for (int i = 0; i < 100; ++i) {
    advance(grains, 1);
    fastest = std::max(fastest, std::fabs(static_cast<double>(grains.snapshot().velocity[0].z)));
  }
  return fastest / v0;
}

TEST(StableStep, OfADampedContactIsWherePredicted) {
  // A9: omega_0 dt < 2 (sqrt(1 + zeta^2) - zeta): 1.8100, 1.6396, 1.2361, 0.8284 at 0.1, 0.2, 0.5, 1.
  EXPECT_NEAR(contact::stableStep(1, 0.1), 1.8100, 1e-4);
  EXPECT_NEAR(contact::stableStep(1, 1), 0.8284, 1e-4);
  for (const double zeta : {0.1, 0.2, 0.5, 1.0}) {
    EXPECT_LT(pinchedGrowth(zeta, 0.97), 5) << zeta;
    EXPECT_GT(pinchedGrowth(zeta, 1.03), 20) << zeta;
  }
}

TEST(ElasticGas, EnergyStaysBoundedAndMomentumIsKept) {
  // A8: 64 elastic smooth balls in a box.
  double spread[2];
  for (int fine = 0; fine < 2; ++fine) {
    GrainModel m = ball(fine ? 5e-6 : 1e-5);
    const double edge = 0.06;
    Boundaries box{{{{1, 0, 0}, 0, m.law},
                    {{-1, 0, 0}, -edge, m.law},
                    {{0, 1, 0}, 0, m.law},
                    {{0, -1, 0}, -edge, m.law},
                    {{0, 0, 1}, 0, m.law},
                    {{0, 0, -1}, -edge, m.law}},
                   {}};
    std::vector<GrainSpec> start;
    for (int i = 0; i < 64; ++i) {
      const auto u = [&](std::uint64_t k) { return 2 * base::uniform(3, 4, static_cast<std::uint64_t>(i), k) - 1; };
      start.push_back({Vec3d{i % 4 + 0.5, i / 4 % 4 + 0.5, i / 16 + 0.5} * 0.015, {u(0), u(1), u(2)}, {}});
    }
    Grains grains(testExec(1), m, box, start);
    GrainLedger first = grains.ledger();
    double least = 1e300, most = 0;
    const int steps = fine ? 20000 : 10000; // 0.1 s
    for (int i = 0; i < steps; i += 50) {
      advance(grains, 50);
      const GrainLedger l = grains.ledger();
      const double energy = (l.kinetic + l.elastic) / first.kinetic;
      least = std::min(least, energy), most = std::max(most, energy);
    }
    spread[fine] = most - least;
    EXPECT_NEAR(least, 1, 0.02);
    EXPECT_NEAR(most, 1, 0.02);
  }
  EXPECT_LT(spread[1], 0.8 * spread[0]) << "decreases with the step";
}

} // namespace
} // namespace grouser::terrain::testing
