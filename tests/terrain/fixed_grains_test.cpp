// SPDX-License-Identifier: BSD-3-Clause
// Fixed grains: rebounds from them, energy accounting, and identical results.
#include "base/error.hpp"
#include "base/random.hpp"
#include "surface_fixture.hpp"
#include "terrain/grain_forces.hpp"
#include "terrain/kernel_choice.hpp"
#include "tests/device_under_test.hpp"
#include "tests/terrain/state_words.hpp"

#include <gtest/gtest.h>

namespace grouser::terrain::testing {
namespace {

GrainSpec fixedAt(const Vec3d& position, double radius = 0) { return {position, {}, {}, radius, 0, true}; }

struct Bounce {
  double restitution, deepest;
};

/// A grain that falls at 1 m/s along z onto a fixed one with a radius of `ground`.
Bounce bounceOn(const GrainModel& m, double radius, double ground, std::int64_t steps) {
  const double reach = radius + ground;
  Grains grains(testExec(1), m, {},
                {fixedAt({0, 0, -ground}, ground), {{0, 0, radius + 2.5 * m.timeStep}, {0, 0, -1}, {}, radius}});
  Bounce bounce{};
  for (std::int64_t i = 0; i < steps; ++i) {
    advance(grains, 1);
    const auto s = grains.snapshot();
    bounce.deepest = std::max(bounce.deepest, reach - (s.position[1].z - s.position[0].z));
    bounce.restitution = s.velocity[1].z;
  }
  return bounce;
}

TEST(FixedGrain, GivesTheRestitutionOfTheFullMassWithTheLinearLaw) {
  // As on a wall: closed forms of the undamped linear dashpot, with m instead of m / 2.
  const struct {
    double zeta, restitution, deepest;
  } cases[] = {{0, 1, 1.16677196e-4}, {0.05, 0.85446789, 1.08123827e-4}, {0.2, 0.52662060, 8.82237034e-5}};
  for (const auto& c : cases) {
    GrainModel m = ball(1);
    const double omega0 = std::sqrt(m.law.stiffness / m.mass);
    m.law.damping = 2 * c.zeta * omega0, m.law.attraction = true;
    m.timeStep = base::kPi / omega0 / 800, m.maxOverlap = 1;
    const Bounce bounce = bounceOn(m, m.radius, m.radius, 2000);
    EXPECT_NEAR(bounce.restitution, c.restitution, 2e-3) << "entry and exit fall between steps: O(1 / 800 steps)";
    EXPECT_NEAR(bounce.deepest, c.deepest, 0.008 * (1 + c.zeta) * c.deepest) << "the same";
  }
}

TEST(FixedGrain, GivesTheRestitutionOfTheFullMassWithHertz) {
  for (const double ground : {0.01, 0.02}) { // radius of the fixed grain: the law uses the pair's radius
    GrainModel m;
    m.radius = 0.02, m.mass = 2800 * 4.0 / 3 * base::kPi * 8e-6, m.skin = 0.5;
    const double effective = 4.8e7 / (2 * (1 - 0.04)), radius = 0.01, mass = m.mass / 8;
    m.law.hertz = true, m.law.stiffness = 4.0 / 3 * effective;
    for (const double e : {1.0, 0.6}) {
      const auto closed = contact::hertzImpact(effective, radius * ground / (radius + ground), mass, 1);
      m.law.rootDamping = 2 * contact::hertzDampingRatioFor(e, false) * std::sqrt(2 * effective);
      m.timeStep = closed.duration / 400, m.maxOverlap = 1, m.smallestRadius = radius;
      const Bounce bounce = bounceOn(m, radius, ground, 900);
      EXPECT_NEAR(bounce.restitution, e, 4e-3) << "O(1 / 400 steps)";
      if (e == 1) {
        EXPECT_NEAR(bounce.deepest, closed.deepest, 1e-3 * closed.deepest);
      }
    }
  }
}

TEST(FixedGrain, ObliqueImpactIsThatOnAPlane) {
  // Psi_2 of Psi_1 for k_t / k_n = 0.8 (friction_test.cpp); the top of a sphere is plane over the path during contact,
  // 1e-3 radii. Errors: discretisation of 400 steps, and the lever arm R - overlap / 2 instead of R.
  const double known[][2] = {{0.5, 0.17152395}, {1, 0.13970062}, {2, -0.64159851}, {4, -1.79999317}, {8, 1}};
  for (const double ground : {1.0, 4.0})
    for (const auto& [psi1, psi2] : known) {
      GrainModel m = ball(1);
      const double mu = 0.3, vn = 0.05, r = m.radius;
      m.law.friction = mu, m.law.tangentialStiffness = 0.8 * m.law.stiffness;
      m.timeStep = base::kPi / std::sqrt(m.law.stiffness / m.mass) / 400;
      m.maxOverlap = 1, m.smallestRadius = r;
      if (ground > 1) m.radius *= ground, m.mass *= ground * ground * ground;
      Grains grains(testExec(1), m, {},
                    {fixedAt({0, 0, -ground * r}, ground * r),
                     {{0, 0, r + 1.5 * m.timeStep * vn}, {psi1 * mu * vn, 0, -vn}, {}, r}});
      advance(grains, 800);
      const auto s = grains.snapshot();
      EXPECT_NEAR(s.velocity[1].z, vn, 0.01 * vn);
      EXPECT_NEAR((s.velocity[1].x - r * s.spin[1].y) / (mu * vn), psi2, 0.01 * (1 + psi1)) << "Psi_1 = " << psi1;
    }
}

struct Kind {
  bool hertz = false, rolling = false, radii = false, materials = false, friction = true, ledger = true;
  Precision precision = Precision::single;
};

contact::ContactLaw lawOf(const Kind& kind) {
  contact::ContactLaw law;
  if (kind.hertz) {
    law.hertz = true, law.stiffness = 5e7, law.tangentialStiffness = 4e7;
    law.rootDamping = 0.3 * std::sqrt(1.5 * law.stiffness), law.tangentialRootDamping = law.rootDamping / 2;
  } else {
    law.stiffness = 1e5, law.tangentialStiffness = 3e4, law.damping = 800, law.tangentialDamping = 400;
  }
  law.friction = kind.friction ? 0.5 : 0;
  if (kind.rolling) law.rollingFriction = 0.1, law.rollingDamping = 0.3;
  return law;
}

GrainModel modelOf(const Kind& kind) {
  GrainModel m = ball(1e-5);
  m.gravity = {0.5, -0.2, -9.81};
  m.law = lawOf(kind), m.ledger = kind.ledger, m.precision = kind.precision;
  if (kind.materials) m.materials = {{2600, 1500}, {m.law, m.law, m.law, m.law}, {m.law, m.law}};
  return m;
}

/// Grains that fall onto a floor of overlapping fixed grains, and against a wall.
std::vector<GrainSpec> overFixed(const Kind& kind, int layers = 3) {
  std::vector<GrainSpec> start;
  const auto u = [&](std::uint64_t k) { return base::uniform(5, 6, start.size(), k); };
  for (int i = 0; i < 81; ++i)
    start.push_back(fixedAt({0.008 * (i % 9), 0.008 * (i / 9), 0.001 * u(0)}, kind.radii ? 0.002 + 0.003 * u(1) : 0));
  for (int i = 0; i < 36 * layers; ++i) {
    GrainSpec g;
    g.position = Vec3d{i % 6 + 0.1 * u(0), i / 6 % 6 + 0.1 * u(1), i / 36 + 1.05} * 0.0112;
    g.velocity = {u(2) - 0.5, u(3) - 0.5, -1}, g.spin = {100 * u(4), -50 * u(5), 80 * u(6)};
    if (kind.radii) g.radius = 0.0025 + 0.0025 * u(7);
    if (kind.materials) g.material = u(8) < 0.5;
    start.push_back(g);
  }
  return start;
}

Grains bedOf(const Kind& kind, const GrainModel& m, const base::Exec& exec = testExec(1)) {
  return {exec, m, {{{{1, 0, 0}, -0.0055, m.law}}, {}}, overFixed(kind)};
}

std::vector<Kind> kinds() {
  std::vector<Kind> all;
  for (int bits = 0; bits < 32; ++bits)
    all.push_back({(bits & 1) != 0, (bits & 2) != 0, (bits & 4) != 0, (bits & 8) != 0, true, true,
                   bits & 16 ? Precision::double_ : Precision::single});
  all.push_back({.friction = false});
  all.push_back({.ledger = false});
  return all;
}

TEST(FixedGrains, EveryKernelGivesTheBitsOfTheGeneralOne) {
  for (const Kind& kind : kinds()) {
    GrainModel m = modelOf(kind);
    Grains special = bedOf(kind, m);
    advance(special, 600);
    const std::string text = featureText(special.system().constants.features);
    EXPECT_NE(text.find("fixed grains"), std::string::npos);
    EXPECT_GT(special.ledger().contacts, 0) << "some grains touch the floor: " << text;
    if (kind.ledger) {
      EXPECT_GT(special.ledger().impulse.z, 0) << "they have rebounded";
    }
    m.specialised = false, m.skin = 0.2, m.maxSimdLanes = 1;
    Grains general = bedOf(kind, m, testExec(2));
    advance(general, 600);
    EXPECT_TRUE(wordsOf(special) == wordsOf(general)) << text;
    for (const int lanes : {4, 8}) {
      GrainModel narrow = modelOf(kind);
      narrow.maxSimdLanes = lanes;
      Grains same = bedOf(kind, narrow, testExec(2));
      advance(same, 600);
      EXPECT_TRUE(wordsOf(special) == wordsOf(same)) << text << ", " << lanes << " lanes";
    }
  }
}

TEST(FixedGrains, NeverMove) {
  const Kind kind{.rolling = true, .radii = true};
  Grains grains = bedOf(kind, modelOf(kind));
  const auto before = grains.snapshot();
  advance(grains, 3000);
  const auto after = grains.snapshot();
  ASSERT_EQ(after.fixed.size(), after.position.size());
  int fixed = 0;
  for (std::size_t i = 0; i < after.position.size(); ++i) {
    if (!after.fixed[i]) continue;
    ++fixed;
    EXPECT_EQ(norm(after.position[i] - before.position[i]), 0) << i;
    EXPECT_EQ(norm(after.velocity[i]) + norm(after.spin[i]), 0) << i;
    EXPECT_EQ(after.radius[i], before.radius[i]);
    EXPECT_GT(after.radius[i], 0);
  }
  EXPECT_EQ(fixed, 81);
}

TEST(FixedGrains, BooksClose) {
  for (const Kind& kind : {Kind{}, Kind{.rolling = true}, Kind{.hertz = true, .rolling = true, .radii = true}}) {
    GrainModel m = modelOf(kind);
    m.timeStep = 2e-6;
    Grains grains = bedOf(kind, m);
    const GrainLedger start = grains.ledger();
    EXPECT_EQ(start.contacts, 0) << "overlaps of fixed grains are no contacts";
    EXPECT_EQ(start.elastic, 0);
    advance(grains, 5000);
    const GrainLedger l = grains.ledger();
    const double weight = 108 * m.mass * norm(m.gravity) * 1e-2; // all grains, over the run
    // Sums of forces are floats.
    EXPECT_LT(norm((l.momentum - l.impulse) - start.momentum), 1e-6 * weight);
    EXPECT_LT(norm((l.angularMomentum - l.angularImpulse) - start.angularMomentum), 1e-6 * weight * 0.1);
    EXPECT_GT(norm(l.momentum - m.gravity * (108 * m.mass * 1e-2) - start.momentum), 0.01 * weight)
        << "the floor has exerted forces";
    EXPECT_NEAR(l.work, l.kinetic + l.rotational - start.kinetic - start.rotational, 1e-6 * start.kinetic);
    const auto energy = [](const GrainLedger& g) {
      return g.kinetic + g.rotational + g.potential + g.elastic + g.dissipated();
    };
    EXPECT_GT(l.dissipated(), 0.3 * start.kinetic);
    EXPECT_NEAR(energy(l), energy(start), 5e-3 * start.kinetic) << "impacts of 200 or more steps: first order";
  }
}

TEST(FixedGrains, HaveNoWeightAndCountInNoContactTwice) {
  GrainModel m = ball(1e-5);
  m.gravity = {0, 0, -9.81}, m.law.damping = 1000;
  const double overlap = m.mass * 9.81 / m.law.stiffness;
  Grains grains(
      testExec(1), m, {},
      {fixedAt({0, 0, -0.005}), {{0, 0, 0.005 - overlap}, {}, {}}, fixedAt({0.5, 0, 0}), fixedAt({0.503, 0, 0})});
  advance(grains, 5000);
  const GrainLedger l = grains.ledger();
  EXPECT_EQ(l.contacts, 1);
  EXPECT_NEAR(l.elastic, 0.5 * m.law.stiffness * overlap * overlap, 1e-3 * l.elastic) << "the overlap is 6000 units";
  EXPECT_NEAR(l.potential, m.mass * 9.81 * 0.005, 1e-3 * l.potential) << "weight of one grain";
  EXPECT_LT(forceRatio(grains.system()), 1e-3) << "at rest; mean over free grains";
  EXPECT_EQ(grains.system().fixedCount, 3u);
  const auto force = grains.snapshot({.contactForces = true}).contactForce;
  EXPECT_EQ(norm(force[0]), 0);
  EXPECT_NEAR(force[1].z, m.mass * 9.81, 1e-3 * m.mass * 9.81);
}

TEST(FixedGrains, TakeWhatPartsDoToThemAndHandItOn) {
  GrainModel m = modelOf({});
  Grains grains = bedOf({}, m, base::cpuExec(1));
  const Vec3d first = grains.ledger().momentum;
  const base::FixedPoint quantum = base::fixedPointFor(1e3);
  std::int64_t received[3]{};
  std::vector<std::uint32_t> range;
  const contact::GrainLoad load{quantum.quantise(Vec3d{0.02, 0.01, -0.03}), {1e-5f, 0, 0}, 1e-5f};
  for (int s = 0; s < 300; ++s) {
    grains.refreshNeighbours();
    range.assign(grains.view().count, 0);
    for (std::size_t i = 0; i < range.size(); ++i)
      if (grains.view().id[i] % 4 == 0) range[i] = 1; // the first load, for fixed and free grains
    const contact::GrainLoadsView loads{range.data(), &load, quantum, received};
    grains.step(&loads);
  }
  EXPECT_EQ(received[0], 300 * 48 * load.force.x) << "21 fixed and 27 free grains";
  const Vec3d fromParts = quantum.value(base::Vec3l{received[0], received[1], received[2]}) * m.timeStep;
  const GrainLedger l = grains.ledger();
  EXPECT_LT(norm(l.momentum - first - l.impulse - fromParts), 1e-6 * norm(fromParts));
}

TEST(FixedGrains, SurfacesFeelThem) {
  GrainModel m = ball(1e-5);
  makeRough(m.law, 1000);
  const double depth = 1e-4;
  Grains grains(testExec(1), m, {{floorPlane(m.law)}, {}, {}, {{boxOf({0.1, 0.1, 0.01}), m.law, placed({0, 0, 0.5})}}},
                {fixedAt({0, 0, 0.001}), fixedAt({0.006, 0, 0}), {{0.05, 0, 0.2}, {}, {}}});
  grains.setSurfacePoses({placed({0, 0, 0.006 - depth + 0.01})});
  grains.refreshNeighbours();
  grains.step();
  EXPECT_NEAR(grains.system().boundaries.surfaceLoads()[0].force.z, m.law.stiffness * depth, 1e-3);
  EXPECT_NEAR(grains.ledger().impulse.z, m.law.stiffness * depth * m.timeStep, 1e-8) << "the ground supports it";
  EXPECT_NEAR(grains.ledger().elastic, 0.5 * m.law.stiffness * depth * depth, 1e-6);
  EXPECT_EQ(norm(grains.ledger().momentum), 0);
}

TEST(FixedGrains, GoOnToTheSameBitsWhenResumed) {
  for (const Kind& kind : {Kind{}, Kind{.hertz = true, .rolling = true, .radii = true}}) {
    const GrainModel m = modelOf(kind);
    Grains straight = bedOf(kind, m), first = bedOf(kind, m), second = bedOf(kind, m, testExec(2));
    advance(straight, 1500), advance(first, 700);
    const GrainState saved = first.state();
    EXPECT_EQ(saved.fixed.size(), saved.rows());
    second.restore(saved);
    EXPECT_EQ(second.state().words(), saved.words());
    EXPECT_EQ(second.system().fixedCount, 81u);
    advance(second, 800);
    EXPECT_EQ(wordsOf(second), wordsOf(straight));
  }
}

TEST(FixedGrains, WhereThereAreNone_NothingIsStoredForThem) {
  GrainModel m = modelOf({});
  Grains grains(testExec(1), m, {}, {{{0, 0, 0}, {}, {}}});
  EXPECT_FALSE(grains.system().constants.has(kFixed));
  EXPECT_TRUE(grains.state().fixed.empty());
  EXPECT_TRUE(grains.snapshot().fixed.empty());
  EXPECT_EQ(featureText(grains.system().constants.features).find("fixed"), std::string::npos);
  EXPECT_THROW(grains.add({fixedAt({1, 0, 0})}), std::logic_error);
  m.fixedGrains = true;
  Grains other(testExec(1), m, {}, {{{0, 0, 0}, {}, {}}});
  EXPECT_NO_THROW(other.add({fixedAt({1, 0, 0})}));
  EXPECT_EQ(other.system().fixedCount, 1u);
  EXPECT_THROW(other.restore(grains.state(), true), base::InputError) << "another kind of scene";
}

TEST(FixedGrains, ThatMove_AreRefused) {
  GrainSpec moving = fixedAt({0, 0, 0});
  moving.velocity.x = 1;
  EXPECT_THROW(Grains(testExec(1), ball(1e-5), {}, {moving}), base::InputError);
}

} // namespace
} // namespace grouser::terrain::testing
