// SPDX-License-Identifier: BSD-3-Clause
// Laws, radii, materials and blocks of grains, from the scene to the run.
#include "base/error.hpp"
#include "base/math.hpp"
#include "coupling/simulation.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/grain_kinds.hpp"
#include "runs/setup/laws.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/setup/provenance.hpp"
#include "runs/setup/simulation_setup.hpp"
#include "runs/setup/step_limit.hpp"
#include "tests/device_under_test.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

namespace grouser::setup {
namespace {

scene::Scene parse(const std::string& text, const std::vector<std::string>& overrides = {}) {
  return parseScene("version = 1\n[run]\nduration = 0.02\n" + text, ::testing::TempDir() + "/scene.toml", overrides);
}

const char* kMixed = R"([material.glass]
law = "hertz"
young = 1e8
poisson = 0.2
restitution = 0.8
friction = 0.4
rolling_friction = 0.02
[material.clay]
law = "hertz"
young = 2e7
poisson = 0.4
density = 1600
restitution = 0.4
friction = 0.6
rolling_friction = 0.1
cohesion = 0.2
[[plane]]
material = "glass"
[[grain]]
position = [0, 0, 0.05]
radius = 0.02
material = "glass"
[[grains]]
form = "random"
low = [-0.2, -0.2, 0.1]
high = [0.2, 0.2, 0.4]
radius = 0.01
radius_to = 0.02
number = 150
velocity = [0, 0, -1]
material = "clay"
)";

TEST(PairLaw, HertzMixesModuliAndTakesTheSmallerOfTheRest) {
  const scene::Scene s = parse(kMixed);
  const auto law = pairLaw(s, "glass", "clay", std::nullopt);
  const double effective = 1 / ((1 - 0.04) / 1e8 + (1 - 0.16) / 2e7);
  const double shear = 1 / (1.8 / (1e8 / 2.4) + 1.6 / (2e7 / 2.8));
  EXPECT_TRUE(law.hertz);
  EXPECT_NEAR(law.stiffness, 4.0 / 3 * effective, 1e-9 * effective);
  EXPECT_NEAR(law.tangentialStiffness, 8 * shear, 1e-9 * shear);
  EXPECT_EQ(law.friction, 0.4);
  EXPECT_EQ(law.rollingFriction, 0.02);
  EXPECT_EQ(law.pullPerRadius, 0) << "geometric mean with one material without cohesion";
  EXPECT_NEAR(pairLaw(s, "clay", "clay", std::nullopt).pullPerRadius, 2 * base::kPi * 0.2, 1e-12);
  const scene::Scene over =
      parse(std::string(kMixed) + "[contact.\"clay|glass\"]\nrolling_friction = 0.3\ncohesion = 1\n");
  EXPECT_EQ(pairLaw(over, "glass", "clay", std::nullopt).rollingFriction, 0.3);
  EXPECT_NEAR(pairLaw(over, "glass", "clay", std::nullopt).pullPerRadius, 2 * base::kPi, 1e-12);
}

TEST(PairLaw, LinearAndHertzDoNotMeet) {
  const scene::Scene s =
      parse("[material.a]\n[material.b]\nlaw = \"hertz\"\nyoung = 1e8\n[[grain]]\nposition = [0, 0, 1]\n"
            "radius = 0.1\nmaterial = \"a\"\n");
  EXPECT_THROW(pairLaw(s, "a", "b", 1.0), base::InputError);
}

TEST(PairLaw, LinearOfManyMassesGivesTheSameRestitutionToAll) {
  const scene::Scene s =
      parse("[material.a]\nrestitution = 0.4\n[[grain]]\nposition = [0, 0, 1]\nradius = 0.1\nmaterial = "
            "\"a\"\n");
  for (const double mass : {0.01, 3.0}) {
    const auto one = pairLaw(s, "a", "a", mass), any = pairLaw(s, "a", "a", std::nullopt);
    const auto c = contact::coefficientsOf<contact::kGeneral>(any, 1e-4, mass, 0.1);
    EXPECT_NEAR(c.damping, one.damping * mass, 1e-12 * c.damping);
  }
}

TEST(Blocks, LatticeFillsItsBoxAndRandomGrainsDoNotTouch) {
  scene::Scene s =
      parse("[material.a]\n[[grains]]\nlow = [0, 0, 0]\nhigh = [1, 0.5, 0.25]\nradius = 0.05\nspacing = 2\n"
            "material = \"a\"\n");
  EXPECT_EQ(placedCount(s), 10 * 5 * 2);
  EXPECT_EQ(placedGrains(s).size(), 100u);
  s = parse(kMixed);
  const std::vector<scene::Grain> all = placedGrains(s);
  ASSERT_EQ(all.size(), 151u);
  double smallest = 1, largest = 0;
  for (std::size_t i = 1; i < all.size(); ++i) {
    smallest = std::min(smallest, all[i].radius), largest = std::max(largest, all[i].radius);
    for (int a = 0; a < 3; ++a) {
      EXPECT_GE(all[i].position[a] - all[i].radius, (*s.fills[0].low)[a] - 1e-12);
      EXPECT_LE(all[i].position[a] + all[i].radius, (*s.fills[0].high)[a] + 1e-12);
    }
    for (std::size_t j = 1; j < i; ++j)
      EXPECT_GT(norm(all[i].position - all[j].position), all[i].radius + all[j].radius);
  }
  EXPECT_LT(smallest, 0.0105);
  EXPECT_GT(largest, 0.0195);
  EXPECT_THROW(placedGrains(parse(kMixed, {"grains.0.number=100000"})), base::InputError);
}

TEST(Blocks, LatticeThatIsShiftedStaysInItsBox) {
  const scene::Scene s =
      parse("[material.a]\n[[grains]]\nlow = [0, 0, 0]\nhigh = [1, 0.5, 0.25]\nradius = 0.05\nspacing = 2.6\n"
            "jitter = 1.0\nmaterial = \"a\"\n");
  const std::vector<scene::Grain> all = placedGrains(s);
  EXPECT_EQ(placedCount(s), 7 * 3 * 1);
  for (const scene::Grain& g : all)
    for (int a = 0; a < 3; ++a) {
      EXPECT_GE(g.position[a] - g.radius, 0);
      EXPECT_LE(g.position[a] + g.radius, (*s.fills[0].high)[a]);
    }
}

TEST(Blocks, FileIsReadAndABrokenLineNamed) {
  const std::string good = ::testing::TempDir() + "/places.txt", bad = ::testing::TempDir() + "/broken.txt";
  std::ofstream(good) << "# x y z r\n0, 0, 1, 0.1\n0.5 0 1 0.2  # larger\n\n";
  std::ofstream(bad) << "0 0 1 0.1\n0 0 2\n";
  const std::string scene = "[material.a]\n[[grains]]\nform = \"file\"\nmaterial = \"a\"\nfile = ";
  const scene::Scene s = parse(scene + "\"" + good + "\"\n");
  ASSERT_EQ(placedGrains(s).size(), 2u);
  EXPECT_EQ(placedGrains(s)[1].radius, 0.2);
  EXPECT_EQ(grainKinds(s).smallest, 0.1);
  try {
    parse(scene + "\"" + bad + "\"\n");
    FAIL();
  } catch (const base::InputError& e) {
    EXPECT_NE(std::string(e.what()).find("broken.txt:2"), std::string::npos) << e.what();
  }
}

TEST(Blocks, FileMayGiveVelocitiesAndSpinsAndNamesTheLineThatIsNone) {
  const std::string file = ::testing::TempDir() + "/moving.txt";
  const auto read = [&](const std::string& lines, const std::vector<std::string>& overrides = {}) {
    std::ofstream(file) << lines;
    return parse("[material.a]\n[[grains]]\nform = \"file\"\nmaterial = \"a\"\nvelocity = [0, 0, -1]\n"
                 "spin = [0, 2, 0]\nfile = \"" +
                     file + "\"\n",
                 overrides);
  };
  std::vector<scene::Grain> all;
  for (const char* line : {"0, 0, 1, 0.1\n", "1, 0, 1, 0.1, 0.5, +0.25, 0\n", "2, 0, 1, 0.1, 1e-1, 0, 0, 7, 8, -9\n"})
    all.push_back(placedGrains(read(line)).front());
  EXPECT_EQ(all[0].velocity, (base::Vec3d{0, 0, -1})) << "the section's value";
  EXPECT_EQ(all[1].velocity, (base::Vec3d{0.5, 0.25, 0}));
  EXPECT_EQ(all[1].spin, (base::Vec3d{0, 2, 0}));
  EXPECT_EQ(all[2].velocity, (base::Vec3d{0.1, 0, 0}));
  EXPECT_EQ(all[2].spin, (base::Vec3d{7, 8, -9}));
  for (const char* bad :
       {"1 0 1 0.1 5", "1 0 1 0.1 5 5", "1 0 1 0.1 1 2 3 4", "1 0 1 0.1 1 2 x", "1 0 1 0.1 1 2 3 4 5 6 7",
        "1 0 1 0.1 1 2 -", "1 0 1 0.1 nan 0 0", "1 0 1 0.1 2e4 0 0", "1 0 1 -0.1 0 0 0"}) {
    try {
      read(std::string("0 0 1 0.1 0 0 0\n") + bad + "\n");
      ADD_FAILURE() << bad << " was accepted";
    } catch (const base::InputError& e) {
      EXPECT_NE(std::string(e.what()).find("moving.txt:2:"), std::string::npos) << e.what();
    }
  }
  const std::string inputs = inputsOf(read("0 0 1 0.1\n"));
  EXPECT_NE(inputs, inputsOf(read("0 0 1 0.2\n"))) << "a modified file changes the scene";
  const scene::Scene quick = read("0 0 1 0.1 100 0 0\n");
  EXPECT_THROW(checkSpeeds(quick, ContactPairs(quick), 1e-3), base::InputError) << "beyond the skin in one step";
  EXPECT_NO_THROW(checkSpeeds(quick, ContactPairs(quick), 1e-5));
}

TEST(ManyKindsScene, RunsToOneAnswerInEitherPrecisionAndResumes) {
  for (const std::string precision : {"single", "double"}) {
    const scene::Scene s = parse(kMixed, {"run.precision=" + precision});
    const auto quiet = [](double, double) {};
    coupling::Simulation one(simulationSetup(s), base::cpuExec(1), quiet),
        two(simulationSetup(s), base::cpuExec(2), quiet);
    EXPECT_EQ(one.ground().grains->system().constants.features & contact::kRollingFriction, contact::kRollingFriction);
    for (int i = 0; i < 300; ++i) one.step(), two.step();
    const coupling::SimulationState saved = one.save();
    EXPECT_EQ(one.stateHash(), two.stateHash());
    coupling::Simulation resumed(simulationSetup(s), base::cpuExec(1), saved);
    for (int i = 0; i < 200; ++i) one.step(), resumed.step();
    EXPECT_EQ(one.stateHash(), resumed.stateHash());
    const auto ledger = one.ledger();
    EXPECT_LT(std::fabs(ledger.integrationError), 0.02 * std::fabs(ledger.potential) + 1e-3)
        << "first order in the step";
  }
}

TEST(ManyKindsScene, StepFollowsTheImpactSpeedAndTheSmallestGrain) {
  const scene::Scene s = parse(kMixed);
  const double automatic = chooseTimeStep(s), limit = stepLimit(s).step;
  EXPECT_LE(automatic, 0.5 * limit);
  // Glass against the plane, the stiffest: contact time at 1 m/s over 20, or the Rayleigh time.
  EXPECT_LE(automatic, shortestContact(s) / scene::kStepsPerContact * 1.0000001);
  EXPECT_LT(chooseTimeStep(parse(kMixed, {"run.impact_speed=10"})), automatic);
  EXPECT_LT(chooseTimeStep(parse(kMixed, {"grains.0.radius=0.001"})), 0.5 * automatic);
  EXPECT_THROW(chooseTimeStep(parse(kMixed, {"run.time_step=" + std::to_string(1.1 * limit)})), base::InputError);
}

} // namespace
} // namespace grouser::setup
