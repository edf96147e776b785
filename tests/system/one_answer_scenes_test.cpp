// SPDX-License-Identifier: BSD-3-Clause
// Identical results: the golden hash of every scene in tests/scenes without a vehicle, for threads, lists and a
// resumed run. tests/gpu compares the same scenes on CPU and GPU, tests/ranks parts of them on several ranks.
#include "coupling/simulation.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/setup/simulation_setup.hpp"
#include "tests/device_under_test.hpp"

#include <gtest/gtest.h>

#include <ostream>

namespace grouser::coupling {
namespace {

/// A change of a hash means a change of the physics or of its order of operations, and needs a reason in the
/// commit.
struct Golden {
  const char* scene;
  int steps;
  const char* hash;
  std::vector<std::string> otherLists; ///< for another skin; grains thrown fast would cross a thin one in a step
};
std::ostream& operator<<(std::ostream& out, const Golden& g) { return out << g.scene; }

class OneAnswerScenes : public ::testing::TestWithParam<Golden> {};

Simulation begin(const Golden& g, int threads, const std::vector<std::string>& overrides = {}) {
  return Simulation(setup::simulationSetup(setup::loadScene(testScene(std::string(g.scene) + ".toml"), overrides)),
                    testExec(threads), [](double, double) {});
}

void advance(Simulation& simulation, int to) {
  while (simulation.steps() < to) simulation.step();
}

TEST_P(OneAnswerScenes, HashIsThatOfEveryMachineAndNumberOfThreads) {
  const Golden& g = GetParam();
  Simulation two = begin(g, 2);
  advance(two, g.steps);
  EXPECT_EQ(two.stateHash(), g.hash);
  Simulation one = begin(g, 1, g.otherLists);
  advance(one, g.steps);
  EXPECT_EQ(one.stateHash(), g.hash) << "one thread, other lists";
}

TEST_P(OneAnswerScenes, HashIsThatOfAResumedRun) {
  const Golden& g = GetParam();
  Simulation first = begin(g, 1);
  advance(first, g.steps / 3);
  Simulation second(setup::simulationSetup(setup::loadScene(testScene(std::string(g.scene) + ".toml"))), testExec(2),
                    first.save());
  advance(second, g.steps);
  EXPECT_EQ(second.stateHash(), g.hash);
}

TEST(OneAnswerBed, TwentyThousandGrainsOverTenThousandSteps) {
  const Golden bed{"bed", 10000, "e53922e7928dfcc5", {}};
  Simulation simulation = begin(bed, 2);
  advance(simulation, bed.steps);
  EXPECT_EQ(simulation.stateHash(), bed.hash);
}

INSTANTIATE_TEST_SUITE_P(Scenes, OneAnswerScenes,
                         ::testing::Values(Golden{"rigs", 1900, "d4b8b6837fbddb35", {"run.skin=0.6"}},
                                           Golden{"chute", 4000, "15cc283c7c836e60", {"run.skin=0.6"}},
                                           Golden{"moving", 4000, "3fb1df6292c8cf07", {"run.skin=0.6"}},
                                           Golden{"bodies", 4000, "b26247a9814a389f", {"run.skin=0.6"}},
                                           Golden{"soil_bodies", 4000, "db8a6c47d729e1e8", {}},
                                           Golden{"rain", 5000, "8a17bedf97e980b9", {"run.skin=0.7"}},
                                           Golden{"mixture", 1500, "1742bd9c0aae9052", {"run.skin=0.5"}},
                                           Golden{"cohesive", 4000, "ceff62949db09252", {"run.skin=0.5"}},
                                           Golden{"fluid", 150, "da6a4216243b45df", {}},
                                           Golden{"bed", 500, "c58144d619c8531b", {"run.skin=0.6"}}),
                         [](const ::testing::TestParamInfo<Golden>& each) { return std::string(each.param.scene); });

} // namespace
} // namespace grouser::coupling
