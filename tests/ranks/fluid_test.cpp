// SPDX-License-Identifier: BSD-3-Clause
// Fluid on any number of ranks: bitwise equal states, loads, probes and totals.
#include "base/error.hpp"
#include "tests/fluid/water.hpp"
#include "tests/ranks/ranks.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace grouser::fluid {
namespace {

using base::Vec3d;

/// Results accessible to callers.
struct Seen {
  std::uint64_t hash;
  base::Vec3l balance;
  std::vector<Vec3d> loads;
  std::vector<double> numbers;
};

void expectSame(const Seen& a, const Seen& b) {
  EXPECT_EQ(a.hash, b.hash);
  EXPECT_EQ(a.balance, b.balance);
  EXPECT_EQ(a.loads, b.loads);
  EXPECT_EQ(a.numbers, b.numbers);
}

Seen seen(Fluid& fluid) {
  Seen s{fluid.hash(), fluid.forceBalance(), {}, {}};
  for (const BodyLoad& l : fluid.bodyLoads()) s.loads.push_back(l.force), s.loads.push_back(l.torque);
  const FluidTotals t = fluid.totals();
  s.loads.insert(s.loads.end(), {t.momentum, t.wallForce});
  s.numbers = {t.kinetic, t.potential, t.internal, t.viscousLoss, t.diffusionLoss, t.wallLoss, t.fastest};
  const std::vector<Vec3d> places{{0.1, 0.2, 0.1}, {0.5, 0.3, 0.3}};
  for (const auto& values : {fluid.pressuresAt(places), fluid.levelsAt(places, 0.9)})
    s.numbers.insert(s.numbers.end(), values.begin(), values.end());
  return s;
}

/// A rotating cube, towed through the water surface.
std::vector<BodyMotion> drawn(const FluidSetup& s, int step) {
  BodyMotion m = s.bodies[0].start;
  const double t = (step + 1) * s.model.timeStep, turn = 0.3 + 2 * t;
  m.velocity = {0.5, 0, 0.4}, m.spin = {0, 0, 2};
  m.pose.position += t * m.velocity;
  m.pose.orientation = {std::cos(turn / 2), 0, 0, std::sin(turn / 2)};
  return {m};
}

Fluid made(const FluidSetup& s, const contact::PartitionOptions& ranks) {
  return Fluid(s, testExec(1, test::comm().rank()), ranks);
}

TEST(FluidOnRanks, HasTheBitsOfOneRank) {
  FluidSetup s = cubeInWater(0.3);
  s.model.shifting = 1, s.surfaceDivergence = 2.75, s.model.viscosity = 0.5;
  Fluid alone = made(s, {}), shared = made(s, {test::comm(), {}, {}, true});
  expectSame(seen(shared), seen(alone));
  for (int k = 0; k < 60; ++k) alone.step(drawn(s, k)), shared.step(drawn(s, k));
  expectSame(seen(shared), seen(alone));
  EXPECT_EQ(alone.forceBalance(), base::Vec3l{});
  EXPECT_EQ(shared.rebuilds(), alone.rebuilds());
  EXPECT_EQ(shared.bytesSent() > 0, !test::comm().alone());
}

/// Particles cross subdomain borders, which follow them, starting from a state of one rank.
TEST(FluidOnRanks, ADamBreakMovesFromRankToRank) {
  const FluidSetup s = damBreak();
  Fluid alone = made(s, {}), shared = made(s, {test::comm(), {test::comm().size(), 1, 1}, {}, true});
  for (int k = 0; k < 400; ++k) alone.step(), shared.step();
  expectSame(seen(shared), seen(alone));
  Fluid resumed(s, alone.save(), testExec(1, test::comm().rank()), {test::comm(), {}, {}, false});
  EXPECT_EQ(resumed.hash(), alone.hash());
  for (int k = 0; k < 100; ++k) alone.step(), shared.step(), resumed.step();
  EXPECT_EQ(shared.hash(), alone.hash());
  EXPECT_EQ(resumed.hash(), alone.hash());
  EXPECT_EQ(resumed.totals().total(), alone.totals().total());
}

/// An error on one rank stops all with one message.
TEST(FluidOnRanks, AFaultStopsAllRanks) {
  FluidSetup s = damBreak();
  s.particles.front().velocity = {0, 0, -0.9 * s.model.soundSpeed};
  const auto message = [&s](const contact::PartitionOptions& ranks) -> std::string {
    try {
      Fluid fluid = made(s, ranks);
      for (int k = 0; k < 100; ++k) fluid.step();
      return "";
    } catch (const base::SimulationError& e) {
      return e.what();
    }
  };
  EXPECT_EQ(message({test::comm(), {}, {}, true}), message({}));
  EXPECT_NE(message({}), "");
}

} // namespace
} // namespace grouser::fluid
