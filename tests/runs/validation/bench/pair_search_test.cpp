// SPDX-License-Identifier: BSD-3-Clause
#include "base/random.hpp"
#include "runs/validation/bench/pair_kernels.cuh"
#include "runs/validation/bench/pair_search.hpp"
#include "tests/device_under_test.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace grouser::bench {
namespace {

using base::Position;
using Pairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

constexpr std::int64_t kDiameter = 150'000'001;

/// Uniform random spheres in a box with these edges [diameters] about a centre.
std::vector<Position> randomSpheres(std::uint64_t seed, int count, const base::Vec3d& box,
                                    const base::Vec3d& middle = {}) {
  std::vector<Position> spheres;
  for (int i = 0; i < count; ++i) {
    base::Vec3l u;
    for (int k = 0; k < 3; ++k) {
      const double x = base::uniform(seed, base::purpose("test.pairs"), static_cast<std::uint64_t>(i),
                                     static_cast<std::uint64_t>(k));
      u[k] = static_cast<std::int64_t>(((x - 0.5) * box[k] + middle[k]) * double(kDiameter));
    }
    spheres.push_back(base::fromUnits(u));
  }
  return spheres;
}

Pairs bruteForce(const std::vector<Position>& spheres) {
  Pairs pairs;
  for (std::uint32_t i = 0; i < spheres.size(); ++i)
    for (std::uint32_t j = i + 1; j < spheres.size(); ++j) {
      const base::Vec3d d = (base::toUnits(spheres[j]) - base::toUnits(spheres[i])).as<double>();
      const auto apart = base::toUnits(spheres[j]) - base::toUnits(spheres[i]);
      if (norm(d) < 2.0 * double(kDiameter) && // the exact square below requires small differences
          apart.x * apart.x + apart.y * apart.y + apart.z * apart.z < kDiameter * kDiameter)
        pairs.emplace_back(i, j);
    }
  return pairs;
}

struct Search {
  Pairs pairs;
  std::int64_t count = 0;
  int slabs = 0;
};

Search search(const std::vector<Position>& spheres, const PairSearchOptions& options = {}, int threads = 1) {
  const base::Exec exec = testExec(threads);
  const base::Array<Position> onDevice(exec, spheres);
  const FoundPairs found = PairSearch(exec, kDiameter).find(onDevice.data(), spheres.size(), options);
  Search s;
  s.count = found.count, s.slabs = found.slabs;
  for (const base::Array<IdPair>& part : found.pairs)
    for (const IdPair& p : part.toHost()) s.pairs.emplace_back(p.first, p.second);
  return s;
}

Pairs sorted(Pairs pairs) {
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

TEST(PairSearch, FindsWhatBruteForceFindsEachPairOnce) {
  const struct {
    int count;
    base::Vec3d box, middle;
  } beds[] = {{1500, {9, 9, 9}, {}},                  // dense: up to dozens of neighbours
              {1500, {14, 14, 14}, {-300, 20, 7000}}, // about six
              {2000, {200, 3, 1}, {}},                // a rod
              {2000, {1, 1, 300}, {5, -5, 0}},        // a rod across the direction of the slabs
              {800, {0.5, 0.5, 0.5}, {}},             // all in one heap
              {500, {500, 500, 500}, {}},             // hardly any neighbours
              {2, {0.5, 0.5, 0.5}, {}},
              {1, {1, 1, 1}, {}}};
  for (const auto& bed : beds) {
    const std::vector<Position> spheres = randomSpheres(5, bed.count, bed.box, bed.middle);
    const Search s = search(spheres);
    EXPECT_EQ(s.count, static_cast<std::int64_t>(s.pairs.size()));
    EXPECT_EQ(sorted(s.pairs), bruteForce(spheres)) << bed.count << " spheres in a box of " << bed.box.x;
  }
}

TEST(PairSearch, NoSpheresNoPairs) { EXPECT_EQ(search({}).count, 0); }

TEST(PairSearch, SlabsChangeNeitherPairsNorMakeThemTwice) {
  const std::vector<Position> spheres = randomSpheres(7, 4000, {18, 18, 18});
  const Pairs all = sorted(search(spheres).pairs);
  ASSERT_GT(all.size(), 4000u);
  for (const std::size_t atATime : {4000u, 2000u, 700u, 100u, 1u}) {
    PairSearchOptions options;
    options.atATime = atATime;
    const Search s = search(spheres, options);
    EXPECT_EQ(sorted(s.pairs), all) << atATime << " at a time";
    EXPECT_EQ(s.slabs > 1, atATime < 4000);
    options.store = false;
    const Search counted = search(spheres, options);
    EXPECT_EQ(counted.count, static_cast<std::int64_t>(all.size()));
    EXPECT_TRUE(counted.pairs.empty());
  }
}

TEST(PairSearch, SharesTogetherFindEveryPairOnce) {
  const std::vector<Position> spheres = randomSpheres(11, 3000, {15, 15, 15});
  const Pairs all = bruteForce(spheres);
  for (const int of : {2, 3, 8}) {
    Pairs together;
    for (int share = 0; share < of; ++share) {
      PairSearchOptions options;
      options.share = share, options.of = of;
      const Search s = search(spheres, options);
      // Cell layers are not split: of 16 layers, half are 8, a third 5 or 6, but an eighth may be 1 to 3.
      EXPECT_NEAR(double(s.pairs.size()) * of / double(all.size()), 1, of < 8 ? 0.3 : 0.6)
          << "share " << share << " of " << of;
      together.insert(together.end(), s.pairs.begin(), s.pairs.end());
    }
    EXPECT_EQ(sorted(together), all) << of << " shares";
  }
}

TEST(PairSearch, OrderOfThePairsDoesNotDependOnThreads) {
  const std::vector<Position> spheres = randomSpheres(13, 5000, {20, 20, 20});
  EXPECT_EQ(search(spheres, {}, 1).pairs, search(spheres, {}, 3).pairs);
}

TEST(PairSearch, TouchingIsExactToTheUnit) {
  // Along an axis and along a diagonal of integer length: 3-4-0 times 30,000,001 is 150,000,005.
  const auto count = [](const base::Vec3l& apart) {
    return search({base::fromUnits({7, -9, 11}), base::fromUnits(base::Vec3l{7, -9, 11} + apart)}).count;
  };
  EXPECT_EQ(count({kDiameter - 1, 0, 0}), 1);
  EXPECT_EQ(count({kDiameter, 0, 0}), 0);
  EXPECT_EQ(count({0, 0, -kDiameter + 1}), 1);
  EXPECT_EQ(count({90'000'000, -120'000'000, 0}), 1);
  EXPECT_EQ(count({90'000'003, 120'000'004, 0}), 0);
}

TEST(PairSearch, FarStraysCostNoMemoryAndHideNoPair) {
  std::vector<Position> spheres = randomSpheres(17, 1000, {10, 10, 10});
  constexpr std::int64_t kFar = (std::int64_t{1} << 41) - 1;
  spheres.push_back(base::fromUnits({kFar, kFar, kFar}));
  spheres.push_back(base::fromUnits({-kFar, -kFar, kFar}));
  spheres.push_back(base::fromUnits({kFar, kFar - 5, kFar}));
  // Their low words are equal, and they share the wide cells caused by the distant spheres.
  spheres.push_back(base::fromUnits({12345, 0, 0}));
  spheres.push_back(base::fromUnits({12345 + (std::int64_t{1} << 32), 0, 0}));
  EXPECT_EQ(sorted(search(spheres).pairs), bruteForce(spheres));
  const base::Exec exec = testExec();
  const base::Array<Position> onDevice(exec, spheres);
  EXPECT_LT(PairSearch(exec, kDiameter).find(onDevice.data(), spheres.size(), {}).workBytes, 20'000'000u);
}

TEST(PairSearch, SecondSearchForgetsTheFirst) {
  const base::Exec exec = testExec();
  const std::vector<Position> many = randomSpheres(19, 3000, {15, 15, 15}), few = randomSpheres(23, 300, {6, 6, 6});
  PairSearch search(exec, kDiameter);
  const base::Array<Position> a(exec, many), b(exec, few);
  const std::int64_t first = search.find(a.data(), many.size(), {}).count;
  EXPECT_EQ(search.find(b.data(), few.size(), {}).count, static_cast<std::int64_t>(bruteForce(few).size()));
  EXPECT_EQ(search.find(a.data(), many.size(), {}).count, first);
}

TEST(PairSearch, CellsAreExactAtTheirEdges) {
  for (const std::int64_t edge :
       {std::int64_t{1}, std::int64_t{3}, kDiameter, std::int64_t{1} << 28, std::int64_t{7} << 36}) {
    const detail::Divider divide(edge);
    const std::uint64_t e = static_cast<std::uint64_t>(edge), most = (std::uint64_t{1} << 42) - 1;
    for (std::uint64_t k = 0; k < 2000; ++k) {
      const std::uint64_t random = base::hash(1, base::purpose("test.divider"), k) & most;
      for (const std::uint64_t u : {random, random / e * e, random / e * e + e - 1, most - k})
        if (u <= most && u / e <= 0xFFFFFFFFu) {
          ASSERT_EQ(divide(u), u / e) << u << " / " << e;
        }
    }
  }
}

TEST(PairSearch, WrongSizesAreRefused) {
  EXPECT_THROW(PairSearch(base::cpuExec(1), 0), std::invalid_argument);
  EXPECT_THROW(PairSearch(base::cpuExec(1), std::int64_t{1} << 29), std::invalid_argument);
  PairSearch search(base::cpuExec(1), kDiameter);
  EXPECT_THROW(search.find(nullptr, std::size_t{1} << 31, {}), std::invalid_argument);
}

} // namespace
} // namespace grouser::bench
