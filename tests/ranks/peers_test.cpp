// SPDX-License-Identifier: BSD-3-Clause
// Ranks that look into each other's memory. Those on CPUs do not; with a GPU, run this program under mpirun there.
#include "base/array.hpp"
#include "base/error.hpp"
#include "base/peer_agreement.hpp"
#include "contact/exchange.hpp"
#include "tests/ranks/ranks.hpp"

#include <gtest/gtest.h>

namespace grouser {
namespace {

using base::PeerUse;

class PeersOnCuda : public testing::Test {
protected:
  void SetUp() override {
    if (!base::cudaAvailable()) GTEST_SKIP() << "no GPU";
    if (comm.alone()) GTEST_SKIP() << "one rank has no peers";
    exec = base::cudaExec(comm.rank() % base::cudaDevices());
  }
  const base::Comm& comm = test::comm();
  base::Exec exec;
};

TEST(Peers, RanksOnCpusSeeNobody) {
  base::PeerMemory memory(base::cpuExec(1), test::comm(), PeerUse::automatic);
  memory.reserve(1000);
  EXPECT_NE(memory.own(), nullptr);
  EXPECT_FALSE(memory.allSeeAll());
  for (int r = 0; r < test::comm().size(); ++r) EXPECT_EQ(memory.of(r), nullptr);
  EXPECT_FALSE(base::PeerAgreement(base::cpuExec(1), test::comm(), PeerUse::automatic).possible());
}

TEST(Peers, WhoInsistsIsToldWhy) {
  if (test::comm().alone()) GTEST_SKIP() << "one rank needs nobody's memory";
  try {
    base::PeerMemory memory(base::cpuExec(1), test::comm(), PeerUse::always);
    FAIL() << "CPUs cannot";
  } catch (const base::InputError& e) {
    EXPECT_NE(std::string(e.what()).find("peer_memory"), std::string::npos) << e.what();
  }
}

TEST_F(PeersOnCuda, WhatOneWritesTheOthersRead) {
  base::PeerMemory memory(exec, comm, PeerUse::always);
  for (const std::size_t bytes : {std::size_t{100}, std::size_t{5} << 20}) { // the second makes it grow
    memory.reserve(bytes);
    const std::vector<std::uint32_t> mine(bytes / 4, static_cast<std::uint32_t>(comm.rank()) + 1);
    base::copyToDevice(exec, memory.own(), mine.data(), bytes);
    comm.wait();
    for (int r = 0; r < comm.size(); ++r) {
      if (r == comm.rank()) continue;
      ASSERT_NE(memory.of(r), nullptr);
      EXPECT_EQ(base::toHost(exec, static_cast<const std::uint32_t*>(memory.of(r)), bytes / 4),
                std::vector<std::uint32_t>(bytes / 4, static_cast<std::uint32_t>(r) + 1));
    }
    comm.wait();
  }
}

TEST_F(PeersOnCuda, AgreeOnTheLeastAndOnEveryBit) {
  base::PeerAgreement agreement(exec, comm, PeerUse::always);
  ASSERT_TRUE(agreement.possible());
  const auto me = static_cast<std::uint64_t>(comm.rank()), all = static_cast<std::uint64_t>(comm.size());
  // Each run another rank says the least; twenty are given at once, without a host in between.
  constexpr std::uint64_t kRuns = 20;
  std::vector<std::uint64_t> said;
  for (std::uint64_t k = 0; k < kRuns; ++k) {
    said.push_back(100 * k + (me + k) % all);
    said.push_back(std::uint64_t{1} << (2 * me + k % 2));
  }
  base::Array<std::uint64_t> words(exec, said);
  for (std::uint64_t k = 0; k < kRuns; ++k) agreement.run(exec, words.data() + 2 * k);
  const std::vector<std::uint64_t> agreed = words.toHost();
  for (std::uint64_t k = 0; k < kRuns; ++k) {
    std::uint64_t bits = 0;
    for (std::uint64_t r = 0; r < all; ++r) bits |= std::uint64_t{1} << (2 * r + k % 2);
    EXPECT_EQ(agreed[2 * k], 100 * k) << "run " << k;
    EXPECT_EQ(agreed[2 * k + 1], bits) << "run " << k;
  }
}

/// Every rank sends a number to each other rank, and none to itself, run after run: each must get those of this run.
void exchangeMany(const base::Exec& exec, const base::Comm& comm, PeerUse use) {
  constexpr std::size_t kWide = 200'000; // the fields of later runs make the memory grow
  const auto size = static_cast<std::size_t>(comm.size());
  contact::Exchange exchange(exec, comm, {.peers = use});
  EXPECT_EQ(exchange.peersOnly(), use == PeerUse::always);
  std::vector<std::uint64_t> to;
  std::vector<std::uint32_t> from;
  for (int r = comm.size() - 1; r >= 0; --r)
    if (r != comm.rank()) to.push_back(static_cast<std::uint64_t>(r)), from.push_back(0);
  base::Array<std::uint64_t> ranks(exec, to);
  base::Array<std::uint32_t> slots(exec, from);
  exchange.route(ranks, slots, to.size());
  ASSERT_EQ(exchange.coming(), size - 1);
  exchange.putFrom(1);
  base::Array<std::uint32_t> narrow(exec, size), wide(exec, size * kWide);
  for (std::uint32_t run = 1; run <= 50; ++run) {
    const bool grown = run % 10 == 0;
    base::Array<std::uint32_t>& array = grown ? wide : narrow;
    const std::size_t width = grown ? kWide : 1;
    const std::uint32_t mine = 1000 * run + static_cast<std::uint32_t>(comm.rank());
    base::copyToDevice(exec, array.data(), std::vector<std::uint32_t>(width, mine).data(), 4 * width);
    const contact::ExchangeField field{array.data(), static_cast<std::uint32_t>(width)};
    exchange.start({&field, 1});
    const std::vector<std::uint32_t> spoilt(width, 0); // after it was packed: must not travel
    base::copyToDevice(exec, array.data(), spoilt.data(), 4 * width);
    exchange.finish({&field, 1});
    if (run % 10 > 3) continue; // some runs follow each other without a wait of the host
    const std::vector<std::uint32_t> all = array.toHost();
    std::size_t place = 1;
    for (int r = 0; r < comm.size(); ++r) {
      if (r == comm.rank()) continue;
      EXPECT_EQ(all[place * width], 1000 * run + static_cast<std::uint32_t>(r)) << "run " << run;
      EXPECT_EQ(all[(place + 1) * width - 1], 1000 * run + static_cast<std::uint32_t>(r)) << "run " << run;
      ++place;
    }
  }
}

TEST_F(PeersOnCuda, FetchElementsFromEachOther) { exchangeMany(exec, comm, PeerUse::always); }
TEST_F(PeersOnCuda, OrSendMessages) { exchangeMany(exec, comm, PeerUse::never); }

} // namespace
} // namespace grouser
