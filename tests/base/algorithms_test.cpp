// SPDX-License-Identifier: BSD-3-Clause
// Sort, scan, maximum and lists: equal to the standard library's serial results, for any number of threads.
#include "base/algorithms.hpp"

#include "base/random.hpp"
#include "tests/device_under_test.hpp"

#include <algorithm>
#include <gtest/gtest.h>
#include <numeric>

namespace grouser::base {
namespace {

constexpr std::size_t kSizes[] = {0, 1, 2, 255, 2047, 2048, 2049, 30000};

std::vector<std::uint32_t> numbers(std::size_t count, double below) {
  std::vector<std::uint32_t> some(count);
  for (std::size_t i = 0; i < count; ++i) some[i] = static_cast<std::uint32_t>(below * uniform(1, 2, i, 3));
  return some;
}

TEST(Algorithms, SortIsStableForAnyKeysAndThreads) {
  for (const int threads : {1, 2, 3, 8})
    for (const std::size_t count : kSizes)
      for (const double below : {1.0, 5.0, 256.0, 70000.0, 1e15}) {
        const Exec exec = testExec(threads);
        std::vector<std::uint64_t> keys(count);
        for (std::size_t i = 0; i < count; ++i) keys[i] = static_cast<std::uint64_t>(below * uniform(4, 5, i, 6));
        std::vector<std::uint32_t> order(count);
        std::iota(order.begin(), order.end(), 0u);
        Array<std::uint64_t> sortedKeys(exec, keys);
        Array<std::uint32_t> sorted(exec, order);
        sortByKey(exec, sortedKeys.data(), sorted.data(), count);
        std::stable_sort(order.begin(), order.end(),
                         [&](std::uint32_t a, std::uint32_t b) { return keys[a] < keys[b]; });
        EXPECT_EQ(sorted.toHost(), order) << count << " keys below " << below << ", " << threads << " threads";
        std::sort(keys.begin(), keys.end());
        EXPECT_EQ(sortedKeys.toHost(), keys);
      }
}

TEST(Algorithms, SumGoesBeyond32Bits) {
  const Exec exec = testExec(2);
  const Array<std::uint32_t> in(exec, std::vector<std::uint32_t>(5000, 4'000'000'000u));
  EXPECT_EQ(sum(exec, in.data(), in.size()), 20'000'000'000'000u);
}

TEST(Algorithms, ScanMaximumListsAndNumbers) {
  for (const int threads : {1, 2, 3, 8})
    for (const std::size_t count : kSizes) {
      const Exec exec = testExec(threads);
      const std::vector<std::uint32_t> some = numbers(count, 50);
      const Array<std::uint32_t> in(exec, some);
      std::vector<std::uint32_t> expected(count);
      std::exclusive_scan(some.begin(), some.end(), expected.begin(), 0u);
      Array<std::uint32_t> out(exec, count), inPlace(exec, some);
      const std::uint32_t total = std::accumulate(some.begin(), some.end(), 0u);
      EXPECT_EQ(exclusiveScan(exec, in.data(), out.data(), count), total);
      EXPECT_EQ(out.toHost(), expected);
      EXPECT_EQ(exclusiveScan(exec, inPlace.data(), inPlace.data(), count), total);
      EXPECT_EQ(inPlace.toHost(), expected);
      EXPECT_EQ(sum(exec, in.data(), count), total);
      EXPECT_EQ(maximum(exec, in.data(), count), count ? *std::max_element(some.begin(), some.end()) : 0u);
      const std::vector<std::uint32_t> marks = numbers(count, 2);
      Array<std::uint32_t> list(exec);
      listMarked(exec, Array<std::uint32_t>(exec, marks).data(), count, list);
      std::vector<std::uint32_t> marked;
      for (std::uint32_t i = 0; i < count; ++i)
        if (marks[i]) marked.push_back(i);
      EXPECT_EQ(list.toHost(), marked);
      std::iota(expected.begin(), expected.end(), 0u);
      iota(exec, out.data(), count);
      EXPECT_EQ(out.toHost(), expected);
    }
}

} // namespace
} // namespace grouser::base
