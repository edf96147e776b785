// SPDX-License-Identifier: BSD-3-Clause
#include "contact/partition.hpp"

#include "base/error.hpp"

#include <gtest/gtest.h>

namespace grouser::contact {
namespace {

std::array<std::vector<std::int64_t>, 3> evenWeights() {
  const std::vector<std::int64_t> even(kPartitionBins, 10);
  return {even, even, even};
}

TEST(Partition, EveryPlaceHasOneOwner) {
  const Partition p({3, 2, 2}, {0, 0, 0}, {120000, 80000, 40000}, evenWeights());
  const PartitionView v = p.view();
  EXPECT_EQ(p.count(), 12);
  std::vector<int> seen(12);
  for (std::int64_t x = -50000; x <= 200000; x += 5000)
    for (std::int64_t y = -50000; y <= 200000; y += 5000)
      for (std::int64_t z = -50000; z <= 200000; z += 5000) {
        const int owner = v.ownerOf({x, y, z});
        ASSERT_TRUE(owner >= 0 && owner < 12);
        ++seen[static_cast<std::size_t>(owner)];
      }
  for (const int n : seen) EXPECT_GT(n, 0);
  // A cut belongs to the upper side.
  const std::int64_t cut = p.cuts(0)[0];
  EXPECT_EQ(v.along(0, cut - 1), 0);
  EXPECT_EQ(v.along(0, cut), 1);
}

TEST(Partition, EvenWeightIsCutIntoEqualSlabs) {
  const Partition p({4, 1, 1}, {0, 0, 0}, {4000000, 10, 10}, evenWeights());
  for (int k = 0; k < 3; ++k) // bins are whole units wide, each up to one unit too wide
    EXPECT_NEAR(static_cast<double>(p.cuts(0)[static_cast<std::size_t>(k)]), 1e6 * (k + 1), kPartitionBins);
}

TEST(Partition, CutsMoveTowardsTheWork) {
  auto weights = evenWeights();
  for (std::size_t b = 0; b < kPartitionBins / 10; ++b)
    weights[0][b] *= 9; // a tenth of the length has half of the work
  const Partition p({2, 1, 1}, {0, 0, 0}, {4096000, 10, 10}, weights);
  EXPECT_NEAR(static_cast<double>(p.cuts(0)[0]), 409600, kPartitionBins);
}

TEST(Partition, CutsNeverFallTogether) {
  std::vector<std::int64_t> one(kPartitionBins, 0);
  one[7] = 1;
  const Partition p({8, 1, 1}, {0, 0, 0}, {4096000, 10, 10}, {one, one, one});
  for (std::size_t k = 1; k < p.cuts(0).size(); ++k) EXPECT_LT(p.cuts(0)[k - 1], p.cuts(0)[k]);
}

TEST(Lattice, CutsTheLongSidesFirst) {
  EXPECT_EQ(latticeShape(8, {4, 2, 1}), (std::array<int, 3>{4, 2, 1}));
  EXPECT_EQ(latticeShape(2, {1, 9, 1}), (std::array<int, 3>{1, 2, 1}));
  const std::array<int, 3> seven = latticeShape(7, {5, 6, 1}); // a prime: slabs across the longest side
  EXPECT_EQ(seven, (std::array<int, 3>{1, 7, 1}));
  EXPECT_EQ(latticeShape(8, {1, 1, 1}), (std::array<int, 3>{2, 2, 2}));
}

TEST(Lattice, KeepsTheShapeThatIsAskedFor) {
  EXPECT_EQ(latticeShape(6, {10, 1, 1}, {1, 0, 2}), (std::array<int, 3>{1, 3, 2}));
  EXPECT_THROW(latticeShape(6, {1, 1, 1}, {4, 0, 0}), base::InputError);
  EXPECT_THROW(latticeShape(6, {1, 1, 1}, {2, 2, 2}), base::InputError);
}

} // namespace
} // namespace grouser::contact
