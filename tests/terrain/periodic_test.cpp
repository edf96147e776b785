// SPDX-License-Identifier: BSD-3-Clause
// Periodic boundaries: no bit depends on their position.
#include "base/error.hpp"
#include "grain_fixture.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace grouser::terrain::testing {
namespace {

constexpr double kLengthX = 0.063, kLengthY = 0.047; // domain size [m]: at most twelve and nine reaches

GrainModel rubbing(double skin = 0.3) {
  GrainModel m = ball(1e-5);
  m.gravity = {0, 0, -80}; // to bring them into contact soon
  makeRough(m.law, 2000);
  m.skin = skin;
  return m;
}

Boundaries periodic(const GrainModel& m, bool x = true, bool y = true) {
  Boundaries b{{{{0, 0, 1}, 0, m.law}}, {}};
  if (x) b.periodic[0] = {0.0, kLengthX};
  if (y) b.periodic[1] = {-0.01, kLengthY - 0.01};
  return b;
}

/// Layers thrown across the domain, shifted along x and y by whole units of position, around the ring.
std::vector<GrainSpec> thrownAcross(const base::Vec3l& shift, bool manyRadii = false) {
  const base::PositionScale scale = base::positionScale(0.01);
  const base::Period period = [&] {
    base::Period p;
    const auto units = [&](double x) { return base::toUnits(scale.fromMetres({x, 0, 0})).x; };
    p.low = {0, units(-0.01), 0}, p.length = {units(kLengthX), units(kLengthY - 0.01) - units(-0.01), 0};
    return p;
  }();
  std::vector<GrainSpec> start;
  for (int z = 0; z < 5; ++z)
    for (int y = 0; y < 4; ++y)
      for (int x = 0; x < 6; ++x) {
        const base::Vec3d place{0.0052 + 0.0105 * x + 0.0004 * z, -0.0048 + 0.0117 * y + 0.0005 * (x % 2),
                                0.006 + 0.0104 * z};
        const base::Vec3l u = period.wrapped(base::toUnits(scale.fromMetres(place)) + shift);
        GrainSpec g{scale.toMetres(base::fromUnits(u)), {0.6, -0.35, -0.2}, {5, 3, -20}};
        if (manyRadii) g.radius = (x + y + z) % 3 ? 0.005 : 0.0031;
        start.push_back(g);
      }
  return start;
}

/// State that is independent of the boundary positions: velocities, spins, remainders and contact springs.
struct Relative {
  std::vector<base::Vec3f> velocity, spin, shear;
  std::vector<std::uint32_t> neighbour;
  std::vector<std::uint32_t> remainders;
  bool operator==(const Relative&) const = default;
};

Relative relative(const GrainState& s) {
  Relative r{s.velocity, s.spin, s.contactShear, s.neighbour, {}};
  for (const Remainders& k : s.remainders)
    r.remainders.insert(r.remainders.end(), {k.axis[0], k.axis[1], k.axis[2], k.position});
  return r;
}

std::int64_t crossed(const GrainState& s) {
  std::int64_t sum = 0;
  for (const Crossings& c : s.crossings) sum += std::abs(c.x) + std::abs(c.y);
  return sum;
}

GrainState end(const GrainModel& m, const base::Vec3l& shift, int threads = 1, bool manyRadii = false) {
  Grains grains(base::cpuExec(threads), m, periodic(m), thrownAcross(shift, manyRadii));
  advance(grains, 4000);
  return grains.state();
}

TEST(PeriodicBoundaries, NoBitDependsOnWhereTheyStand) {
  const GrainState here = end(rubbing(), {});
  EXPECT_GT(crossed(here), 20) << "grains must have crossed the boundary";
  EXPECT_GT(here.neighbour.size(), 40u) << "and touch each other";
  for (const base::Vec3l& shift : {base::Vec3l{123456789, 0, 0}, base::Vec3l{-234567890, 345678901, 0}}) {
    const GrainState there = end(rubbing(), shift, 2);
    EXPECT_TRUE(relative(here) == relative(there));
    EXPECT_NE(here.position.front().x, there.position.front().x);
  }
}

TEST(PeriodicBoundaries, SameBitsForSkinsThreadsAndKernels) {
  const auto reference = end(rubbing(), {}).words();
  EXPECT_EQ(end(rubbing(0.6), {}, 2).words(), reference);
  EXPECT_EQ(end(rubbing(0.1), {}, 2).words(), reference);
  GrainModel general = rubbing();
  general.specialised = false;
  EXPECT_EQ(end(general, {}).words(), reference);
}

TEST(PeriodicBoundaries, NoBitDependsOnWhereTheyStandForManyRadiiThatRollInDouble) {
  GrainModel m = rubbing();
  m.law.rollingFriction = 0.1f, m.law.rollingDamping = 0.3f;
  m.precision = Precision::double_;
  EXPECT_TRUE(relative(end(m, {}, 1, true)) == relative(end(m, {223456789, -145678901, 0}, 2, true)));
}

TEST(PeriodicBoundaries, ListFindsEveryImageThatTouches) {
  // Compared with a search over all pairs and all images, in domains of few and many cells.
  for (const double length : {0.0361, 0.05, 0.2}) {
    GrainModel m = ball(1e-5);
    m.radius = 0.004;
    Boundaries b;
    b.periodic = {std::array{0.0, length}, std::array{0.0, length}};
    std::vector<GrainSpec> start;
    for (int i = 0; i < 60; ++i)
      start.push_back(
          {{std::fmod(0.0137 * i, length), std::fmod(0.0071 * i + 0.003, length), 0.0031 * (i % 4)}, {}, {}});
    Grains grains(base::cpuExec(2), m, b, start);
    std::int64_t pairs = 0;
    for (std::size_t i = 0; i < start.size(); ++i)
      for (std::size_t j = i + 1; j < start.size(); ++j) {
        double least = 1;
        for (int k = 0; k < 9; ++k)
          least = std::min(least, norm(start[i].position - start[j].position +
                                       base::Vec3d{length * (k / 3 - 1), length * (k % 3 - 1), 0}));
        pairs += least < 2 * m.radius;
      }
    EXPECT_EQ(grains.ledger().contacts, pairs) << length;
    EXPECT_GT(pairs, 0);
  }
}

TEST(PeriodicBoundaries, FallAlongThemKeepsTheEnergy) {
  // An endless slope of 45 degrees: the kinetic energy equals the work of gravity.
  GrainModel m = ball(1e-5);
  m.gravity = {6, -4, 0};
  Boundaries b;
  b.periodic = {std::array{0.0, 0.05}, std::array{-0.02, 0.03}};
  Grains grains(base::cpuExec(1), m, b, {{{0.01, 0.0, 0.1}, {}, {}}});
  const GrainLedger before = grains.ledger();
  constexpr int kSteps = 100000;
  advance(grains, kSteps);
  const GrainLedger after = grains.ledger();
  const double t = kSteps * m.timeStep, way = 0.5 * 52 * t * (t + m.timeStep); // the parabola of symplectic Euler
  EXPECT_GT(crossed(grains.state()), 90);
  EXPECT_NEAR((before.potential - after.potential) / m.mass, way, 1e-6 * way);
  EXPECT_NEAR(after.kinetic - before.kinetic, before.potential - after.potential, 2e-5 * after.kinetic);
}

TEST(PeriodicBoundaries, MomentumOfAGasIsKept) {
  GrainModel m = ball(1e-5);
  Boundaries b;
  b.periodic = {std::array{0.0, kLengthX}, std::array{0.0, kLengthX}};
  std::vector<GrainSpec> start;
  for (int i = 0; i < 100; ++i)
    start.push_back({{0.006 + 0.0125 * (i % 5), 0.006 + 0.0125 * (i / 5 % 5), 0.0105 * (i / 25)},
                     {0.3 * (i % 7 - 3), 0.2 * (i % 5 - 2), 0},
                     {}});
  Grains grains(base::cpuExec(1), m, b, start);
  const base::Vec3d before = grains.ledger().momentum;
  advance(grains, 5000);
  // Velocities are floats: each has a resolution of half a last place, about 6e-8 m/s.
  EXPECT_LT(norm(grains.ledger().momentum - before), 100 * m.mass * 6e-8);
}

TEST(PeriodicBoundaries, ResumedRunsGoOnToTheSameBits) {
  const GrainModel m = rubbing();
  Grains straight(base::cpuExec(1), m, periodic(m), thrownAcross({}));
  advance(straight, 4000);
  for (const int step : {1, 777, 2500}) {
    Grains first(base::cpuExec(1), m, periodic(m), thrownAcross({}));
    advance(first, step);
    const GrainState saved = first.state();
    Grains second(base::cpuExec(2), m, periodic(m), thrownAcross({}));
    second.restore(saved);
    EXPECT_EQ(second.state().words(), saved.words());
    EXPECT_EQ(second.state().travelled, saved.travelled);
    advance(second, 4000 - step);
    EXPECT_EQ(second.state().words(), straight.state().words()) << "resumed at step " << step;
    EXPECT_EQ(second.system().rebuilds, straight.system().rebuilds);
    EXPECT_EQ(second.ledger().potential, straight.ledger().potential);
  }
}

TEST(PeriodicBoundaries, TooNearOrGrainsOutsideAreRefused) {
  const GrainModel m = rubbing();
  Boundaries near = periodic(m);
  near.periodic[1] = {0.0, 0.034};
  EXPECT_THROW(Grains(base::cpuExec(1), m, near, thrownAcross({})), base::InputError);
  EXPECT_THROW(Grains(base::cpuExec(1), m, periodic(m), {{{-0.001, 0, 0.01}, {}, {}}}), base::InputError);
  EXPECT_THROW(Grains(base::cpuExec(1), m, periodic(m), {{{0.001, kLengthY, 0.01}, {}, {}}}), base::InputError);
}

} // namespace
} // namespace grouser::terrain::testing
