// SPDX-License-Identifier: BSD-3-Clause
// Springs of walls, floor and surfaces exist only for grains near them, and are kept when the lists are rebuilt.
#include "surface_fixture.hpp"

#include "base/memory_held.hpp"
#include "tests/device_under_test.hpp"

#include <gtest/gtest.h>

namespace grouser::terrain::testing {
namespace {

constexpr int kNumbers = 3; ///< numbers per spring of one boundary

std::size_t springsKept(const Grains& grains) { return grains.system().boundaries.springs().size(); }

/// Deeper in the floor than at rest.
GrainSpec sliding(const GrainModel& m, const Vec3d& place) {
  return {place + Vec3d{0, 0, 0.999 * m.radius}, {0.02, 0.01, 0}, {}};
}

TEST(BoundarySprings, GoAlongWhenAGrainBeforeThemEntersTheListBetweenRebuilds) {
  const GrainModel m = roughBall(1e-5, 0.5, 0.3);
  const auto far = placed({-1, 0, 0.5}), near = placed({-0.2, 0, 0.5 + 0.05 + m.radius + 1e-4});
  // The first grain is in the air where the box will arrive.
  GrainModel floating = m;
  floating.gravity = {0, 0, -1e-3};
  Grains grains(testExec(1), floating, {{floorPlane(m.law)}, {}, {}, {{boxOf({0.05, 0.05, 0.05}), m.law, far}}},
                {{{-0.2, 0, 0.5}, {}, {}}, sliding(m, {0, 0, 0})});
  advanceWith(
      grains, [&](std::int64_t) { return std::vector{far}; }, 0, 5);
  const GrainState before = grains.state();
  ASSERT_GT(norm(before.wallShear[2]), 0) << "second grain on the floor";
  ASSERT_EQ(grains.system().boundaries.grainsListed(), 1u);
  const std::int64_t listings = grains.system().boundaries.listings(), rebuilds = grains.system().rebuilds;
  grains.setSurfacePoses({near});
  grains.refreshNeighbours();
  EXPECT_EQ(grains.system().boundaries.listings(), listings + 1);
  EXPECT_EQ(grains.system().rebuilds, rebuilds);
  EXPECT_EQ(grains.system().boundaries.grainsListed(), 2u);
  EXPECT_EQ(grains.state().wallShear, before.wallShear);
  EXPECT_EQ(grains.state().words(), before.words());
  // The same after the box has left.
  grains.setSurfacePoses({far});
  grains.refreshNeighbours();
  EXPECT_EQ(grains.system().boundaries.grainsListed(), 1u);
  EXPECT_EQ(grains.state().wallShear, before.wallShear);
}

TEST(BoundarySprings, OfAGrainThatLeavesTheListAndComesBackAreNew) {
  const GrainModel m = roughBall(1e-5, 0.5, 0.1);
  const auto thrown = [&] {
    return std::vector<GrainSpec>{{{0, 0, 1.01 * m.radius}, {0.3, 0, -0.5}, {}}, sliding(m, {0.1, 0, 0})};
  };
  Grains grains(testExec(1), m, {{floorPlane(m.law)}, {}}, thrown());
  bool touched = false;
  while (!touched || grains.system().boundaries.grainsListed() > 1) {
    advance(grains, 1);
    touched = touched || norm(grains.state().wallShear[0]) > 0;
    ASSERT_LT(grains.steps(), 20000);
  }
  EXPECT_EQ(grains.state().wallBits[0], 0u);
  EXPECT_EQ(springsKept(grains), std::size_t{kNumbers}) << "only of the other grain";
  // The state holds no spring of a grain in the air.
  Grains fresh(testExec(1), m, {{floorPlane(m.law)}, {}}, thrown());
  fresh.restore(grains.state());
  while (grains.state().wallBits[0] == 0) {
    advance(grains, 1), advance(fresh, 1);
    ASSERT_LT(grains.steps(), 40000);
  }
  EXPECT_EQ(grains.state().words(), fresh.state().words());
  // The spring holds one step of sliding: 0.3 m/s at most, plus the spin.
  EXPECT_LT(norm(grains.state().wallShear[0]), 1.1 * 0.3 * m.timeStep + 1e-9);
  EXPECT_GT(norm(grains.state().wallShear[0]), 0);
}

TEST(BoundarySprings, AreKeptForGrainsOnTheListAlone) {
  const GrainModel m = gravel();
  // Each lies about 3 mm from the outermost grains.
  const std::vector<Wall> walls{floorPlane(m.law),
                                {{1, 0, 0}, -0.03, m.law},
                                {{-1, 0, 0}, -0.562, m.law},
                                {{0, 1, 0}, -0.041, m.law},
                                {{0, -1, 0}, -0.548, m.law}};
  const std::vector<GrainSpec> block = gravelBlock(10, 10, 10, {});
  Grains grains(testExec(1), m, {walls, {}}, block), free(testExec(1), m, {}, block);
  advance(grains, 300), advance(free, 1);
  grains.invalidateNeighbours();
  grains.refreshNeighbours();
  const std::size_t listed = grains.system().boundaries.grainsListed();
  EXPECT_GT(listed, 150u) << "a layer of 100 on the floor, and some grains at the walls";
  EXPECT_LT(listed, 500u);
  EXPECT_EQ(springsKept(grains), listed * 5 * kNumbers);
  // For every grain a mask and a place; for one on the list its slot, a load and five springs.
  EXPECT_EQ(grains.system().constants.layout().boundaries, 5);
  EXPECT_EQ(GrainFields(grains.system().constants.layout()).bytesPerGrain(),
            GrainFields(free.system().constants.layout()).bytesPerGrain() + 8);
  const std::size_t bytes = grains.system().boundaries.bytes(), each = 4 + sizeof(BoundaryLoad<float>) + 5 * 12;
  EXPECT_GE(bytes, listed * each);
  EXPECT_LT(bytes, 1.2 * static_cast<double>(listed * each)) << "lists that were longer keep their memory";
}

TEST(Rebuild, TakesNoMoreMemoryThanStandsBetweenRebuilds) {
  // A bed with few contacts: the ledger's temporary arrays fit into the memory freed meanwhile.
  const GrainModel m = gravel();
  const base::Exec exec = testExec(1);
  Grains grains(exec, m, {{floorPlane(m.law)}, {}}, gravelBlock(20, 20, 20, {}));
  advance(grains, 200);
  for (int k = 0; k < 2; ++k) { // lists may grow in the first pass
    base::restartMemoryPeak(exec);
    grains.invalidateNeighbours();
    grains.refreshNeighbours();
    base::synchronize(exec);
  }
  const base::MemoryHeld held = base::memoryHeld(exec); // before the ledger allocates
  ASSERT_LT(grains.ledger().contacts, 8000) << "at most two per grain";
  EXPECT_GE(held.now, grains.system().deviceBytes());
  EXPECT_LE(held.most, held.now + 4096) << "allocators round up";
}

TEST(Rebuild, KeepsWhatNeighboursReadAndWhatStepsWrite) {
  const GrainModel m = gravel();
  Grains grains(testExec(1), m, {{floorPlane(m.law)}, {}}, gravelBlock(3, 3, 3, {0.2, 0, 0}));
  advance(grains, 50);
  const GrainState before = grains.state();
  grains.invalidateNeighbours();
  grains.refreshNeighbours();
  EXPECT_EQ(grains.state().words(), before.words());
  const GrainFields& f = grains.system().arrays.fields();
  EXPECT_EQ(f.position.next.size(), 27u);
  EXPECT_EQ(f.motion.next.size(), 27u);
  EXPECT_EQ(f.reference.now.size(), 27u);
  for (const base::Vec3<std::uint32_t>& gone : grains.state().travelled) EXPECT_EQ(gone, base::Vec3<std::uint32_t>{});
}

} // namespace
} // namespace grouser::terrain::testing
