// SPDX-License-Identifier: BSD-3-Clause
// Identical results: threads, rebuild intervals and shifts by whole units do not change a bit.
#include "grain_fixture.hpp"
#include "tests/device_under_test.hpp"

#include <gtest/gtest.h>

namespace grouser::terrain::testing {
namespace {

std::vector<std::uint32_t> runHeap(int threads, double skin, base::Vec3d shift = {}) {
  const GrainModel m = gravel(skin);
  const double offset = shift.z;
  Grains grains(testExec(threads), m, {{{{0, 0, 1}, offset, m.law}, {{1, 0, 0}, shift.x - 0.05, m.law}}, {}},
                gravelBlock(7, 7, 6, {0.3, 0.1, -1}, {}, shift));
  advance(grains, 3000);
  return grains.state().words();
}

TEST(Heap, SameBitsForThreadsAndRebuildIntervals) {
  const auto reference = runHeap(1, 0.3);
  EXPECT_EQ(reference, runHeap(2, 0.3));
  EXPECT_EQ(reference, runHeap(1, 0.8));
  EXPECT_EQ(reference, runHeap(2, 0.1));
}

TEST(Heap, SameBitsForAnyNumberOfThreads) {
  // Four blocks of grains, so that threads share the remaining work.
  const auto run = [](int threads) {
    const GrainModel m = gravel(0.3);
    Grains grains(testExec(threads), m, {{{{0, 0, 1}, 0, m.law}, {{1, 0, 0}, -0.05, m.law}}, {}},
                  gravelBlock(12, 12, 7, {0.3, 0.1, -1}, {}, {}));
    advance(grains, 1000);
    return std::make_pair(grains.state().words(), grains.ledger().elastic);
  };
  const auto reference = run(1);
  for (const int threads : {2, 3, 8}) EXPECT_EQ(run(threads), reference) << threads << " threads";
}

TEST(Heap, MovesAlikeWhereverItStands) {
  // Shifts by whole position units, hundreds of metres: all except the positions is bitwise identical.
  const double unit = base::positionScale(0.054).unit;
  const auto whole = [unit](double metres) { return std::floor(metres / unit) * unit; };
  const std::vector<std::uint32_t> here = runHeap(1, 0.3),
                                   there = runHeap(1, 0.3, {whole(312.7), whole(-245.1), whole(77.3)});
  ASSERT_EQ(here.size(), there.size());
  std::size_t differing = 0;
  for (std::size_t k = 0; k < here.size(); ++k) differing += here[k] != there[k];
  EXPECT_LE(differing, 4u * 294) << "more than the four words of each position";
  EXPECT_GT(differing, 3u * 294);
}

TEST(Heap, NeighbourListLosesNoContact) {
  // Compared with a brute-force search over all pairs.
  const GrainModel m = gravel();
  std::vector<GrainSpec> start;
  for (int i = 0; i < 300; ++i) start.push_back({{0.05 * (i % 7), 0.05 * (i / 7 % 7), 0.05 * (i / 49)}, {}, {}});
  Grains grains(testExec(2), m, {}, start);
  const GrainLedger ledger = grains.ledger();
  std::int64_t pairs = 0;
  for (int i = 0; i < 300; ++i)
    for (int j = i + 1; j < 300; ++j)
      pairs += norm(start[static_cast<std::size_t>(i)].position - start[static_cast<std::size_t>(j)].position) < 0.054;
  EXPECT_EQ(ledger.contacts, pairs);
}

TEST(Heap, PairForcesBalanceToTheLastBit) {
  // No gravity, no walls: total momentum is constant, up to the quantum of the remainders.
  GrainModel m = gravel();
  m.gravity = {};
  std::vector<GrainSpec> start;
  for (int i = 0; i < 64; ++i) start.push_back({{0.053 * (i % 4), 0.053 * (i / 4 % 4), 0.053 * (i / 16)}, {}, {}});
  Grains grains(testExec(1), m, {}, start);
  advance(grains, 2000);
  const GrainLedger ledger = grains.ledger();
  EXPECT_GT(ledger.kinetic, 1e-3) << "the cluster has burst apart";
  // Velocities are floats: 64 grains, each with a resolution of half an ulp of about 1e-8 m/s.
  EXPECT_LT(norm(ledger.momentum), 64 * m.mass * 6e-8);
}

} // namespace
} // namespace grouser::terrain::testing
