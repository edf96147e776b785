// SPDX-License-Identifier: BSD-3-Clause
// The guard stops runs whose time integration creates or loses energy, at fixed steps, and no other runs.
#include "base/error.hpp"
#include "coupling/simulation.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/ground_setup.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/setup/simulation_setup.hpp"
#include "runs/setup/step_limit.hpp"

#include <gtest/gtest.h>

#include <fmt/format.h>

namespace grouser::coupling {
namespace {

Ledger books(double error, double turnover) {
  Ledger l;
  l.integrationError = error, l.turnover = turnover;
  return l;
}

TEST(EnergyGuard, JudgesBothSignsAgainstWhatWasExchangedSinceTheLastLook) {
  EnergyGuard guard;
  guard.look(books(5, 1000));
  EXPECT_EQ(guard.judge(books(5 + 3.9, 1010), 0), "") << "allowed loss: 0.3 of 10 J plus 0.001 of 1010 J";
  EXPECT_NE(guard.judge(books(5 + 4.1, 1010), 0).find("lost 4.1 J"), std::string::npos);
  EXPECT_EQ(guard.judge(books(5 - 1.9, 1010), 0), "") << "allowed gain: 0.1 of 10 J plus 0.001 of 1010 J";
  EXPECT_NE(guard.judge(books(5 - 2.1, 1010), 0), "");
  EXPECT_NE(guard.judge(books(5 - 3.6, 1010), 0).find("created 3.6 J"), std::string::npos);
  EXPECT_EQ(guard.judge(books(5 - 3.6, 1010), 1e7), "") << "rounding of 10 MJ";
}

TEST(EnergyGuard, WorkOfDrivesAndLossesCountAsExchanged) {
  EnergyGuard guard;
  Ledger l = books(-3, 0);
  EXPECT_NE(guard.judge(l, 0), "");
  l.driveWork = -31;
  EXPECT_EQ(guard.judge(l, 0), "");
  l.driveWork = 0, l.dissipated.friction = 31;
  EXPECT_EQ(guard.judge(l, 0), "");
}

TEST(EnergyGuard, WhatIsDissipatedAtOnceMayBeALittleMore) {
  EnergyGuard guard;
  guard.look(books(0, 1000));
  Ledger l = books(-2.6, 1010);
  EXPECT_NE(guard.judge(l, 0), "") << "of 10 J";
  l.dissipated.friction = 2.6;
  EXPECT_EQ(guard.judge(l, 0), "") << "0.15 of 12.6 J, and 1.01 J";
  l.integrationError = -3.1;
  EXPECT_NE(guard.judge(l, 0), "");
}

TEST(EnergyGuard, AQuarterOfWhatSpringsTakeUpIsNoAlarm) {
  EnergyGuard guard;
  guard.look(books(0, 0));
  Ledger l = books(0.9, 1);
  EXPECT_NE(guard.judge(l, 0), "");
  l.elastic = -2.5; // 0.3 + 0.001 + 0.625
  EXPECT_EQ(guard.judge(l, 0), "");
  guard.look(l); // spring energy unchanged
  l.integrationError += 0.9, l.turnover += 1;
  EXPECT_NE(guard.judge(l, 0), "");
}

TEST(EnergyGuard, WhereDampersGiveWhatTheStepsLoseNothingIsMade) {
  EnergyGuard guard;
  guard.look(books(0, 0));
  Ledger l = books(0.5, 10);
  l.dissipated.damping = -0.6;
  EXPECT_EQ(guard.judge(l, 0), "") << "a gain of a tenth of a joule";
  l.dissipated.damping = -0.9;
  EXPECT_NE(guard.judge(l, 0).find("dampers created 0.4 J"), std::string::npos) << guard.judge(l, 0);
}

TEST(EnergyGuard, WorkOfDrivesBeforeTheLastLookHidesNothing) {
  EnergyGuard guard;
  Ledger l = books(0, 0);
  l.driveWork = 100;
  guard.look(l);
  l.integrationError = -3;
  EXPECT_NE(guard.judge(l, 0), "") << "no energy exchanged since then";
}

TEST(EnergyGuard, DampersThatGiveEnergyAreSeen) {
  EnergyGuard guard;
  Ledger l = books(0, 100);
  l.dissipated = {5, 2, 0, 0, 0};
  guard.look(l);
  l.turnover = 110;
  l.dissipated.damping = 4.9;
  EXPECT_EQ(guard.judge(l, 0), "");
  l.dissipated.damping = 4.5;
  EXPECT_NE(guard.judge(l, 0).find("dampers"), std::string::npos);
}

/// A vehicle after some time of driving.
Ledger booksOfParts() {
  Ledger l = books(0, 1e5);
  l.dissipated.parts = 500, l.dissipated.joints = 1500;
  return l;
}

TEST(EnergyGuard, WhatStepsMakeInContactsOfPartsIsHeldAgainstWhatIsDissipated) {
  EnergyGuard guard;
  Ledger l = booksOfParts();
  guard.look(l);
  l.turnover += 1000, l.dissipated.parts += 400;
  l.integrationError = -130; // a tenth of the other 270 J, and a thousandth of the 103,400 J ever exchanged: 130.4 J
  EXPECT_EQ(guard.judge(l, 0), "");
  l.integrationError = -131;
  EXPECT_NE(guard.judge(l, 0).find("created 131 J of the 400 J dissipated since the last check"), std::string::npos);
  l.dissipated.joints += 20;
  EXPECT_EQ(guard.judge(l, 0), "") << "of 420 J";
  l.dissipated = {};
  l.dissipated.damping = 2400;
  EXPECT_EQ(guard.judge(l, 0), "") << "grain contacts are compared with their exchanged energy";
}

/// Numbers of 1.8 million grains of loam under a vehicle during track tensioning.
TEST(EnergyGuard, ABedThatBreathesBeforeAVehicleHasDissipatedMuchIsNoAlarm) {
  EnergyGuard guard;
  Ledger l = books(-0.074, 0.38);
  l.dissipated.parts = 0.3, l.dissipated.damping = 0.08;
  l.elastic = -2;
  EXPECT_NE(guard.judge(l, 0), "") << "elastic energy of the vehicle hides no error";
  guard.look(l);
  EXPECT_NE(guard.judge(l, 0).find("since the start"), std::string::npos);
  l.grainElastic = -2; // a tenth of the other 0.306 J, a thousandth of 0.76 J, and a quarter of 0.3 J
  EXPECT_EQ(guard.judge(l, 0), "");
  EnergyGuard later = guard, restored;
  l.grainElastic = -0.1;
  EXPECT_NE(guard.judge(l, 0).find("since the start"), std::string::npos) << "with less elastic energy, less is hidden";
  l.grainElastic = -2;
  later.look(l);
  restored.restore(later.save());
  l.grainElastic = -0.1;
  EXPECT_EQ(later.judge(l, 0), "") << "the bed's oscillation is allowed";
  EXPECT_EQ(restored.judge(l, 0), "");
  l.integrationError = -0.11; // the last check: no change since then
  guard.look(l), later.look(l);
  EXPECT_NE(later.judge(l, 0).find("since the start"), std::string::npos) << "regardless of the bed's elastic energy";
}

/// Numbers of 1.8 million grains 1024 steps after the start: the bed's contacts seem to have released more than parts
/// dissipated. Without a hundredth of 4.1 J the limit would be 0.016 J.
TEST(EnergyGuard, ABedThatHoldsMuchMoreThanPartsHaveTakenHidesAHundredthOfIt) {
  EnergyGuard guard;
  Ledger l = books(-0.035, 0.21);
  l.dissipated.parts = 0.044, l.dissipated.joints = 0.041, l.dissipated.damping = -0.105,
  l.dissipated.friction = -0.066;
  l.elastic = l.grainElastic = 4.1;
  guard.look(l);
  EXPECT_EQ(guard.judge(l, 0), "") << "a tenth of the other 0.05 J, and a hundredth of 4.1 J, are 0.0463 J";
  l.integrationError = -0.05;
  guard.look(l);
  EXPECT_NE(guard.judge(l, 0).find("created 0.05 J of the 0.085 J dissipated since the start"), std::string::npos)
      << guard.judge(l, 0);
}

/// Numbers of 1.5 million grains 0.75 m deep, 512 steps after the start: total weight times radius is 2800 J.
TEST(EnergyGuard, WhatIsNothingBesideTheWeightOfABedIsNoAlarm) {
  EnergyGuard guard;
  Ledger l = books(-0.0231, 0.3);
  l.dissipated.parts = 0.0398, l.dissipated.joints = 0.0418, l.dissipated.damping = -0.05;
  l.elastic = l.grainElastic = 1;
  guard.look(l);
  EXPECT_NE(guard.judge(l, 0).find("created 0.0231 J of the 0.0816 J dissipated since the start"), std::string::npos)
      << guard.judge(l, 0);
  EXPECT_EQ(guard.judge(l, 2800), "");
  for (const bool made : {true, false}) {
    Ledger more = l;
    more.integrationError = made ? -0.29 : -0.2;
    if (!made) more.dissipated.parts = 0.25;
    guard.look(more);
    EXPECT_NE(guard.judge(more, 2800).find("since the start"), std::string::npos) << "more than 0.28 J";
  }
}

/// The same later: if the losses of parts were subtracted from the apparent gain of grains, the limit would be 0.03 J.
TEST(EnergyGuard, WhatGrainsSeemToGiveDoesNotLessenWhatPartsHaveDissipated) {
  EnergyGuard guard;
  Ledger l = books(-0.15, 2.1);
  l.dissipated.parts = 0.44, l.dissipated.joints = 0.41, l.dissipated.damping = -0.9, l.dissipated.friction = -0.6;
  l.elastic = l.grainElastic = 4.1;
  guard.look(l);
  EXPECT_EQ(guard.judge(l, 0), "") << "a tenth of the other 0.7 J, and a quarter of 0.44 J, are 0.18 J";
  // Since the last check: springs store nothing, and dashpots of grains seem to release what parts dissipate.
  l.turnover += 3, l.integrationError -= 0.05, l.dissipated.parts += 1, l.dissipated.damping -= 0.9;
  EXPECT_EQ(guard.judge(l, 0), "") << "a tenth of the other 0.95 J";
  l.integrationError -= 0.06;
  EXPECT_NE(guard.judge(l, 0).find("created 0.11 J of the 1 J dissipated since the last check"), std::string::npos)
      << guard.judge(l, 0);
}

TEST(EnergyGuard, WhatStepsMakeInContactsOfPartsAddsUp) {
  EnergyGuard guard;
  Ledger l = booksOfParts();
  guard.look(l);
  for (int look = 1; look <= 6; ++look) {
    l.turnover += 1000, l.dissipated.parts += 100, l.integrationError -= 55;
    // The last time 330 J: a tenth of the other 2270 J plus a thousandth of 108,600 J are 335.6 J.
    EXPECT_EQ(guard.judge(l, 0), "") << look;
    guard.look(l);
  }
  l.turnover += 1000, l.dissipated.parts += 100, l.integrationError -= 55; // 385 J beside 231.5 J and 109.7 J
  EXPECT_NE(guard.judge(l, 0).find("created 385 J of the 2.7e+03 J dissipated since the start"), std::string::npos)
      << guard.judge(l, 0);
}

TEST(EnergyGuard, IsRestored) {
  EnergyGuard a, b;
  Ledger l = books(5, 1000);
  l.driveWork = 7, l.elastic = 30;
  a.look(l);
  b.restore(a.save());
  for (const double error : {4.0, 2.0, 1.0, 11.0, 12.0}) {
    l.integrationError = error, l.turnover = 1010;
    EXPECT_EQ(a.judge(l, 0), b.judge(l, 0));
  }
  EXPECT_THROW(b.restore({1, 2}), base::InputError);
}

/// A heap of `number` grains in a box, with `more` keys of the material.
std::string heap(int number, const std::string& material, const std::string& velocity = "[0, 0, 0]") {
  std::string text = fmt::format("version = 1\n[run]\nduration = 1.0\n[material.soil]\ndensity = 2500\n{}\n"
                                 "[[grains]]\nform = \"random\"\nlow = [-0.04, -0.04, 0]\nhigh = [0.04, 0.04, 0.15]\n"
                                 "number = {}\nradius = 0.005\nvelocity = {}\nmaterial = \"soil\"\n",
                                 material, number, velocity);
  for (const char* plane :
       {"[0, 0, 0]\nnormal = [0, 0, 1]", "[-0.04, 0, 0]\nnormal = [1, 0, 0]", "[0.04, 0, 0]\nnormal = [-1, 0, 0]",
        "[0, -0.04, 0]\nnormal = [0, 1, 0]", "[0, 0.04, 0]\nnormal = [0, -1, 0]"})
    text += fmt::format("[[plane]]\npoint = {}\nmaterial = \"soil\"\n", plane);
  return text;
}

/// Steps of `share` of the limit, also above it, where a scene file is rejected.
Simulation simulationAt(const std::string& text, double share) {
  const scene::Scene scene = setup::parseScene(text, "heap.toml");
  SimulationSetup setup = setup::simulationSetup(scene);
  setup.timeStep = share * setup::stepLimit(scene).step;
  setup.ground = setup::groundSetup(scene, setup.timeStep);
  return Simulation(std::move(setup), base::cpuExec(1), [](double, double) {});
}

/// Two grains pressed together, from rest: the first step adds m v^2 / 2 and takes m v^2 from the spring.
TEST(EnergyGuard, AFewStepsAreNotJudgedBeforeAContactIsOver) {
  const scene::Scene scene = setup::parseScene(
      "version = 1\n[run]\nduration = 1\ntime_step = 1e-4\ngravity = [0, 0, 0]\n[material.soil]\nstiffness = 1e5\n"
      "restitution = 1\n[[grain]]\nposition = [0, 0, 1]\nradius = 0.03\nmaterial = \"soil\"\n"
      "[[grain]]\nposition = [0.058, 0, 1]\nradius = 0.03\nmaterial = \"soil\"\n",
      "pressed.toml");
  Simulation simulation(setup::simulationSetup(scene), base::cpuExec(1), [](double, double) {});
  simulation.step();
  const Ledger after = simulation.ledger();
  ASSERT_GT(std::fabs(after.integrationError), EnergyGuard::kMaxLost * after.turnover) << "no significant error";
  EXPECT_NO_THROW(simulation.checkEnergy());
}

struct Material {
  const char *name, *text, *velocity;
};
class Heaps : public ::testing::TestWithParam<Material> {};

TEST_P(Heaps, AreSoundUpToTheLimit) {
  for (const double share : {0.5, 0.75, 1.0}) {
    Simulation simulation = simulationAt(heap(200, GetParam().text, GetParam().velocity), share);
    EXPECT_NO_THROW(while (simulation.time() < 0.25) simulation.step(); simulation.checkEnergy()) << share;
  }
}

TEST_P(Heaps, AreStoppedFarBeyondIt) {
  Simulation simulation = simulationAt(heap(200, GetParam().text, GetParam().velocity), 7);
  try {
    while (simulation.time() < 0.5) simulation.step();
    simulation.checkEnergy();
    FAIL() << "ran";
  } catch (const base::SimulationError& error) {
    EXPECT_NE(std::string(error.what()).find("time_step"), std::string::npos) << error.what();
  }
}

INSTANTIATE_TEST_SUITE_P(
    EnergyGuard, Heaps,
    ::testing::Values(
        Material{"Plain", "stiffness = 2e4\nrestitution = 0.5\nfriction = 0.5", "[0, 0, 0]"},
        Material{"Elastic", "stiffness = 2e4\nrestitution = 1\nfriction = 0", "[0, 0, 0]"},
        Material{"ElasticRough", "stiffness = 2e4\nrestitution = 1\nfriction = 0.5", "[0, 0, 0]"},
        Material{"Lossy", "stiffness = 2e4\nrestitution = 0.1\nfriction = 0.9", "[0, 0, -1]"},
        Material{"Rolling", "stiffness = 2e4\nrestitution = 0.4\nfriction = 0.5\nrolling_friction = 0.2", "[0, 0, 0]"},
        Material{"Sticky", "stiffness = 2e4\nrestitution = 0.4\nfriction = 0.5\ncohesion = 0.05", "[0, 0, 0]"},
        Material{"Pulling", "stiffness = 2e4\nrestitution = 0.5\nfriction = 0.5\nattraction = true", "[0, 0, 0]"},
        Material{"Stiff", "stiffness = 1e6\nrestitution = 0.3\nfriction = 0.8", "[0.5, 0, -1]"}),
    [](const auto& heap) { return std::string(heap.param.name); });

TEST(EnergyGuard, RemembersWhatItHasSeenAtEveryLook) {
  Simulation simulation = simulationAt(heap(100, "stiffness = 2e4\nrestitution = 0.5\nfriction = 0.5"), 0.5);
  double most = 0;
  for (const int look : {1, 2, 3}) {
    while (simulation.steps() < look * EnergyGuard::kInterval) simulation.step();
    const Ledger l = simulation.ledger();
    most = std::max(most, std::fabs(l.grainElastic));
    EXPECT_EQ(simulation.save().guard, (std::vector<double>{l.integrationError, l.turnover, l.dissipated.total(),
                                                            l.driveWork, l.elastic, l.dissipated.ofGrains(), most}));
  }
}

TEST(EnergyGuard, WhatRestsOnAVeryStiffPlaneIsNoAlarm) {
  // Its overlap, a millionth of the radius, is some tens of the position resolution: this is its weight's work, and
  // hardly any other energy is exchanged.
  const double radius = 0.045, stiffness = 4.5e8,
               weight = 2500 * 4 / 3.0 * 3.14159265 * radius * radius * radius * 9.81;
  const std::string text = fmt::format(
      "version = 1\n[run]\nduration = 1\ntime_step = 6e-7\ngravity = [2, 0, -9.6]\n[material.a]\nstiffness = {}\n"
      "friction = 0.8\n[[plane]]\nmaterial = \"a\"\n[[grain]]\nradius = {}\nmaterial = \"a\"\n"
      "position = [0, 0, {}]\n",
      stiffness, radius, radius - weight / stiffness);
  Simulation simulation(setup::simulationSetup(setup::parseScene(text, "ball.toml")), base::cpuExec(1),
                        [](double, double) {});
  while (simulation.steps() < 4 * EnergyGuard::kInterval) simulation.step();
}

TEST(EnergyGuard, TheToleranceOfASolverIsNoAlarm) {
  const double floor = EnergyGuard::solverError(100, 1e-4, 1e-3); // 100 N x 0.1 mm/s x 512 ms
  EXPECT_NEAR(floor, 5.12e-3, 1e-15);
  for (const double sign : {-1.0, 1.0}) {
    EnergyGuard guard;
    EXPECT_EQ(guard.judge(books(sign * 0.99 * floor, 0), 0, floor), "");
    EXPECT_NE(guard.judge(books(sign * 0.99 * floor, 0), 0), "") << "explicit steps";
    EXPECT_EQ(guard.judge(books(sign * 1.01 * floor, 0), 0, floor).empty(), sign > 0)
        << "implicit steps may lose energy";
  }
}

TEST(EnergyGuard, ElasticImpactsOfGrainsDissipateNothing) {
  EnergyGuard guard;
  Ledger l = books(-1, 10);
  l.dissipated.damping = -1e-18; // rounding
  EXPECT_EQ(guard.judge(l, 0, 0.0), "") << "a tenth of the 10 J exchanged";
  l.dissipated.parts = 1e-3;
  EXPECT_NE(guard.judge(l, 0, 0.0).find("of the 0.001 J dissipated"), std::string::npos) << "contacts of parts";
}

/// Runs a scene with complementarity contacts, with all checks of its energy.
void expectSound(const std::string& material, const std::string& grains, double duration) {
  const std::string text = "version = 1\n[run]\nduration = 20\ncontact = \"complementarity\"\n[material.a]\n" +
                           material + "\n[[plane]]\nmaterial = \"a\"\n" + grains;
  Simulation simulation(setup::simulationSetup(setup::parseScene(text, "rest.toml")), base::cpuExec(1),
                        [](double, double) {});
  EXPECT_NO_THROW(while (simulation.time() < duration) simulation.step(); simulation.checkEnergy()) << text;
}

TEST(EnergyGuard, GrainsAtRestOnComplementarityContactsAreNoAlarm) {
  for (const char* stiffness : {"1e4", "1e6", "1e8"}) {
    const std::string material = fmt::format("stiffness = {}", stiffness);
    for (const char* radius : {"0.001", "0.01", "0.1"})
      expectSound(material, fmt::format("[[grain]]\nposition = [0, 0, {0}]\nradius = {0}\nmaterial = \"a\"\n", radius),
                  3);
    std::string pile; // a pyramid of 55 grains
    for (int layer = 0; layer < 5; ++layer)
      for (int k = 0; k < (5 - layer) * (5 - layer); ++k)
        pile += fmt::format("[[grain]]\nposition = [{:.6f}, {:.6f}, {:.6f}]\nradius = 0.01\nmaterial = \"a\"\n",
                            0.01 * layer + 0.02 * (k % (5 - layer)), 0.01 * layer + 0.02 * (k / (5 - layer)),
                            0.01 + 0.02 * layer * 0.70710678);
    expectSound(material + "\nfriction = 0.8\nrolling_friction = 0.1", pile, 1);
  }
}

TEST(EnergyGuard, ABallThatReboundsWithoutLossIsNoAlarm) {
  for (const char* friction : {"0", "0.5"})
    expectSound(fmt::format("stiffness = 1e6\nrestitution = 1\nfriction = {}", friction),
                "[[grain]]\nposition = [0, 0, 0.0201]\nvelocity = [0.05, 0, 0]\nradius = 0.01\nmaterial = \"a\"\n", 3);
}

TEST(EnergyGuard, VerdictFallsAtTheSameStepInBatchesAndAlone) {
  const auto stopped = [](int most) {
    Simulation simulation = simulationAt(heap(200, "stiffness = 2e4\nrestitution = 1\nfriction = 0.5"), 3.5);
    try {
      while (simulation.time() < 0.5) simulation.advance(most);
    } catch (const base::SimulationError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  const std::string one = stopped(1);
  EXPECT_NE(one, "");
  EXPECT_EQ(one, stopped(16));
  EXPECT_EQ(one, stopped(37));
}

} // namespace
} // namespace grouser::coupling
