// SPDX-License-Identifier: BSD-3-Clause
// Grains::advance(), which launches many steps at once: bits, lists and errors are those of
// single steps.
#include "grain_fixture.hpp"
#include "tests/device_under_test.hpp"

#include "base/error.hpp"
#include "terrain/grain_forces.hpp"

#include <gtest/gtest.h>

namespace grouser::terrain::testing {
namespace {

/// A block of gravel thrown at the floor, with so thin a skin that rebuilds occur within many steps.
Grains thrown(double speed, Precision precision = Precision::single, bool hills = false) {
  GrainModel model = gravel(0.02);
  model.precision = precision, model.floorLaw = model.law;
  model.maxSimdLanes = 1; // a CPU then batches its steps like a GPU
  Boundaries floor;
  if (hills)
    floor.floor = HeightField::plane({-2, 3, -2, 3}, -0.05, 0.1, -0.05);
  else
    floor.walls.push_back(floorPlane(model.law));
  return Grains(testExec(2), model, floor, gravelBlock(6, 6, 3, {0.4, 0, -speed}, {3, 0, 0}));
}

void advanceAtOnce(Grains& grains, std::int64_t steps) {
  for (std::int64_t i = 0; i < steps;) {
    const std::int64_t taken = grains.advance(steps - i);
    ASSERT_GE(taken, 1);
    ASSERT_LE(taken, steps - i);
    i += taken;
  }
}

TEST(BatchedSteps, EndWhereSingleStepsEnd) {
  Grains single = thrown(1), some = thrown(1);
  // Not multiples of the batch size, so that single steps come in between.
  for (const int steps : {37, 16, 101, 32, 300}) {
    advance(single, steps);
    advanceAtOnce(some, steps);
    ASSERT_EQ(some.steps(), single.steps());
    ASSERT_EQ(some.system().rebuilds, single.system().rebuilds)
        << "a batch of steps ends at a rebuild, and the next one starts after it";
    ASSERT_EQ(some.state().words(), single.state().words()) << "after " << single.steps() << " steps";
  }
  EXPECT_GT(single.system().rebuilds, 10);
}

TEST(BatchedSteps, EndSoInDoubleAndOnAFloorToo) {
  for (const bool hills : {false, true})
    for (const Precision precision : {Precision::single, Precision::double_}) {
      Grains single = thrown(1, precision, hills), some = thrown(1, precision, hills);
      advance(single, 150);
      advanceAtOnce(some, 150);
      EXPECT_EQ(some.state().words(), single.state().words());
      EXPECT_EQ(forceRatio(some.system()), forceRatio(single.system()))
          << "it requires the velocities of the step before";
    }
}

TEST(BatchedSteps, LookingAtThemOrAddingToThemInBetweenChangesNothing) {
  Grains single = thrown(1), some = thrown(1);
  const std::vector<GrainSpec> more = {{{0.2, 0.2, 0.6}, {0, 0, -1}, {}}};
  for (int round = 0; round < 4; ++round) {
    advance(single, 40);
    advanceAtOnce(some, 40);
    some.ledger(); // may rebuild
    if (round == 1) single.add(more), some.add(more);
  }
  EXPECT_EQ(some.state().words(), single.state().words());
}

TEST(BatchedSteps, MixWithSingleSteps) {
  Grains single = thrown(1), mixed = thrown(1);
  advance(single, 200);
  for (int round = 0; round < 5; ++round) {
    advance(mixed, 7); // an odd number: the state is in the other buffer
    advanceAtOnce(mixed, 33);
  }
  EXPECT_EQ(mixed.state().words(), single.state().words());
}

TEST(BatchedSteps, AFaultHasTheSameStepGrainAndPlace) {
  const auto messageOf = [](auto&& go) {
    Grains grains = thrown(12); // presses the grains below far into each other
    try {
      go(grains);
    } catch (const base::SimulationError& error) {
      return std::string(error.what());
    }
    return std::string("no fault");
  };
  const std::string single = messageOf([](Grains& g) { advance(g, 2000); });
  EXPECT_NE(single.find("step "), std::string::npos) << single;
  EXPECT_EQ(messageOf([](Grains& g) { advanceAtOnce(g, 2000); }), single);
}

} // namespace
} // namespace grouser::terrain::testing
