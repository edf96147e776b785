// SPDX-License-Identifier: BSD-3-Clause
// Removal of grains: the others keep their history and ids.
#include "grain_fixture.hpp"
#include "terrain/grain_removal.hpp"

#include <gtest/gtest.h>

namespace grouser::terrain::testing {
namespace {

TEST(GrainRemoval, IdsOfPlacesSkipThoseThatAreGone) {
  const std::vector<std::uint32_t> gone = {0, 3, 4, 9};
  EXPECT_EQ(idsFrom(gone, 0, 6), (std::vector<std::uint32_t>{1, 2, 5, 6, 7, 8}));
  EXPECT_EQ(idsFrom(gone, 4, 4), (std::vector<std::uint32_t>{7, 8, 10, 11}));
  for (const std::uint32_t id : {1u, 2u, 5u, 8u, 10u, 11u})
    EXPECT_EQ(idsFrom(gone, placeAmong(gone, id), 1).front(), id);
}

TEST(GrainRemoval, OfAGrainThatTouchesNothingChangesNoBitOfTheOthers) {
  // The last one is isolated in the air; the block falls and slides.
  const auto run = [](bool remove) {
    std::vector<GrainSpec> start = gravelBlock(4, 3, 3, {0.3, 0.1, -0.4});
    const auto apart = static_cast<std::uint32_t>(start.size() / 2);
    start.insert(start.begin() + apart, GrainSpec{{5, 5, 3}, {}, {}});
    const GrainModel m = gravel();
    Grains grains(base::cpuExec(1), m, {{floorPlane(m.law)}, {}}, start);
    advance(grains, 700);
    if (remove) {
      EXPECT_NEAR(removeGrains(grains, {apart}), m.mass, 1e-12);
      EXPECT_EQ(grains.count(), start.size() - 1);
    }
    advance(grains, 700);
    GrainState s = grains.state();
    if (!remove) s.remove({apart});
    EXPECT_EQ(s.gone, std::vector{apart});
    EXPECT_EQ(s.id.back(), start.size() - 1);
    s.ledgerSums.clear();
    return s.words();
  };
  EXPECT_EQ(run(true), run(false));
}

TEST(GrainRemoval, TakesTheContactsOfOthersWithIt) {
  std::vector<GrainSpec> start;
  const GrainModel m = gravel();
  for (int k = 0; k < 3; ++k) start.push_back({{1.99 * m.radius * k, 0, 1}, {}, {}});
  Grains grains(base::cpuExec(1), m, {}, start);
  advance(grains, 1);
  EXPECT_EQ(grains.state().contacts, (std::vector<std::uint32_t>{1, 2, 1}));
  removeGrains(grains, {1});
  EXPECT_EQ(grains.state().contacts, (std::vector<std::uint32_t>{0, 0}));
  const GrainSnapshot left = grains.snapshot();
  EXPECT_EQ(left.id, (std::vector<std::uint32_t>{0, 2}));
  EXPECT_EQ(left.total, 2u);
  const double before = static_cast<double>(left.velocity[0].x);
  advance(grains, 10);
  EXPECT_EQ(static_cast<double>(grains.snapshot().velocity[0].x), before) << "no load remains";
  // New grains get new ids.
  grains.add({{{1, 1, 1}, {}, {}}});
  EXPECT_EQ(grains.snapshot().id, (std::vector<std::uint32_t>{0, 2, 3}));
}

} // namespace
} // namespace grouser::terrain::testing
