// SPDX-License-Identifier: BSD-3-Clause
// Work launched before its data are available.
#include "base/gate.hpp"
#include "tests/device_under_test.hpp"

#include <gtest/gtest.h>

#include <array>

namespace grouser::base {
namespace {

constexpr Watch kNothing{};

/// Numbers that pass to the device behind the gate, and return.
struct There {
  explicit There(const Exec& e) : exec(e), gate(e), sent(e, 1500), back(e, 1500), cleared(e, 1) {}
  void launch(const Watch& watch = kNothing) {
    gate.carryBefore(exec, watch, std::array{Parcel{cleared.device().data(), nullptr, 8}});
    gate.pass(exec, watch, std::array{Parcel{sent.device().data(), sent.host(), sent.bytes()}});
    gate.signal(exec, Gate::kFirst, std::array{Parcel{back.host(), sent.device().data(), back.bytes()}});
    gate.signal(exec, Gate::kSecond, {});
  }
  void write(double value) {
    for (std::size_t i = 0; i < sent.size(); ++i) sent.host()[i] = value + static_cast<double>(i);
  }
  void expectBack(double value) {
    for (std::size_t i = 0; i < back.size(); ++i) ASSERT_EQ(back.host()[i], value + static_cast<double>(i));
  }
  Exec exec;
  Gate gate;
  Mirrored<double> sent, back;
  Mirrored<std::uint64_t> cleared;
};

TEST(Gate, LetsOneRunPassForEachOpening) {
  There t(testExec());
  for (int k = 0; k < 50; ++k) {
    t.write(1000.0 * k);
    t.launch();
    t.gate.open();
    t.gate.await(Gate::kFirst), t.gate.await(Gate::kSecond);
    t.expectBack(1000.0 * k);
  }
}

TEST(Gate, WorkLaunchedAheadSeesWhatIsWrittenBeforeTheOpeningOnCuda) {
  const Exec exec = testExec();
  if (exec.onCpu()) GTEST_SKIP() << "a CPU launches no work ahead";
  There t(exec);
  t.launch();
  for (int k = 0; k < 1000; ++k) {
    t.write(3.0 * k);
    t.gate.open();
    t.launch(); // waits, or has not started
    t.gate.await(Gate::kFirst);
    t.expectBack(3.0 * k);
    EXPECT_TRUE(isBusy(exec));
  }
  t.gate.callOff();
  t.expectBack(3.0 * 999); // a cancelled launch leaves no results
  t.write(7), t.launch(), t.gate.open();
  t.gate.await(Gate::kSecond);
  t.expectBack(7);
}

TEST(Gate, WhatIsWatchedCallsARunOffWithoutTheHostOnCuda) {
  const Exec exec = testExec();
  if (exec.onCpu()) GTEST_SKIP() << "a CPU launches no work ahead";
  There t(exec);
  const Array<std::uint64_t> flags(exec, std::vector<std::uint64_t>{5, 1});
  t.write(1), t.launch({flags.data(), {5, 1}}), t.gate.open(), t.gate.await(Gate::kSecond);
  t.expectBack(1);
  *t.cleared.host() = 9, t.cleared.upload();
  t.write(2), t.launch({flags.data(), {5, 0}});
  synchronize(exec); // does not hang: no kernel waits for the host
  t.expectBack(1);
  EXPECT_EQ(t.cleared.device().at(0), 9u) << "nor is any array cleared";
  t.write(3), t.launch(), t.gate.open(), t.gate.await(Gate::kSecond);
  t.expectBack(3);
}

} // namespace
} // namespace grouser::base
