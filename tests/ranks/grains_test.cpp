// SPDX-License-Identifier: BSD-3-Clause
// Bitwise identical results on any number of ranks: grains that slide, spin, touch walls and cross subdomain borders.
#include "base/error.hpp"
#include "base/random.hpp"
#include "terrain/bed_tops.hpp"
#include "terrain/grains.hpp"
#include "tests/ranks/ranks.hpp"
#include "tests/terrain/grain_fixture.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace grouser::terrain::testing {
namespace {

/// A block of 360 grains thrown across the box: nearly all change their subdomain.
std::vector<GrainSpec> thrownBlock() { return gravelBlock(12, 6, 5, {2.5, 1.0, -1}, {3, -2, 9}); }

Boundaries box(const GrainModel& m) {
  return {{{{0, 0, 1}, 0, m.law}, {{1, 0, 0}, -0.05, m.law}, {{-1, 0, 0}, -0.85, m.law}, {{0, -1, 0}, -0.5, m.law}},
          {}};
}

PartitionOptions shared(const std::array<int, 3>& shape = {0, 0, 0}, bool rebalance = false) {
  return {test::comm(), shape, {}, rebalance};
}

/// All state words, on every rank, ordered by id.
std::vector<std::uint32_t> allWords(const Grains& grains) {
  std::vector<std::uint32_t> words;
  for (const auto& part : grains.system().comm.gatherAll(grains.state().words()))
    words.insert(words.end(), part.begin(), part.end());
  return words;
}

constexpr int kSteps = 3000;

const std::vector<std::uint32_t>& expected() {
  static const std::vector<std::uint32_t> words = [] {
    const GrainModel m = gravel();
    Grains alone(base::cpuExec(1), m, box(m), thrownBlock());
    advance(alone, kSteps);
    return alone.state().words();
  }();
  return words;
}

TEST(GrainsOnRanks, EqualBitsForEveryLattice) {
  const int n = test::comm().size();
  const GrainModel m = gravel();
  for (int x = 1; x <= n; ++x)
    for (int y = 1; n % x == 0 && y <= n / x; ++y) {
      if (n / x % y != 0) continue;
      Grains grains(base::cpuExec(1), m, box(m), thrownBlock(), shared({x, y, n / x / y}));
      advance(grains, kSteps);
      EXPECT_EQ(allWords(grains), expected()) << x << " x " << y << " x " << n / x / y;
    }
}

/// Right after a step, before a list rebuild, and after one.
TEST(GrainsOnRanks, FieldsHaveTheBitsOfOneRank) {
  const GrainModel m = gravel();
  Grains grains(base::cpuExec(1), m, box(m), thrownBlock(), shared()),
      alone(base::cpuExec(1), m, box(m), thrownBlock());
  const FieldGrid grid = fieldGrid({-0.1, -0.1, -0.1}, {1.1, 0.7, 0.5}, 0.07, {});
  for (const int steps : {700, 1, 800}) {
    advance(grains, steps), advance(alone, steps);
    grains.refreshNeighbours(), alone.refreshNeighbours();
    const SoilFields shared = fieldsOf(grains, grid), whole = fieldsOf(alone, grid);
    EXPECT_EQ(shared.stress, whole.stress);
    EXPECT_EQ(shared.porosity, whole.porosity);
    for (std::size_t c = 0; c < grid.count(); ++c) {
      if (std::isnan(whole.velocity[c].x)) continue;
      EXPECT_EQ(shared.velocity[c], whole.velocity[c]);
      EXPECT_EQ(shared.coordination[c], whole.coordination[c]);
    }
  }
}

/// A separate test, since eight ranks on two cores take a minute for all.
TEST(GrainsOnRanks, EqualBitsWhereEveryAxisIsDivided) {
  if (test::comm().size() != 8) GTEST_SKIP() << "requires 2 x 2 x 2 ranks";
  const GrainModel m = gravel();
  Grains grains(base::cpuExec(1), m, box(m), thrownBlock(), shared({2, 2, 2}));
  advance(grains, kSteps);
  EXPECT_EQ(allWords(grains), expected());
}

/// Noise with the wavelength and nearly the height of the grains: most touch the floor in several places.
Boundaries roughBox(const GrainModel& m) {
  Boundaries sides = box(m);
  const Rectangle area{-0.3, 1.2, -0.3, 0.9};
  int i = 0;
  const auto noise = [&](double, double) { return 0.02 * base::uniform(1, 2, static_cast<std::uint64_t>(i++), 0); };
  sides.floor = HeightField(area, 51, 41, HeightField::sample(area, 51, 41, noise).heights(), Interpolation::monotone);
  return sides;
}

TEST(GrainsOnRanks, EqualBitsOnGroundWithHollowsTighterThanTheGrains) {
  GrainModel m = gravel();
  m.law.rollingFriction = 0.1;
  m.floorLaw = m.law;
  constexpr int kFew = 1500;
  Grains alone(base::cpuExec(1), m, roughBox(m), thrownBlock()),
      grains(base::cpuExec(1), m, roughBox(m), thrownBlock(), shared({}, true));
  advance(alone, kFew), advance(grains, kFew);
  ASSERT_FALSE(alone.state().floorNormal.empty());
  EXPECT_EQ(allWords(grains), alone.state().words());
  Grains resumed(base::cpuExec(1), m, roughBox(m), thrownBlock(), shared());
  resumed.restore(grains.state());
  advance(resumed, 300), advance(alone, 300);
  EXPECT_EQ(allWords(resumed), alone.state().words());
}

TEST(GrainsOnRanks, EqualBitsOfYieldingContacts) {
  // Plastic states migrate with their grains and with wall springs.
  GrainModel m = gravel();
  m.law.plastic = {0.6, 0.6, 0.3, 400, 0, 0, 3};
  Grains alone(base::cpuExec(1), m, box(m), thrownBlock());
  advance(alone, kSteps);
  ASSERT_GT(alone.ledger().yielded, 0);
  Grains grains(base::cpuExec(1), m, box(m), thrownBlock(), shared());
  advance(grains, kSteps);
  EXPECT_EQ(allWords(grains), alone.state().words());
  EXPECT_EQ(grains.ledger().yielded, alone.ledger().yielded);
}

TEST(GrainsOnRanks, EqualBitsAcrossPeriodicBoundaries) {
  const int n = test::comm().size();
  const GrainModel m = gravel();
  const auto ring = [&](bool x, bool y) {
    Boundaries b{{{{0, 0, 1}, 0, m.law}}, {}};
    if (!x) b.walls.insert(b.walls.end(), {{{1, 0, 0}, -0.05, m.law}, {{-1, 0, 0}, -0.85, m.law}});
    if (!y) b.walls.push_back({{0, -1, 0}, -0.5, m.law});
    if (x) b.periodic[0] = {-0.05, 0.75};
    if (y) b.periodic[1] = {-0.05, 0.36};
    return b;
  };
  for (int which = 1; which <= 3; ++which) {
    const Boundaries boundaries = ring(which & 1, which & 2);
    Grains alone(base::cpuExec(1), m, boundaries, thrownBlock());
    advance(alone, 2000);
    std::int64_t crossed = 0;
    for (const Crossings& c : alone.state().crossings) crossed += std::abs(c.x) + std::abs(c.y);
    EXPECT_GT(crossed, 30);
    for (int x = 1; x <= n; ++x) {
      if (n % x != 0) continue;
      Grains grains(base::cpuExec(1), m, boundaries, thrownBlock(), shared({x, n / x, 1}, x == 1));
      advance(grains, 1100);
      Grains resumed(base::cpuExec(1), m, boundaries, thrownBlock(), shared({n / x, x, 1}));
      resumed.restore(grains.state());
      advance(grains, 900), advance(resumed, 900);
      EXPECT_EQ(allWords(grains), alone.state().words()) << x << " x " << n / x << ", periodic " << which;
      EXPECT_EQ(allWords(resumed), alone.state().words())
          << "resumed, " << x << " x " << n / x << ", periodic " << which;
      EXPECT_EQ(grains.ledger().potential, alone.ledger().potential);
    }
  }
}

TEST(GrainsOnRanks, EqualBitsAboveAFloorOfFixedGrains) {
  for (const bool manyRadii : {false, true}) {
    GrainModel m = gravel();
    m.law.rollingFriction = 0.1, m.law.rollingDamping = 0.3;
    std::vector<GrainSpec> start = gravelBlock(12, 6, 3, {2.5, 1.0, -1}, {3, -2, 9});
    if (manyRadii)
      for (std::size_t i = 0; i < start.size(); ++i) start[i].radius = (i % 3 ? 1 : 0.6) * m.radius;
    for (int i = 0; i < 24 * 14; ++i) // interleaved with the others' ids
      start.insert(start.begin() + i / 2,
                   GrainSpec{{0.04 * (i % 24), 0.04 * (i / 24) - 0.03, -0.03}, {}, {}, manyRadii ? 0.02 : 0, 0, true});
    Boundaries sides = box(m);
    sides.walls.erase(sides.walls.begin());
    Grains alone(base::cpuExec(1), m, sides, start), grains(base::cpuExec(1), m, sides, start, shared({}, true));
    advance(alone, 1200), advance(grains, 1200);
    EXPECT_EQ(allWords(grains), alone.state().words());
    EXPECT_EQ(grains.state().ledgerSums, alone.state().ledgerSums);
    EXPECT_GT(alone.ledger().impulse.z, 0) << "they have bounced";
    EXPECT_EQ(grains.ledger().contacts, alone.ledger().contacts);
    EXPECT_EQ(norm(grains.ledger().impulse - alone.ledger().impulse), 0);
    Grains resumed(base::cpuExec(1), m, sides, start, shared());
    resumed.restore(grains.state());
    EXPECT_EQ(resumed.system().fixedCount, 336u);
    advance(resumed, 300), advance(alone, 300);
    EXPECT_EQ(allWords(resumed), alone.state().words());
  }
}

TEST(GrainsOnRanks, ContactForcesAreTheSameAndGoWithGrainsThatMigrate) {
  const GrainModel m = gravel();
  Grains alone(base::cpuExec(1), m, box(m), thrownBlock()),
      grains(base::cpuExec(1), m, box(m), thrownBlock(), shared({}, true));
  const auto forces = [](const Grains& g) {
    std::vector<base::Vec3f> all;
    for (const auto& part : g.system().comm.gatherAll(g.snapshot({.contactForces = true}).contactForce))
      all.insert(all.end(), part.begin(), part.end());
    return all;
  };
  for (int k = 0; k < 5; ++k) {
    advance(alone, 300), advance(grains, 300);
    ASSERT_EQ(forces(grains), forces(alone)) << "after " << alone.steps();
    const std::vector<base::Vec3f> before = forces(alone);
    grains.invalidateNeighbours();
    grains.ledger(); // migrates
    ASSERT_EQ(forces(grains), before);
  }
}

TEST(GrainsOnRanks, EqualBitsForManyRadiiAndMaterialsThatRollAndStick) {
  for (const Precision precision : {Precision::single, Precision::double_}) {
    GrainModel m = gravel();
    m.precision = precision;
    const auto lawOf = [](double modulus) {
      contact::ContactLaw law;
      law.hertz = true, law.stiffness = modulus, law.tangentialStiffness = 0.8 * modulus;
      law.rootDamping = 0.3 * std::sqrt(modulus), law.tangentialRootDamping = 0.1 * std::sqrt(modulus);
      law.friction = 0.5, law.rollingFriction = 0.1, law.rollingDamping = 0.3, law.pullPerRadius = 5;
      return law;
    };
    m.materials.density = {2500, 1200};
    m.materials.grains = {lawOf(4e7), lawOf(3e7), lawOf(3e7), lawOf(2e7)};
    for (int wall = 0; wall < 4; ++wall)
      m.materials.boundaries.insert(m.materials.boundaries.end(), {lawOf(6e7), lawOf(3e7)});
    std::vector<GrainSpec> start = thrownBlock();
    for (std::size_t i = 0; i < start.size(); ++i) {
      start[i].radius = i % 3 ? m.radius : 0.4 * m.radius;
      start[i].material = static_cast<int>(i / 7 % 2);
    }
    constexpr int kFew = 1200;
    Grains alone(base::cpuExec(1), m, box(m), start), grains(base::cpuExec(1), m, box(m), start, shared({}, true));
    advance(alone, kFew), advance(grains, kFew);
    EXPECT_EQ(allWords(grains), alone.state().words());
    Grains resumed(base::cpuExec(1), m, box(m), start, shared());
    resumed.restore(grains.state());
    advance(resumed, 200), advance(alone, 200);
    EXPECT_EQ(allWords(resumed), alone.state().words());
  }
}

TEST(GrainsOnRanks, EqualBitsForOtherSkinsAndCutsThatMove) {
  const GrainModel m = gravel(0.6);
  Grains grains(base::cpuExec(1), m, box(m), thrownBlock(), shared({0, 0, 0}, true));
  if (GrainDistribution* ranks = grains.distribution()) {
    // Every 300 steps all cuts jump: most grains migrate at once, some ranks are left with none.
    for (int k = 0; k < 10; ++k) {
      std::array<std::vector<std::int64_t>, 3> weights;
      for (auto& w : weights) w.assign(contact::kPartitionBins, 1), w[400 * static_cast<std::size_t>(k)] = 100000;
      const auto u = [&](double metres) { return static_cast<std::int64_t>(metres * grains.scale().perMetre); };
      ranks->setPartition(
          {ranks->subdomain().partition().shape(), {u(-0.1), u(-0.1), u(0)}, {u(0.9), u(0.6), u(0.4)}, weights});
      grains.invalidateNeighbours();
      advance(grains, 300);
    }
  } else {
    advance(grains, kSteps);
  }
  EXPECT_EQ(allWords(grains), expected());
}

TEST(GrainsOnRanks, SpringsOfWallsGoWithGrainsThatMigrate) {
  const GrainModel m = gravel();
  // A layer hits the floor and slides along it.
  Grains grains(base::cpuExec(1), m, box(m), gravelBlock(14, 8, 1, {0.2, 0.3, -0.2}, {}, {0, 0, -0.004}), shared());
  advance(grains, 10); // a contact lasts 29
  GrainDistribution* const ranks = grains.distribution();
  if (!ranks) GTEST_SKIP() << "one rank has no migration";
  const auto held = [&] {
    std::int64_t some = 0;
    for (const base::Vec3f& spring : grains.state().wallShear) some += norm(spring) > 0 ? 1 : 0;
    return grains.system().comm.sumOf(some);
  };
  ASSERT_GT(held(), 20);
  const std::vector<std::uint32_t> words = allWords(grains);
  std::int64_t moved = 0;
  for (int k = 0; k < 6; ++k) {
    std::array<std::vector<std::int64_t>, 3> weights;
    for (auto& w : weights) w.assign(contact::kPartitionBins, 1), w[600 * static_cast<std::size_t>(k)] = 100000;
    const auto u = [&](double metres) { return static_cast<std::int64_t>(metres * grains.scale().perMetre); };
    ranks->setPartition(
        {ranks->subdomain().partition().shape(), {u(-0.1), u(-0.1), u(0)}, {u(0.9), u(0.6), u(0.4)}, weights});
    grains.invalidateNeighbours();
    grains.refreshNeighbours();
    moved += grains.system().comm.sumOf(static_cast<std::int64_t>(ranks->subdomain().migration().importCount()));
    ASSERT_EQ(allWords(grains), words) << "migration " << k;
  }
  EXPECT_GT(moved, 100);
}

TEST(GrainsOnRanks, EqualBitsWhenResumedFromAnyBlockOfRows) {
  const GrainModel m = gravel();
  Grains first(base::cpuExec(1), m, box(m), thrownBlock(), shared());
  advance(first, 1234);
  const GrainState saved = first.state(); // this rank's block of ids
  Grains second(base::cpuExec(1), m, box(m), thrownBlock(), shared());
  second.restore(saved);
  // No state is lost, including that for the next list rebuild.
  const GrainState again = second.state();
  EXPECT_EQ(again.words(), saved.words());
  EXPECT_EQ(again.travelled, saved.travelled);
  EXPECT_EQ(again.ledgerSums, saved.ledgerSums);
  second.setSteps(1234);
  advance(second, kSteps - 1234);
  EXPECT_EQ(allWords(second), expected());
  EXPECT_EQ(second.system().rebuilds, [&] {
    advance(first, kSteps - 1234);
    return first.system().rebuilds;
  }());
}

TEST(GrainsOnRanks, LedgerIsThatOfOneRank) {
  const GrainModel m = gravel();
  Grains alone(base::cpuExec(1), m, box(m), thrownBlock()),
      grains(base::cpuExec(1), m, box(m), thrownBlock(), shared());
  advance(alone, 700), advance(grains, 700);
  const GrainLedger a = alone.ledger(), b = grains.ledger();
  EXPECT_EQ(a.kinetic, b.kinetic);
  EXPECT_EQ(a.rotational, b.rotational);
  EXPECT_EQ(a.potential, b.potential);
  EXPECT_EQ(a.elastic, b.elastic);
  EXPECT_EQ(a.dissipated(), b.dissipated());
  EXPECT_EQ(a.work, b.work);
  EXPECT_EQ(a.turnover, b.turnover);
  EXPECT_EQ(a.momentum, b.momentum);
  EXPECT_EQ(a.impulse, b.impulse);
  EXPECT_EQ(a.angularImpulse, b.angularImpulse);
  EXPECT_EQ(a.contacts, b.contacts);
  EXPECT_EQ(a.boundaryContacts, b.boundaryContacts);
  EXPECT_EQ(a.deepestOverlap, b.deepestOverlap);
  EXPECT_EQ(a.fastest, b.fastest);
}

TEST(GrainsOnRanks, TopsOfTheBedAreThoseOfOneRankAfterAnyStep) {
  const GrainModel m = gravel();
  const NodeGrid grid{40, 30, 0.02, 0.02, 0, 0};
  Grains alone(base::cpuExec(1), m, box(m), thrownBlock()),
      grains(base::cpuExec(1), m, box(m), thrownBlock(), shared());
  for (int k = 0; k < 40; ++k) {
    advance(alone, 10), advance(grains, 10);
    ASSERT_EQ(highestTops(base::cpuExec(1), grains, grid, m.radius),
              highestTops(base::cpuExec(1), alone, grid, m.radius))
        << "step " << alone.steps();
  }
}

TEST(GrainsOnRanks, RolesAreAsDefined) {
  const GrainModel m = gravel();
  Grains grains(base::cpuExec(1), m, box(m), thrownBlock(), shared());
  if (!grains.distribution()) GTEST_SKIP() << "one rank has no roles: see OneRank";
  grains.refreshNeighbours();
  const Subdomain& s = grains.distribution()->subdomain();
  EXPECT_EQ(s.uniques().size() + s.masters().size() + s.ghosts(), grains.view().count);
  // Every grain has one owner; every owned grain within reach of another rank's grain is a master.
  EXPECT_EQ(grains.system().comm.sumOf(static_cast<std::int64_t>(s.uniques().size() + s.masters().size())), 360);
  const double range = 2.3 * m.radius + 1e-6;
  const auto positions = base::toHost(base::cpuExec(1), grains.view().position, grains.view().count);
  const std::vector<std::uint32_t> ids = base::toHost(base::cpuExec(1), grains.view().id, grains.view().count);
  const contact::PartitionView lattice = s.partition().view();
  const auto start = thrownBlock();
  for (std::size_t i = 0; i < grains.view().count; ++i) {
    const base::Vec3l u = base::toUnits(positions[i]);
    const bool slave = grains.view().ghost[i] != 0;
    EXPECT_EQ(lattice.ownerOf(u) != grains.system().comm.rank(), slave);
    if (slave) continue;
    bool needed = false; // another rank's grain within range
    for (const GrainSpec& other : start) {
      const int owner = lattice.ownerOf(base::toUnits(grains.scale().fromMetres(other.position)));
      needed = needed || (owner != grains.system().comm.rank() &&
                          norm(other.position - grains.scale().toMetres(positions[i])) < range);
    }
    const bool master = std::find(s.masters().data(), s.masters().data() + s.masters().size(),
                                  static_cast<std::uint32_t>(i)) != s.masters().data() + s.masters().size();
    if (needed) {
      EXPECT_TRUE(master) << "grain " << ids[i];
    }
  }
}

TEST(GrainsOnRanks, AFaultNamesTheGrainOnAllRanks) {
  const GrainModel m = gravel();
  std::vector<GrainSpec> start = thrownBlock();
  start[200].velocity = {900, 0, 0}; // beyond half the skin in one step
  Grains grains(base::cpuExec(1), m, box(m), start, shared());
  try {
    advance(grains, 1);
    FAIL() << "no rank reported an error";
  } catch (const base::SimulationError& error) {
    EXPECT_NE(std::string(error.what()).find("grain 200 at"), std::string::npos) << error.what();
    EXPECT_EQ(std::string(error.what()).find("e+300"), std::string::npos) << error.what();
  }
}

TEST(OneRank, HasNoGhostsNoRolesAndNoMessages) {
  const GrainModel m = gravel();
  Grains grains(base::cpuExec(1), m, box(m), thrownBlock());
  advance(grains, 10);
  EXPECT_EQ(grains.distribution(), nullptr);
  EXPECT_EQ(grains.view().ghost, nullptr);
  EXPECT_EQ(grains.view().count, grains.count());
  EXPECT_EQ(grains.system().comm.waited(), 0.0);
}

} // namespace
} // namespace grouser::terrain::testing
