// SPDX-License-Identifier: BSD-3-Clause
// The exchange protocol with a custom element type: a passive tracer with a concentration, a label and a
// colour, which is exchanged twice within a step.
#include "contact/exchange.hpp"
#include "tests/ranks/ranks.hpp"

#include "base/algorithms.hpp"

#include <gtest/gtest.h>

#include <array>
#include <stdexcept>

namespace grouser::contact {
namespace {

constexpr ExchangeOptions kOnCpus{.peers = base::PeerUse::never};
using Colour = std::array<std::uint32_t, 3>;

/// Tracers on a line, one per integer position; a position belongs to rank position / kEach.
struct Tracers {
  static constexpr std::uint32_t kEach = 10; ///< positions per rank
  base::Exec exec = base::cpuExec(1);
  base::Array<double> concentration{exec};
  base::Array<std::uint32_t> place{exec};
  base::Array<Colour> colour{exec};
  std::size_t owned = 0;

  std::vector<ExchangeField> everything() { return {fieldOf(concentration), fieldOf(place), fieldOf(colour)}; }
  void resize(std::size_t size) {
    concentration.resizeKeeping(size), place.resizeKeeping(size), colour.resizeKeeping(size);
  }
};

double concentrationAt(std::uint32_t place) { return 1.0 / (place + 1.0); }

/// The tracers of this rank, at its own positions.
Tracers startingTracers() {
  Tracers t;
  t.owned = Tracers::kEach;
  t.resize(t.owned);
  for (std::uint32_t i = 0; i < Tracers::kEach; ++i) {
    const std::uint32_t p = static_cast<std::uint32_t>(test::comm().rank()) * Tracers::kEach + i;
    t.place.data()[i] = p;
    t.concentration.data()[i] = concentrationAt(p);
    t.colour.data()[i] = {p, p * p, p + 7};
  }
  return t;
}

/// Sends the tracers with a `destination` and appends the received ones.
void route(Exchange& exchange, const Tracers& t, const std::vector<std::pair<std::uint32_t, int>>& leaving) {
  base::Array<std::uint64_t> ranks(t.exec, leaving.size());
  base::Array<std::uint32_t> slots(t.exec, leaving.size());
  for (std::size_t k = 0; k < leaving.size(); ++k) {
    slots.data()[k] = leaving[k].first;
    ranks.data()[k] = static_cast<std::uint64_t>(leaving[k].second);
  }
  exchange.setPlan(ranks, slots, leaving.size());
}

TEST(Exchange, HandsOverWholeElementsAndUpdatesGhostsTwiceAStep) {
  const base::Comm& comm = test::comm();
  if (comm.alone()) GTEST_SKIP() << "one rank has no exchange partner: see OneRank";
  const int right = (comm.rank() + 1) % comm.size(), left = (comm.rank() + comm.size() - 1) % comm.size();
  Tracers t = startingTracers();

  // Every rank sends its last two tracers with all fields to the right.
  Exchange migration(t.exec, comm, kOnCpus);
  route(migration, t, {{Tracers::kEach - 1, right}, {Tracers::kEach - 2, right}});
  ASSERT_EQ(migration.importCount(), 2u);
  t.resize(t.owned + 2);
  migration.setImportSlots(t.owned);
  migration.run(t.everything());
  const std::uint32_t top = static_cast<std::uint32_t>(left + 1) * Tracers::kEach - 1;
  for (std::uint32_t k = 0; k < 2; ++k) {
    const std::uint32_t p = top - k; // the order is preserved in transit
    EXPECT_EQ(t.place.data()[t.owned + k], p);
    EXPECT_EQ(t.concentration.data()[t.owned + k], concentrationAt(p));
    EXPECT_EQ(t.colour.data()[t.owned + k], (Colour{p, p * p, p + 7}));
  }

  // Ghosts: the left neighbour receives the first tracer, with its concentration only.
  Exchange ghosts(t.exec, comm, kOnCpus);
  route(ghosts, t, {{0, left}});
  ASSERT_EQ(ghosts.importCount(), 1u);
  const std::size_t ghost = t.owned + 2;
  t.resize(ghost + 1);
  ghosts.setImportSlots(ghost);
  for (int half = 0; half < 2; ++half) {
    t.concentration.data()[0] += 1;
    const ExchangeField field = fieldOf(t.concentration);
    ghosts.start({&field, 1});
    t.concentration.data()[0] += 0.5; // changed after sending: must not be sent
    ghosts.finish({&field, 1});
    const double first = concentrationAt(static_cast<std::uint32_t>(right) * Tracers::kEach);
    EXPECT_EQ(t.concentration.data()[ghost], first + 1 + 1.5 * half);
  }
  EXPECT_EQ(ghosts.runs(), 2);
  EXPECT_EQ(ghosts.bytesSent(), 2 * 8);
}

TEST(Exchange, PackedInManyLaunchesTheSameArrives) {
  const base::Comm& comm = test::comm();
  if (comm.alone()) GTEST_SKIP() << "one rank has no exchange partner";
  const int right = (comm.rank() + 1) % comm.size(), left = (comm.rank() + comm.size() - 1) % comm.size();
  // Elements of six words: 1, 2 and 3 of the 7 at a time.
  for (const std::size_t words : {1u, 12u, 19u}) {
    Tracers t = startingTracers();
    Exchange migration(t.exec, comm, {.peers = base::PeerUse::never, .wordsAtATime = words});
    std::vector<std::pair<std::uint32_t, int>> leaving;
    for (std::uint32_t i = 0; i < 7; ++i) leaving.emplace_back(i, right);
    route(migration, t, leaving);
    t.resize(t.owned + 7);
    migration.setImportSlots(t.owned);
    migration.run(t.everything());
    for (std::uint32_t i = 0; i < 7; ++i) {
      const std::uint32_t p = static_cast<std::uint32_t>(left) * Tracers::kEach + i;
      EXPECT_EQ(t.place.data()[t.owned + i], p);
      EXPECT_EQ(t.concentration.data()[t.owned + i], concentrationAt(p));
      EXPECT_EQ(t.colour.data()[t.owned + i], (Colour{p, p * p, p + 7}));
    }
  }
}

TEST(Exchange, FollowsElementsThatMoveToOtherSlots) {
  const base::Comm& comm = test::comm();
  if (comm.alone()) GTEST_SKIP() << "one rank has no exchange partner";
  const int right = (comm.rank() + 1) % comm.size(), left = (comm.rank() + comm.size() - 1) % comm.size();
  Tracers t = startingTracers();
  Exchange ghosts(t.exec, comm, kOnCpus);
  route(ghosts, t, {{3, right}});
  const std::size_t size = t.owned + 1;
  t.resize(size);
  ghosts.setImportSlots(t.owned);
  // Reversed order: slot s moves to size - 1 - s.
  base::Array<std::uint32_t> newSlot(t.exec, size);
  std::vector<double> moved(size);
  for (std::size_t s = 0; s < size; ++s) {
    newSlot.data()[s] = static_cast<std::uint32_t>(size - 1 - s);
    moved[size - 1 - s] = t.concentration.data()[s];
  }
  t.concentration.assign(moved);
  ghosts.renumber(newSlot.data());
  const ExchangeField field = fieldOf(t.concentration);
  ghosts.run({&field, 1});
  EXPECT_EQ(t.concentration.data()[0], concentrationAt(static_cast<std::uint32_t>(left) * Tracers::kEach + 3));
}

TEST(Exchange, OneElementMayGoToManyRanksAndNoneToOthers) {
  const base::Comm& comm = test::comm();
  if (comm.alone()) GTEST_SKIP() << "one rank has no exchange partner";
  Tracers t = startingTracers();
  Exchange exchange(t.exec, comm, kOnCpus);
  // Rank 0 sends its tracer 5 to all others; the others send nothing.
  std::vector<std::pair<std::uint32_t, int>> leaving;
  for (int r = comm.size() - 1; r > 0 && comm.first(); --r) leaving.emplace_back(5, r); // not ordered by rank
  route(exchange, t, leaving);
  EXPECT_EQ(exchange.importCount(), comm.first() ? 0u : 1u);
  EXPECT_EQ(exchange.exportCount(), leaving.size());
  t.resize(t.owned + exchange.importCount());
  exchange.setImportSlots(t.owned);
  exchange.run(t.everything());
  if (!comm.first()) {
    EXPECT_EQ(t.place.data()[t.owned], 5u);
  }
}

TEST(Exchange, RefusesToFinishWithOtherFields) {
  const base::Comm& comm = test::comm();
  if (comm.alone()) GTEST_SKIP() << "one rank has no exchange partner";
  Tracers t = startingTracers();
  Exchange exchange(t.exec, comm, kOnCpus);
  route(exchange, t, {});
  const ExchangeField wide = fieldOf(t.colour), narrow = fieldOf(t.place);
  EXPECT_THROW(exchange.finish({&wide, 1}), std::logic_error); // no exchange is active
  exchange.start({&wide, 1});
  EXPECT_THROW(exchange.finish({&narrow, 1}), std::logic_error);
  exchange.finish({&wide, 1});
}

} // namespace
} // namespace grouser::contact
