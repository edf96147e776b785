// SPDX-License-Identifier: BSD-3-Clause
#include "tests/ranks/ranks.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <thread>

namespace grouser::base {
namespace {

TEST(Comm, SumsAndExtremesAreOfAllRanks) {
  const Comm& comm = test::comm();
  const std::int64_t n = comm.size(), r = comm.rank();
  std::int64_t sums[2] = {r + 1, std::int64_t{1} << 60 >> comm.size()};
  comm.sum(sums, 2);
  EXPECT_EQ(sums[0], n * (n + 1) / 2);
  EXPECT_EQ(sums[1], n * (std::int64_t{1} << 60 >> comm.size())); // exact: no rounding through a double
  std::uint64_t least = 100 - static_cast<std::uint64_t>(r);
  comm.minimum(&least, 1);
  EXPECT_EQ(least, 100 - static_cast<std::uint64_t>(n - 1));
  double most = -1.5 * static_cast<double>(r);
  comm.maximum(&most, 1);
  EXPECT_EQ(most, 0.0);
  EXPECT_EQ(comm.sumBelow(r + 1), r * (r + 1) / 2);
}

TEST(Comm, WhatIsGatheredIsInTheOrderOfTheRanks) {
  const Comm& comm = test::comm();
  const std::vector<std::uint32_t> mine(static_cast<std::size_t>(comm.rank()), static_cast<std::uint32_t>(comm.rank()));
  const auto all = comm.gatherAll(mine);
  ASSERT_EQ(all.size(), static_cast<std::size_t>(comm.size()));
  for (std::size_t r = 0; r < all.size(); ++r)
    EXPECT_EQ(all[r], std::vector<std::uint32_t>(r, static_cast<std::uint32_t>(r)));
}

TEST(Comm, BroadcastGivesEveryRankWhatOneHas) {
  const Comm& comm = test::comm();
  const int root = comm.size() - 1;
  EXPECT_EQ(comm.broadcast(std::string("from ") + std::to_string(comm.rank()), root), "from " + std::to_string(root));
}

TEST(Comm, WaitingForALateRankIsCountedInEveryCall) {
  const Comm& comm = test::comm();
  if (comm.alone()) GTEST_SKIP() << "one rank never waits";
  const struct {
    const char* name;
    std::function<void()> call;
  } calls[] = {{"sum", [&] { comm.sumOf(1); }},
               {"sumBelow", [&] { comm.sumBelow(1); }},
               {"wait", [&] { comm.wait(); }},
               {"gather", [&] { comm.gather(Bytes(3)); }},
               {"broadcast", [&] { comm.broadcast(Bytes(3), 0); }}};
  constexpr double kLate = 0.05; // [s]
  for (const auto& [name, call] : calls) {
    // In one of a few tries all ranks except the late one must be on time, however busy the machine is.
    double longest = 0;
    for (int attempt = 0; attempt < 20 && longest < kLate / 2; ++attempt) {
      comm.sumOf(1);
      const double before = comm.waited();
      if (comm.first()) std::this_thread::sleep_for(std::chrono::duration<double>(kLate));
      call();
      double waited = comm.first() ? 1e300 : comm.waited() - before; // the smallest of all others
      waited = -waited;
      comm.maximum(&waited, 1);
      longest = std::max(longest, -waited);
    }
    EXPECT_GE(longest, kLate / 2) << name;
  }
}

TEST(Comm, MessagesLargerThanOnePartArriveWhole) {
  // Half a gigabyte per rank would be slow: this size just crosses the limit between eager and rendezvous messages.
  const Comm& comm = test::comm();
  const int next = (comm.rank() + 1) % comm.size(), before = (comm.rank() + comm.size() - 1) % comm.size();
  if (comm.alone()) GTEST_SKIP() << "one rank sends no messages";
  std::vector<std::uint64_t> out(1 << 20), in(out.size());
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = i * 7 + static_cast<std::uint64_t>(comm.rank());
  Messages messages(comm);
  messages.receive(before, in.data(), in.size() * 8, 3);
  messages.send(next, out.data(), out.size() * 8, 3);
  messages.waitAll();
  for (std::size_t i = 0; i < in.size(); ++i) ASSERT_EQ(in[i], i * 7 + static_cast<std::uint64_t>(before));
}

} // namespace
} // namespace grouser::base
