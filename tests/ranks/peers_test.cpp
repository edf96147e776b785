// SPDX-License-Identifier: BSD-3-Clause
// Ranks with shared access to each other's memory, on CPUs, or on GPUs with GROUSER_TEST_DEVICE=cuda.
#include "base/array.hpp"
#include "base/error.hpp"
#include "base/peer_reduction.hpp"
#include "contact/exchange.hpp"
#include "terrain/grains.hpp"
#include "tests/device_under_test.hpp"
#include "tests/ranks/ranks.hpp"
#include "tests/terrain/grain_fixture.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <iterator>

namespace grouser {
namespace {

using base::PeerUse;

class Peers : public ::testing::Test {
protected:
  void SetUp() override {
    if (comm.alone()) GTEST_SKIP() << "one rank has no peers";
    exec = testExec(1, comm.rank());
    if (exec.onCpu()) {
      try {
        base::PeerMemory(exec, comm, PeerUse::always);
      } catch (const base::InputError& e) {
        GTEST_SKIP() << e.what();
      }
    }
    if (!exec.onCpu() && !base::PeerMemory(exec, comm, PeerUse::automatic).allSeeAll())
      GTEST_SKIP() << "the GPUs of this machine lack peer access";
  }
  const base::Comm& comm = test::comm();
  base::Exec exec;
};

TEST(PeersOnCpus, SeeNobodyUnlessAsked) {
  base::PeerMemory memory(base::cpuExec(1), test::comm(), PeerUse::automatic);
  memory.reserve(1000);
  EXPECT_NE(memory.own(), nullptr);
  EXPECT_FALSE(memory.allSeeAll());
  for (int r = 0; r < test::comm().size(); ++r) EXPECT_EQ(memory.of(r), nullptr);
  EXPECT_FALSE(base::PeerReduction(base::cpuExec(1), test::comm(), PeerUse::automatic).possible());
}

TEST(PeersOnCpus, WhoInsistsIsToldWhy) {
  if (test::comm().alone()) GTEST_SKIP() << "one rank has no peers";
  try {
    const base::PeerMemory memory(base::cpuExec(1), test::comm(), PeerUse::always, std::size_t{1} << 46);
    FAIL() << "no machine has so much memory: " << memory.allSeeAll();
  } catch (const base::InputError& e) {
    EXPECT_NE(std::string(e.what()).find("enough shared memory"), std::string::npos) << e.what();
  }
}

/// Open files of this process, from /proc/self/fd.
int openFiles() {
  const std::filesystem::directory_iterator files("/proc/self/fd");
  return static_cast<int>(std::distance(begin(files), end(files)));
}

TEST_F(Peers, LeaveNeitherNamesNorOpenFiles) {
  if (!exec.onCpu()) GTEST_SKIP() << "CUDA memory has no files";
  const auto names = [] {
    int count = 0;
    for (const auto& entry : std::filesystem::directory_iterator("/dev/shm"))
      count += entry.path().filename().string().rfind("grouser", 0) == 0;
    return count;
  };
  const int before = openFiles(), named = names();
  comm.wait();
  {
    base::PeerMemory memory(exec, comm, PeerUse::always);
    EXPECT_EQ(openFiles(), before) << "all ranks have mapped it: its name is closed to others";
    EXPECT_EQ(names(), named) << "a kill now would leave the file";
  }
  comm.wait();
}

TEST_F(Peers, WhatOneWritesTheOthersRead) {
  base::PeerMemory memory(exec, comm, PeerUse::always);
  for (const std::size_t bytes : {std::size_t{100}, std::size_t{5} << 20}) { // the second exceeds the initial size
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

TEST_F(Peers, AgreeOnTheLeastAndOnEveryBit) {
  base::PeerReduction agreement(exec, comm, PeerUse::always);
  ASSERT_TRUE(agreement.possible());
  const auto me = static_cast<std::uint64_t>(comm.rank()), all = static_cast<std::uint64_t>(comm.size());
  // Another rank has the minimum in each run; twenty are launched at once without the host.
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

/// Message of one rank to another in one run.
std::uint32_t said(std::uint32_t run, int from, int to) {
  return 10'000 * run + 100 * static_cast<std::uint32_t>(from) + static_cast<std::uint32_t>(to);
}

/// Element r is sent to rank r; received elements are in rank order.
void sendToAllOthers(const base::Exec& exec, const base::Comm& comm, contact::Exchange& exchange) {
  std::vector<std::uint64_t> to;
  std::vector<std::uint32_t> from;
  for (int r = comm.size() - 1; r >= 0; --r)
    if (r != comm.rank()) to.push_back(static_cast<std::uint64_t>(r)), from.push_back(static_cast<std::uint32_t>(r));
  base::Array<std::uint64_t> ranks(exec, to);
  base::Array<std::uint32_t> slots(exec, from);
  exchange.setPlan(ranks, slots, to.size());
  ASSERT_EQ(exchange.importCount(), to.size());
  exchange.setImportSlots(static_cast<std::size_t>(comm.size()));
}

/// Messages of this rank to all others, `width` times.
std::vector<std::uint32_t> sayings(const base::Comm& comm, std::uint32_t run, std::size_t width = 1) {
  std::vector<std::uint32_t> all;
  for (int r = 0; r < comm.size(); ++r) all.insert(all.end(), width, said(run, comm.rank(), r));
  return all;
}

void expectHeard(const base::Comm& comm, std::uint32_t run, const std::uint32_t* elements, std::size_t width = 1) {
  auto place = static_cast<std::size_t>(comm.size());
  for (int r = 0; r < comm.size(); ++r) {
    if (r == comm.rank()) continue;
    EXPECT_EQ(elements[place * width], said(run, r, comm.rank())) << "run " << run;
    EXPECT_EQ(elements[(place + 1) * width - 1], said(run, r, comm.rank())) << "run " << run;
    ++place;
  }
}

/// Consecutive runs with few or many words: all messages received by a rank belong to the same run.
void exchangeMany(const base::Exec& exec, const base::Comm& comm, PeerUse use) {
  constexpr std::size_t kWide = 200'000; // the fields of later runs enlarge the memory
  const auto size = static_cast<std::size_t>(comm.size());
  contact::Exchange exchange(exec, comm, {.peers = use});
  EXPECT_EQ(exchange.peersOnly(), use == PeerUse::always);
  sendToAllOthers(exec, comm, exchange);
  base::Array<std::uint32_t> narrow(exec, 2 * size), wide(exec, 2 * size * kWide);
  for (std::uint32_t run = 1; run <= 50; ++run) {
    const bool grown = run % 10 == 0;
    base::Array<std::uint32_t>& array = grown ? wide : narrow;
    const std::size_t width = grown ? kWide : 1;
    base::copyToDevice(exec, array.data(), sayings(comm, run, width).data(), 4 * size * width);
    const contact::ExchangeField field{array.data(), static_cast<std::uint32_t>(width)};
    exchange.start({&field, 1});
    base::setZero(exec, array.data(), 4 * size * width); // changed after packing: must not be sent
    exchange.finish({&field, 1});
    expectHeard(comm, run, array.toHost().data(), width);
  }
}

TEST_F(Peers, WaitForReadersThatAreLate) {
  // One rank repeatedly reads late: data packed next by the others must not reach it.
  contact::Exchange exchange(exec, comm, {.peers = PeerUse::always});
  sendToAllOthers(exec, comm, exchange);
  constexpr std::uint32_t kRuns = 30;
  const auto size = static_cast<std::size_t>(comm.size()), big = std::size_t{exec.onCpu() ? 1u << 24 : 1u << 30};
  std::vector<std::uint32_t> mine;
  for (std::uint32_t run = 0; run < kRuns; ++run) {
    const std::vector<std::uint32_t> now = sayings(comm, run);
    mine.insert(mine.end(), now.begin(), now.end());
    mine.resize(mine.size() + size);
  }
  base::Array<std::uint32_t> all(exec, mine);
  base::Array<std::byte> from(exec, comm.first() ? big : 0), to(exec, comm.first() ? big : 0);
  for (std::uint32_t run = 0; run < kRuns; ++run) {
    const contact::ExchangeField field{all.data() + run * 2 * size, 1};
    exchange.start({&field, 1});
    exchange.arrive();
    for (int copy = 0; comm.first() && copy < 5; ++copy) base::copyOnDevice(exec, to.data(), from.data(), big);
    exchange.unpack(exec, {&field, 1});
  }
  const std::vector<std::uint32_t> heard = all.toHost();
  for (std::uint32_t run = 0; run < kRuns; ++run) expectHeard(comm, run, heard.data() + run * 2 * size);
}

TEST_F(Peers, FetchElementsFromEachOther) { exchangeMany(exec, comm, PeerUse::always); }
TEST_F(Peers, OrSendMessages) { exchangeMany(exec, comm, PeerUse::never); }

TEST_F(Peers, StepsTogetherGiveTheBitsOfOneRankOnACpu) {
  // Alternates sixteen steps at once and single steps; reads energies, adds grains, and resumes a saved run.
  using namespace terrain;
  GrainModel m = testing::gravel();
  m.maxSimdLanes = 1; // lanes compute one step at a time
  const Boundaries box{
      {{{0, 0, 1}, 0, m.law}, {{1, 0, 0}, -0.05, m.law}, {{-1, 0, 0}, -0.85, m.law}, {{0, -1, 0}, -0.5, m.law}}, {}};
  std::vector<GrainSpec> start = testing::gravelBlock(12, 6, 5, {2.5, 1.0, -1}, {3, -2, 9});
  for (GrainSpec& g : start) g.velocity.x += 3 * g.position.x; // rebuild times differ between ranks
  const std::vector<GrainSpec> more = testing::gravelBlock(3, 3, 1, {0, 0, -1}, {}, {0, 0, 0.6});
  Grains alone(base::cpuExec(1), m, box, start);
  PartitionOptions together;
  together.comm = comm, together.peers = PeerUse::always;
  Grains shared(exec, m, box, start, together);
  ASSERT_TRUE(shared.distribution()->subdomain().stepsTogether());
  const auto advance = [](Grains& grains, std::int64_t steps) {
    for (std::int64_t i = 0; i < steps;) i += grains.advance(steps - i);
  };
  const auto words = [&](const Grains& grains) {
    std::vector<std::uint32_t> all;
    for (const auto& part : comm.gatherAll(grains.state().words())) all.insert(all.end(), part.begin(), part.end());
    return all;
  };
  for (const std::int64_t steps : {40, 17, 3, 64}) {
    advance(alone, steps), advance(shared, steps);
    EXPECT_EQ(shared.ledger().kinetic, alone.ledger().kinetic) << "after " << alone.steps();
    EXPECT_EQ(words(shared), alone.state().words()) << "after " << alone.steps();
  }
  alone.add(more), shared.add(more);
  advance(alone, 50), advance(shared, 50);
  EXPECT_EQ(words(shared), alone.state().words()) << "with grains added";
  shared.restore(shared.state());
  advance(alone, 150), advance(shared, 150);
  EXPECT_EQ(words(shared), alone.state().words()) << "after saving and loading";
  EXPECT_GT(shared.system().rebuilds, 3);
}

} // namespace
} // namespace grouser
