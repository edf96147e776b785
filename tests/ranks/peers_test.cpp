// SPDX-License-Identifier: BSD-3-Clause
// Ranks that look into each other's memory. Those on CPUs do not; with a GPU, run this program under mpirun there.
#include "base/array.hpp"
#include "base/error.hpp"
#include "base/peer_agreement.hpp"
#include "contact/exchange.hpp"
#include "terrain/grains.hpp"
#include "tests/ranks/ranks.hpp"
#include "tests/terrain/grain_fixture.hpp"

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
    if (!base::PeerMemory(exec, comm, PeerUse::automatic).allSeeAll())
      GTEST_SKIP() << "the GPUs of this machine do not see each other's memory";
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
    EXPECT_NE(std::string(e.what()).find("peer memory"), std::string::npos) << e.what();
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

/// Every rank sends its first element to each other rank; what comes goes to the places from 1 on.
void sendToAllOthers(const base::Exec& exec, const base::Comm& comm, contact::Exchange& exchange) {
  std::vector<std::uint64_t> to;
  for (int r = comm.size() - 1; r >= 0; --r)
    if (r != comm.rank()) to.push_back(static_cast<std::uint64_t>(r));
  base::Array<std::uint64_t> ranks(exec, to);
  base::Array<std::uint32_t> slots(exec, std::vector<std::uint32_t>(to.size(), 0));
  exchange.route(ranks, slots, to.size());
  ASSERT_EQ(exchange.coming(), to.size());
  exchange.putFrom(1);
}

/// A number of each rank, run after run, and few or many words a run: each must get those of this run.
void exchangeMany(const base::Exec& exec, const base::Comm& comm, PeerUse use) {
  constexpr std::size_t kWide = 200'000; // the fields of later runs make the memory grow
  const auto size = static_cast<std::size_t>(comm.size());
  contact::Exchange exchange(exec, comm, {.peers = use});
  EXPECT_EQ(exchange.peersOnly(), use == PeerUse::always);
  sendToAllOthers(exec, comm, exchange);
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

TEST_F(PeersOnCuda, WaitForReadersThatAreLate) {
  // One rank reads late, again and again: what the others pack next must not reach it.
  contact::Exchange exchange(exec, comm, {.peers = PeerUse::always});
  sendToAllOthers(exec, comm, exchange);
  constexpr std::uint32_t kRuns = 30;
  const auto size = static_cast<std::size_t>(comm.size()), big = std::size_t{1} << 30;
  std::vector<std::uint32_t> mine(kRuns * size);
  for (std::uint32_t k = 0; k < kRuns; ++k) mine[k * size] = 1000 * (k + 1) + static_cast<std::uint32_t>(comm.rank());
  base::Array<std::uint32_t> all(exec, mine);
  base::Array<std::byte> from(exec, comm.first() ? big : 0), to(exec, comm.first() ? big : 0);
  for (std::uint32_t k = 0; k < kRuns; ++k) {
    const contact::ExchangeField field{all.data() + k * size, 1};
    exchange.start({&field, 1});
    exchange.arrive();
    for (int copy = 0; comm.first() && copy < 5; ++copy) base::copyOnDevice(exec, to.data(), from.data(), big);
    exchange.unpack(exec, {&field, 1});
  }
  const std::vector<std::uint32_t> got = all.toHost();
  for (std::uint32_t k = 0; k < kRuns; ++k) {
    std::size_t place = 1;
    for (int r = 0; r < comm.size(); ++r)
      if (r != comm.rank()) {
        EXPECT_EQ(got[k * size + place++], 1000 * (k + 1) + static_cast<std::uint32_t>(r)) << "run " << k;
      }
  }
}

TEST_F(PeersOnCuda, FetchElementsFromEachOther) { exchangeMany(exec, comm, PeerUse::always); }
TEST_F(PeersOnCuda, OrSendMessages) { exchangeMany(exec, comm, PeerUse::never); }

TEST_F(PeersOnCuda, StepsTogetherGiveTheBitsOfOneRankOnACpu) {
  // Sixteen steps at once and single ones in turn; energies are asked for, grains are added, and a saved run goes on.
  using namespace terrain;
  const GrainModel m = testing::gravel();
  const Boundaries box{
      {{{0, 0, 1}, 0, m.law}, {{1, 0, 0}, -0.05, m.law}, {{-1, 0, 0}, -0.85, m.law}, {{0, -1, 0}, -0.5, m.law}}, {}};
  const std::vector<GrainStart> start = testing::gravelBlock(12, 6, 5, {2.5, 1.0, -1}, {3, -2, 9});
  const std::vector<GrainStart> more = testing::gravelBlock(3, 3, 1, {0, 0, -1}, {}, {0, 0, 0.6});
  Grains alone(base::cpuExec(1), m, box, start);
  PartitionOptions together;
  together.comm = comm, together.peers = PeerUse::always;
  Grains shared(exec, m, box, start, together);
  ASSERT_TRUE(shared.subdomain()->stepsTogether());
  const auto advance = [](Grains& grains, std::int64_t steps) {
    for (std::int64_t i = 0; i < steps;) i += grains.advance(steps - i);
  };
  const auto words = [&](const Grains& grains) {
    std::vector<std::uint32_t> all;
    for (const auto& part : comm.gatherAll(grains.stateWords())) all.insert(all.end(), part.begin(), part.end());
    return all;
  };
  for (const std::int64_t steps : {40, 17, 3, 64}) {
    advance(alone, steps), advance(shared, steps);
    EXPECT_EQ(shared.ledger().kinetic, alone.ledger().kinetic) << "after " << alone.steps();
    EXPECT_EQ(words(shared), alone.stateWords()) << "after " << alone.steps();
  }
  alone.add(more), shared.add(more);
  advance(alone, 50), advance(shared, 50);
  EXPECT_EQ(words(shared), alone.stateWords()) << "with grains added";
  shared.restore(shared.state());
  advance(alone, 150), advance(shared, 150);
  EXPECT_EQ(words(shared), alone.stateWords()) << "after it was saved and loaded";
  EXPECT_GT(shared.rebuilds(), 3);
}

} // namespace
} // namespace grouser
