// SPDX-License-Identifier: BSD-3-Clause
// A vehicle on rigid ground with a towed load: forces, a sled, and a carriage that imposes its slip.
#include "base/error.hpp"
#include "runs/setup/load_scene.hpp"
#include "tests/system/driven_fixture.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <fmt/format.h>
#include <vector>

namespace grouser::coupling {
namespace {

using base::Vec3d;

/// On level rigid ground, 20 m long.
scene::Scene sceneWith(const std::string& hitch, double speed = 2, double step = 1e-4) {
  return setup::parseScene(
      fmt::format("version = 1\n[run]\nduration = 6\ntime_step = {1}\n[material.steel]\nstiffness = 1e6\n"
                  "friction = 0.5\n[terrain]\nkind = \"rigid\"\nheightmap = \"heightmaps/flat.png\"\nsize = [20, 3]\n"
                  "height_range = [0, 0]\nmaterial = \"steel\"\n[vehicle]\n"
                  "spec = \"vehicles/light_tracked.toml\"\nsphere_radius = 0.03\nhull_touches = false\n"
                  "position = [10, 0]\n[driver]\nsprocket_speed = {2}\n{0}",
                  hitch.empty() ? "" : "[hitch]\n" + hitch, step, speed),
      GROUSER_SOURCE_DIR "/tests/scenes/rigid.toml");
}

/// Mean state of the hitch from `from` to `to` [s].
HitchObservation meanOver(Simulation& simulation, double from, double to) {
  advance(simulation, from);
  simulation.restartMeans();
  advance(simulation, to);
  return simulation.vehicle()->towing()->observe();
}

double weightOf(const Simulation& simulation) { return simulation.vehicle()->assembly().mass * 9.81; }

/// All shoes on the ground slide straight back.
TEST(Towing, AtHighSlipACarriageIsPulledByTheFrictionOfTheWholeWeight) {
  Simulation simulation = begin(sceneWith("kind = \"speed\"\nslip = 0.4\n"));
  advance(simulation, 1.5);
  const double falling = simulation.ledger().momentum.z;
  const HitchObservation o = meanOver(simulation, 1.5, 2.5);
  const double borne = weightOf(simulation) + simulation.ledger().momentum.z - falling; // mean ground force, 1 s
  const double friction = simulation.vehicle()->assembly().spec.contact.frictionGround;
  const double coefficient = o.pull / weightOf(simulation);
  const double ground = simulation.vehicle()->meanGroundForce().z;
  std::printf("ground force / weight %.5f, with what it falls %.5f; pull / ground force %.5f\n",
              ground / weightOf(simulation), borne / weightOf(simulation), o.pull / ground);
  const double imposed = 0.6 * 2 * simulation.vehicle()->assembly().spec.pitchRadius();
  std::printf("pull / weight = %.5f at friction %.2f, speed / imposed %.6f, thrust / weight %.5f\n", coefficient,
              friction, o.speed / imposed, simulation.vehicle()->observe().netThrust / weightOf(simulation));
  EXPECT_NEAR(coefficient, friction, 0.02 * friction);
  // The hull still oscillates on its arms, so the mean ground load is not exactly the weight. Friction on that load
  // equals the pull, except for shoes that turn at the end of the ground contact, and m a along the track.
  EXPECT_NEAR(ground / borne, 1, 1e-4) << "impulse equals momentum";
  EXPECT_NEAR(o.pull / ground, friction, 2e-3 * friction);
  // The bar yields by pull / stiffness = 2.7 mm; a tenth of that varies with the pull within a second.
  EXPECT_NEAR(o.speed, imposed, 3e-3 * imposed);
  EXPECT_NEAR(o.power, o.pull * o.speed, 0.01 * o.power);
  EXPECT_EQ(simulation.vehicle()->observe().drawbarPull, o.pull);
  const Ledger l = simulation.ledger();
  EXPECT_LT(std::fabs(l.residual), 1e-9 * l.turnover);
  EXPECT_LT(norm(l.momentumResidual), 1e-9 * weightOf(simulation) * simulation.time());
}

/// Locked sprockets, a force moves the vehicle over the ground: the excess of pull over friction accelerates it.
TEST(Towing, AForceBeyondFrictionAcceleratesTheVehicle) {
  Simulation simulation = begin(sceneWith("kind = \"force\"\nforce = 60e3\nramp = 0\n", 0));
  advance(simulation, 0.9);
  while (!simulation.vehicle()->driveStart() || simulation.time() < *simulation.vehicle()->driveStart() + 0.2)
    simulation.step();
  simulation.restartMeans();
  const vehicle::Assembly& assembly = simulation.vehicle()->assembly();
  const auto momentum = [&] { return simulation.ledger().momentum.x; };
  const double before = momentum(), begun = simulation.time();
  advance(simulation, begun + 0.3);
  const HitchObservation o = simulation.vehicle()->towing()->observe();
  const Vec3d load = simulation.vehicle()->meanGroundForce();
  const double ground = load.x;
  EXPECT_NEAR(o.pull, 60e3, 1e-6);
  EXPECT_NEAR(momentum() - before, (ground - 60e3) * 0.3, 1e-6 * 60e3);
  EXPECT_NEAR(ground / load.z, assembly.spec.contact.frictionGround, 0.01) << "the hull still oscillates on its arms";
  EXPECT_LT(simulation.vehicle()->state().twist[0].v.x, -0.1);
  // It slides backwards on locked tracks: the hitch pulls it, the ground resists.
  const vehicle::Observation seen = simulation.vehicle()->observe();
  EXPECT_NEAR(seen.drawbarPull, -60e3, 1e-6);
  EXPECT_EQ(seen.netThrust, -seen.groundForce.x);
}

TEST(Towing, ASledPullsWithItsFriction) {
  Simulation simulation = begin(sceneWith("kind = \"sled\"\nmass = 1500\nfriction = 0.5\n"));
  advance(simulation, 2);
  const double before = simulation.ledger().momentum.x, begun = simulation.time();
  const HitchObservation o = meanOver(simulation, 2, 2 + 6 * 0.31416); // six teeth
  const double friction = 0.5 * 1500 * 9.81, thrust = simulation.vehicle()->meanGroundForce().x;
  std::printf("pull of the sled / mu m g = %.5f, thrust %.5f\n", o.pull / friction, thrust / friction);
  EXPECT_NEAR(o.pull, friction, 0.01 * friction) << "m a from the remaining speed change of the hull";
  EXPECT_NEAR((thrust - o.pull) * (simulation.time() - begun), simulation.ledger().momentum.x - before,
              1e-6 * friction);
}

/// Traction is exceeded once the ramp reaches friction times weight.
TEST(Towing, ARampStopsTheVehicleAtItsFriction) {
  Simulation simulation = begin(sceneWith("kind = \"ramp\"\nforce = 25e3\nrate = 10e3\n", 1));
  const vehicle::Assembly& assembly = simulation.vehicle()->assembly();
  const auto speed = [&] { return simulation.vehicle()->state().twist[0].v.x; };
  constexpr double kRate = 10e3; // [N/s]
  std::vector<double> speeds;    // after each step
  while (simulation.steps() < 30000 && !(simulation.time() > 1.2 && speed() < 0))
    simulation.step(), speeds.push_back(speed());
  simulation.restartMeans();
  simulation.step();
  const double pull = simulation.vehicle()->towing()->observe().pull;
  const double limit = assembly.spec.contact.frictionGround * weightOf(simulation);
  // From the time at which the ramp reaches the limit M v' = -rate t: the residual speed lasts sqrt(2 M v / rate).
  const auto since = static_cast<std::size_t>((pull - limit) / kRate / simulation.timeStep());
  ASSERT_LT(since, speeds.size());
  const double left = speeds[speeds.size() - 1 - since], beyond = std::sqrt(2 * assembly.mass * left * kRate);
  std::printf("a ramp turns the vehicle back at %.4f of friction x weight, %.0f N beyond it by its speed\n",
              pull / limit, beyond);
  EXPECT_NEAR(pull, limit + beyond, 0.03 * limit);
}

/// Bitwise identical for threads, and resumed while the rope oscillates.
void expectOneAnswer(const std::string& hitch) {
  scene::Scene scene = sceneWith(hitch);
  scene.driver.tensionRamp = 0.02, scene.driver.weightRamp = 0.1, scene.driver.driveStart = 0.15;
  scene.driver.driveRamp = 0.05;
  Simulation one = begin(scene, 1), two = begin(scene, 2);
  for (Simulation* s : {&one, &two}) advance(*s, 0.3);
  EXPECT_EQ(two.stateHash(), one.stateHash()) << "threads: " << hitch;
  EXPECT_NE(two.vehicle()->towing()->observe().pull, 0) << "the hitch has state to carry over: " << hitch;
  Simulation resumed(setup::simulationSetup(scene), testExec(2), two.save(), {}, sharedSpheres());
  EXPECT_EQ(resumed.stateHash(), one.stateHash());
  for (Simulation* s : {&one, &resumed}) advance(*s, 0.45);
  EXPECT_EQ(resumed.stateHash(), one.stateHash()) << "resumed, on two threads: " << hitch;
  const HitchObservation o = one.vehicle()->towing()->observe(), r = resumed.vehicle()->towing()->observe();
  EXPECT_EQ(o.work, r.work);
  EXPECT_EQ(o.pull, r.pull);
  EXPECT_NE(o.work, 0);
}

TEST(OneAnswer, OfAVehicleThatTowsASled) { expectOneAnswer("kind = \"sled\"\nmass = 1500\nfriction = 0.5\n"); }

TEST(OneAnswer, OfATowingVehicle) {
  for (const char* hitch : {"kind = \"speed\"\nslip = 0.3\n", "kind = \"ramp\"\nrate = 4000\n"}) expectOneAnswer(hitch);
}

/// Drives, hitch, and stored and dissipated energy of contacts and joints.
TEST(Towing, TheLedgerCloses) {
  Simulation simulation = begin(sceneWith("kind = \"speed\"\nslip = 0.3\nramp = 0.4\n", 1));
  advance(simulation, 1.1);
  const Ledger l = simulation.ledger();
  const double hitch = simulation.vehicle()->towing()->observe().work, drive = l.driveWork - hitch;
  std::printf("drives %.4g J, hitch %.4g J, error %.3g J, left over %.2g J\n", drive, hitch, l.integrationError,
              l.residual);
  EXPECT_LT(hitch, -100);
  EXPECT_LT(std::fabs(l.integrationError), 0.02 * drive);
  EXPECT_LT(std::fabs(l.residual), 1e-9 * l.turnover);
}

TEST(Towing, WithoutAHitchNothingIsSaved) {
  Simulation simulation = begin(sceneWith("", 0));
  EXPECT_EQ(simulation.vehicle()->towing(), nullptr);
  EXPECT_TRUE(simulation.save().vehicle->hitch.empty());
}

TEST(Towing, WrongHitchesAreRefused) {
  const auto refused = [](const std::string& hitch, std::initializer_list<const char*> words) {
    try {
      setup::simulationSetup(sceneWith(hitch));
      FAIL() << "accepted: " << hitch;
    } catch (const base::InputError& error) {
      const std::string said = error.what();
      for (const char* word : words) EXPECT_NE(said.find(word), std::string::npos) << word << " in: " << said;
    }
  };
  refused("kind = \"force\"\n", {"hitch.force", "missing", "kind = \"force\" requires it"});
  refused("kind = \"sled\"\nmass = 10\n", {"hitch.friction", "missing"});
  refused("kind = \"speed\"\nslip = 0.2\nmass = 3\n", {"hitch.mass", "no effect", "kind = \"sled\""});
  refused("kind = \"ramp\"\nrate = 2\nstiffness = 1e6\n", {"hitch.stiffness", "no effect"});
  refused("kind = \"speed\"\nslip = 0.2\nstiffness = 1e12\n", {"hitch.stiffness", "under-resolved", "period"});
  refused("kind = \"pull\"\n", {"hitch.kind", "sled"});
}

} // namespace
} // namespace grouser::coupling
