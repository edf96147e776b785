// SPDX-License-Identifier: BSD-3-Clause
// Work that is recorded once and started again, and work beside it.
#include "base/array.hpp"
#include "base/device_graph.hpp"
#include "base/for_each.cuh"
#include "tests/device_under_test.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

namespace grouser::base {
namespace {

struct Add {
  int amount;
  int* values;
  GROUSER_HD void operator()(int i) const { values[i] += amount; }
};
struct Sum {
  const int *a, *b;
  int* out;
  GROUSER_HD void operator()(int i) const { out[i] = a[i] + b[i]; }
};

constexpr int kCount = 1000;

void add(const Exec& exec, Array<int>& values, int amount) { forEach(exec, "add", kCount, Add{amount, values.data()}); }

TEST(DeviceGraph, EveryRunDoesTheWorkOnce) {
  const Exec exec = testExec(2);
  Array<int> values(exec, kCount);
  DeviceGraph graph(exec);
  for (int k = 1; k <= 5; ++k) {
    graph.run([&] { add(exec, values, 3), add(exec, values, 4); });
    EXPECT_EQ(values.toHost(), std::vector<int>(kCount, 7 * k));
  }
}

TEST(DeviceGraph, ForgottenWorkIsRecordedAnew) {
  const Exec exec = testExec(2);
  Array<int> values(exec, kCount);
  DeviceGraph graph(exec);
  int amount = 1, asked = 0;
  const auto work = [&] { ++asked, add(exec, values, amount); };
  graph.run(work), graph.run(work);
  EXPECT_EQ(asked, exec.onCpu() ? 2 : 1) << "a device asks for the work only to record it";
  amount = 10;
  graph.forget();
  graph.run(work);
  EXPECT_EQ(values.toHost(), std::vector<int>(kCount, 12));
}

TEST(DeviceGraph, WorkThatThrowsLeavesNoRecord) {
  const Exec exec = testExec(2);
  Array<int> values(exec, kCount);
  DeviceGraph graph(exec);
  EXPECT_THROW(graph.run([] { throw std::runtime_error("no"); }), std::runtime_error);
  graph.run([&] { add(exec, values, 2); });
  EXPECT_EQ(values.toHost(), std::vector<int>(kCount, 2));
}

TEST(DoubleBufferedGraph, EachBufferHasItsOwnRecord) {
  const Exec exec = testExec(2);
  Array<int> one(exec, kCount), other(exec, kCount);
  DoubleBufferedGraph graph(exec);
  for (int k = 0; k < 6; ++k) {
    Array<int>& now = k % 2 ? other : one;
    graph.from(now.data()).run([&] { add(exec, now, k % 2 ? 10 : 1); });
  }
  EXPECT_EQ(one.toHost(), std::vector<int>(kCount, 3));
  EXPECT_EQ(other.toHost(), std::vector<int>(kCount, 30));
  EXPECT_NE(&graph.from(one.data()), &graph.from(other.data()));
  EXPECT_EQ(&graph.from(one.data()), &graph.from(one.data()));
}

TEST(DoubleBufferedGraph, AThirdBufferTakesAFormerOnesPlace) {
  const Exec exec = testExec(2);
  Array<int> arrays[] = {Array<int>(exec, kCount), Array<int>(exec, kCount), Array<int>(exec, kCount)};
  DoubleBufferedGraph graph(exec);
  for (int round = 0; round < 2; ++round)
    for (Array<int>& now : arrays) graph.from(now.data()).run([&] { add(exec, now, 1); });
  for (const Array<int>& now : arrays) EXPECT_EQ(now.toHost(), std::vector<int>(kCount, 2));
}

TEST(SideStream, WhatIsJoinedHasEnded) {
  const Exec exec = testExec(2);
  SideStream side(exec);
  Array<int> a(exec, kCount), b(exec, kCount), sum(exec, kCount);
  DeviceGraph graph(exec);
  for (int k = 1; k <= 20; ++k) {
    graph.run([&] {
      add(exec, a, 1);
      side.fork();
      add(side.exec(), b, 2);
      add(exec, a, 4);
      side.join();
      forEach(exec, "sum", kCount, Sum{a.data(), b.data(), sum.data()});
    });
    EXPECT_EQ(sum.toHost(), std::vector<int>(kCount, 7 * k));
  }
}

} // namespace
} // namespace grouser::base
