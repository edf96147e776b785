// SPDX-License-Identifier: BSD-3-Clause
#include "runs/setup/grain_kinds.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/setup/sources.hpp"

#include "base/error.hpp"
#include "coupling/simulation.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/simulation_setup.hpp"
#include "tests/runs/scene_fixture.hpp"

#include <gtest/gtest.h>

namespace grouser::coupling {

using namespace test; // fixtures

namespace {

constexpr const char* kDrip = R"(version = 1
[run]
duration = 1.0
time_step = 1e-4
gravity = [0, 0, -10]
seed = 3
threads = 1
[material.glass]
stiffness = 1e5
[[source]]
low = [-0.2, -0.1, 1.0]
high = [0.2, 0.1, 1.1]
velocity = [0, 0, -1]
radius = 0.02
material = "glass"
number = 3
every = 0.1
start = 0.05
total = 10
)";

scene::Scene drip(const std::vector<std::string>& overrides = {}) {
  return setup::parseScene(kDrip, "drip.toml", overrides);
}

/// In steps of 1e-4 s.
Sources sourcesOf(const scene::Scene& scene) { return setup::sourcesOf(scene, setup::grainKinds(scene), 1e-4); }

TEST(Sources, GivesBatchesOnTimeAndTheRestLast) {
  const Sources sources = sourcesOf(drip());
  std::vector<std::pair<std::int64_t, std::size_t>> seen;
  for (std::int64_t step = 0; step < 10000; ++step)
    if (const auto batch = sources.enteringAt(step); !batch.empty()) seen.emplace_back(step, batch.size());
  EXPECT_EQ(seen, (std::vector<std::pair<std::int64_t, std::size_t>>{{500, 3}, {1500, 3}, {2500, 3}, {3500, 1}}));
}

TEST(Sources, PlacesLieInTheBoxApartFromEachOtherAndFollowFromTheSeed) {
  const scene::Scene scene = drip();
  const auto batch = sourcesOf(scene).enteringAt(1500);
  for (std::size_t i = 0; i < batch.size(); ++i) {
    for (int a = 0; a < 3; ++a) {
      EXPECT_GE(batch[i].position[a], scene.sources[0].low[a]);
      EXPECT_LE(batch[i].position[a], scene.sources[0].high[a]);
    }
    for (std::size_t j = 0; j < i; ++j) EXPECT_GE(norm(batch[i].position - batch[j].position), 0.04);
  }
  EXPECT_EQ(batch[0].position, sourcesOf(drip()).enteringAt(1500)[0].position);
  EXPECT_NE(batch[0].position, sourcesOf(drip({"run.seed=4"})).enteringAt(1500)[0].position);
}

TEST(Sources, FallingGrainsBringTheirEnergyWithThem) {
  const scene::Scene scene = drip();
  Simulation simulation(setup::simulationSetup(scene), base::cpuExec(1), [](double, double) {});
  while (simulation.steps() < 4000) simulation.step();
  EXPECT_EQ(simulation.ground().grains->count(), 10u);
  const Ledger l = simulation.ledger();
  EXPECT_GT(l.kinetic, 1.0);
  // Free fall: symplectic Euler leaves m g v dt / 2 per grain; 10 grains of 0.084 kg fall at 1 to 4.5 m/s.
  EXPECT_NEAR(l.residual, 0, 10 * 0.084 * 10 * 4.5 * 1e-4 / 2 * 1.01);
  // The first three have fallen for 0.35 s: h = v t + g t^2 / 2, exact except for the step's g t dt / 2.
  const auto s = simulation.ground().grains->snapshot();
  const auto first = sourcesOf(scene).enteringAt(500);
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_NEAR(first[i].position.z - s.position[i].z, 0.35 + 5 * 0.35 * 0.35, 10 * 0.35 * 1e-4 / 2 * 1.01);
}

TEST(Sources, ResumedBetweenTwoBatchesGivesTheSameBits) {
  const scene::Scene scene = drip();
  Simulation straight(setup::simulationSetup(scene), base::cpuExec(1), [](double, double) {});
  while (straight.steps() < 4000) straight.step();
  for (const std::int64_t stop : {0, 499, 500, 1500, 2600}) {
    Simulation first(setup::simulationSetup(scene), base::cpuExec(1), [](double, double) {});
    while (first.steps() < stop) first.step();
    Simulation second(setup::simulationSetup(scene), base::cpuExec(2), first.save());
    while (second.steps() < 4000) second.step();
    EXPECT_EQ(second.stateHash(), straight.stateHash()) << "stopped at step " << stop;
  }
}

TEST(Sources, ABoxWithoutRoomIsRefused) {
  try {
    Simulation simulation(setup::simulationSetup(drip({"source.0.number=200", "source.0.total=200"})), base::cpuExec(1),
                          [](double, double) {});
    FAIL();
  } catch (const base::InputError& error) {
    EXPECT_NE(std::string(error.what()).find("source.0: 200 grains of radius 0.02 m do not fit"), std::string::npos)
        << error.what();
  }
}

/// Error of a run that inserts a grain at an occupied place; "" if there is none.
std::string stopOf(const std::string& sections, const std::vector<std::string>& overrides = {}) {
  const std::string text = "version = 1\n[run]\nduration = 0.1\ntime_step = 1e-4\ngravity = [0, 0, 0]\nthreads = 1\n"
                           "[material.glass]\nstiffness = 1e5\n" +
                           sections;
  Simulation simulation(setup::simulationSetup(setup::parseScene(text, "crowd.toml", overrides)), base::cpuExec(1),
                        [](double, double) {});
  try {
    while (simulation.steps() < 1000) simulation.step();
  } catch (const base::SimulationError& error) {
    return error.what();
  }
  return "";
}

std::string dropAt(const std::string& place, const std::string& start, const std::string& radius = "0.02") {
  return "[[source]]\nlow = " + place + "\nhigh = " + place + "\nradius = " + radius +
         "\nmaterial = \"glass\"\nevery = 0.05\ntotal = 1\nstart = " + start + "\n";
}

void expectParts(const std::string& message, const std::vector<std::string>& parts) {
  for (const std::string& part : parts) EXPECT_NE(message.find(part), std::string::npos) << part << "\n" << message;
}

TEST(Sources, AGrainThatLiesInTheWayStopsTheRunAndBothAreNamed) {
  expectParts(stopOf(dropAt("[0, 0, 1]", "0.0"), {"source.0.total=2"}),
              {"crowd.toml:9: source.0 would insert a grain at (0, 0, 1) m at step 500, time 0.05 s",
               "0.04 m deep in grain 0", "later (start)", "every"});
  EXPECT_EQ(stopOf(dropAt("[0, 0, 1]", "0.0"), {"source.0.total=2", "source.0.velocity=[0, 0, 1]"}), "");
}

TEST(Sources, TheDeepestOfManyInTheWayIsNamed) {
  // 0.03 - 0.021 m and 0.03 - 0.019 m, of radii 0.01 and 0.02 m.
  const std::string two = dropAt("[0.521, 0, 1]", "0.0", "0.01") + dropAt("[0.481, 0, 1]", "0.0", "0.01");
  expectParts(stopOf(two + dropAt("[0.5, 0, 1]", "0.01")),
              {"crowd.toml:25: source.2", "0.011 m deep in grain 1 at (0.481, 0, 1)"});
}

TEST(Sources, AnImageAcrossPeriodicBoundariesLiesInTheWayToo) {
  // Grains 2^32 units of length apart, not 1 m: the low words would match such an image.
  const std::string two = dropAt("[-0.59, 0, 1]", "0.0") + dropAt("[0.59, 0, 1]", "0.01");
  expectParts(stopOf(two, {"run.periodic=[true, false]", "run.domain_x=[-0.6, 0.6]"}),
              {"source.1", "0.02 m deep in grain 0 at (-0.59, 0, 1)"});
  EXPECT_EQ(stopOf(two), "");
}

TEST(Sources, ASurfaceThatForcesHaveMovedLiesInTheWayToo) {
  // Under 100 N a box of 1 kg rises by 50 t^2 = 0.125 m in 0.05 s, and its top reaches 0.175 m.
  const std::string lid = "[[box]]\nname = \"lid\"\nposition = [0, 0, 0]\nsize = [1, 1, 0.1]\nmaterial = \"glass\"\n"
                          "free = \"z\"\nmass = 1\nload = 100\n";
  expectParts(stopOf(lid + dropAt("[0, 0, 0.18]", "0.05")), {"source.0", "step 500", "0.015", "deep in lid"});
  EXPECT_EQ(stopOf(lid + dropAt("[0, 0, 0.2]", "0.05")), "");
}

TEST(Sources, ARunFindsTheRoomThatItsSceneWasFoundToHave) {
  // The second source inserts its grains on a line that is occupied about half of the time.
  constexpr const char* kLine = R"(
[[source]]
low = [-0.2, 0, 2.0]
high = [0.2, 1e-6, 2.000001]
radius = 0.02
material = "glass"
number = 8
every = 0.1
start = 0.0
total = 8
)";
  int found = 0;
  constexpr int kSeeds = 40;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    bool checked = true, thrown = true;
    scene::Scene scene;
    try {
      scene = setup::parseScene(kDrip + std::string(kLine), "drip.toml", {"run.seed=" + std::to_string(seed)});
      setup::checkSources(scene, setup::grainKinds(scene));
    } catch (const base::InputError& error) {
      checked = false;
      EXPECT_NE(std::string(error.what()).find("drip.toml:21: source.1: 8 grains"), std::string::npos) << error.what();
    }
    try {
      sourcesOf(scene).enteringAt(0);
    } catch (const base::InputError&) {
      thrown = false;
    }
    EXPECT_EQ(checked, thrown) << "seed " << seed;
    found += checked;
  }
  EXPECT_GT(found, 0);
  EXPECT_LT(found, kSeeds);
}

} // namespace
} // namespace grouser::coupling
