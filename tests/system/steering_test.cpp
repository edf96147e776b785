// SPDX-License-Identifier: BSD-3-Clause
// Inputs act at a step's boundary, are part of state, ledger and hash, and can be replayed.
#include "coupling/simulation.hpp"
#include "runs/session/replay.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/setup/simulation_setup.hpp"
#include "tests/device_under_test.hpp"
#include "tests/message_of.hpp"
#include "tests/runs/shared_cache.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

namespace grouser::coupling {
namespace {

using test::messageOf;
using Values = std::array<double, 6>;

scene::Scene sceneOf(const std::string& file, std::vector<std::string> overrides = {}) {
  overrides.emplace_back("vehicle.sphere_radius=0.03");
  overrides.insert(overrides.end(), {"driver.tension_ramp=0.02", "driver.weight_ramp=0.02", "driver.drive_start=0.04",
                                     "driver.drive_ramp=0.01"});
  return setup::loadScene(std::string(GROUSER_SOURCE_DIR) + "/tests/scenes/" + file, overrides);
}

std::unique_ptr<Simulation> simulationOf(const scene::Scene& scene, const base::Exec& exec = testExec(1)) {
  return std::make_unique<Simulation>(
      setup::simulationSetup(scene), exec, [](double, double) {}, base::Comm{}, sharedBeds(), sharedSpheres());
}

void stepUntil(Simulation& s, std::int64_t step) {
  while (s.steps() < step) s.advance(step - s.steps());
}

/// Controls the hull's speed by a rule that reads the state every 50 steps.
void control(Simulation& s, std::int64_t until) {
  while (s.steps() < until) {
    const double v = s.vehicle()->observe(Means::watch).velocity.x;
    for (const std::int32_t side : {0, 1}) s.set({{0, InputKind::sprocketSpeed, side, false, {1.5 + 3 * (0.3 - v)}}});
    stepUntil(s, std::min(until, s.steps() + 50));
  }
}

TEST(Steering, AReplayHasTheHashOfTheControlledRunOnAnyThreads) {
  for (const char* file : {"rigid.toml", "coupled.toml"}) {
    const scene::Scene scene = sceneOf(file);
    const auto controlled = simulationOf(scene), alone = simulationOf(scene);
    control(*controlled, 700);
    stepUntil(*alone, 700);
    EXPECT_NE(controlled->stateHash(), alone->stateHash()) << file;

    const auto repeated = simulationOf(scene, testExec(2));
    session::Replay replay(controlled->inputs().series());
    while (repeated->steps() < 700) repeated->advance(replay.apply(*repeated, 700 - repeated->steps()));
    EXPECT_EQ(repeated->stateHash(), controlled->stateHash()) << file;
  }
}

TEST(Steering, ASavedStateGoesOnWithWhatActs) {
  const scene::Scene scene = sceneOf("rigid.toml");
  const auto straight = simulationOf(scene), first = simulationOf(scene);
  for (Simulation* s : {straight.get(), first.get()}) {
    stepUntil(*s, 300);
    s->set({{0, InputKind::sprocketSpeed, 0, false, {2.5}}});
    s->set({{0, InputKind::gravity, 0, false, {0, 0, -5}}});
    s->set({{0, InputKind::bodyLoad, bodyIndex(*s, "chassis"), false, {100, 0, 0, 0, 0, 20}}});
    stepUntil(*s, 400);
  }
  const SimulationState saved = first->save();
  Simulation second(setup::simulationSetup(scene), testExec(2), saved, base::Comm{}, sharedSpheres());
  EXPECT_EQ(second.stateHash(), straight->stateHash());
  stepUntil(*straight, 700), stepUntil(second, 700);
  EXPECT_EQ(second.stateHash(), straight->stateHash());
  EXPECT_EQ(second.inputs().series(), straight->inputs().series());
  EXPECT_EQ(second.ledger().driveWork, straight->ledger().driveWork);
}

TEST(Steering, TheDriverHasItsSprocketsBackWhenTheyAreReleased) {
  const scene::Scene scene = sceneOf("rigid.toml", {"driver.sprocket_speed=1"});
  const auto s = simulationOf(scene);
  stepUntil(*s, 600);
  s->set({{0, InputKind::sprocketSpeed, 0, false, {3}}});
  s->set({{0, InputKind::sprocketSpeed, 1, false, {-2}}});
  stepUntil(*s, 601);
  EXPECT_NEAR(s->vehicle()->observe(Means::watch).tracks[0].sprocketSpeed, 3, 1e-9);
  EXPECT_NEAR(s->vehicle()->observe(Means::watch).tracks[1].sprocketSpeed, -2, 1e-9);
  for (const std::int32_t side : {0, 1}) s->set({{0, InputKind::sprocketSpeed, side, true, {}}});
  stepUntil(*s, 602);
  for (const auto& track : s->vehicle()->observe(Means::watch).tracks) EXPECT_NEAR(track.sprocketSpeed, 1, 1e-9);
}

TEST(Steering, NothingActsBeforeTheDriveBegins) {
  const scene::Scene scene = sceneOf("rigid.toml");
  const auto steered = simulationOf(scene), alone = simulationOf(scene);
  for (const std::int32_t side : {0, 1}) steered->set({{0, InputKind::sprocketSpeed, side, false, {5}}});
  stepUntil(*steered, 390), stepUntil(*alone, 390); // the drive starts at step 400
  EXPECT_EQ(steered->vehicle()->state().save(), alone->vehicle()->state().save());
}

/// A body without contacts: F t / m, and the corresponding work.
TEST(Steering, ALoadOnABodyDoesItsWork) {
  const char* text =
      "version = 1\n[run]\nduration = 1\ntime_step = 1e-3\ngravity = [0, 0, 0]\nintegrator = \"symplectic_euler\"\n"
      "[[body]]\nname = \"ball\"\nmass = 2\ninertia = [0.1, 0.1, 0.1]\n";
  for (const char* integrator : {"symplectic_euler", "rattle"}) {
    const auto s = simulationOf(setup::parseScene(text, "ball.toml", {std::string("run.integrator=") + integrator}));
    s->set({{0, InputKind::bodyLoad, bodyIndex(*s, "ball"), false, {3, 0, 0, 0, 0, 0.2}}});
    stepUntil(*s, 1000);
    const multibody::Twist& V = s->mechanism()->state().twist.front();
    EXPECT_NEAR(V.v.x, 1.5, 1e-12) << integrator; // F t / m
    EXPECT_NEAR(V.w.z, 2, 1e-12) << integrator;   // M t / I
    const Ledger l = s->ledger();
    EXPECT_NEAR(l.driveWork, 0.5 * 2 * 1.5 * 1.5 + 0.5 * 0.1 * 2 * 2, 1e-12) << integrator;
    EXPECT_NEAR(l.residual, 0, 1e-12) << integrator;
    EXPECT_NEAR(l.integrationError, 0, 1e-12) << integrator;
  }
}

TEST(Steering, TheWorkOfALoadOnTheHullIsInTheBooks) {
  const auto s = simulationOf(sceneOf("rigid.toml"));
  stepUntil(*s, 400);
  const double before = s->ledger().driveWork;
  const double x = s->vehicle()->state().pose.front().position.x;
  s->set({{0, InputKind::bodyLoad, bodyIndex(*s, "chassis"), false, {-400}}});
  stepUntil(*s, 900);
  const multibody::State& now = s->vehicle()->state();
  const Ledger l = s->ledger();
  EXPECT_LT(std::fabs(l.residual), 1e-9 * l.turnover);
  // The drives act against it: without its work the ledger would not close.
  EXPECT_GT(std::fabs(400 * (now.pose.front().position.x - x)), 1);
  EXPECT_LT(std::fabs(l.integrationError), 0.05 * std::fabs(l.driveWork - before));
}

/// Grains that fall, then fly on: v = g1 t1 + g2 t2, to the rounding of the recurrence; no energy is created. A
/// step of symplectic Euler has an error of m g^2 dt^2 / 2.
TEST(Steering, AnotherGravityActsFromTheNextStepOn) {
  const char* text = "version = 1\n[run]\nduration = 1\ntime_step = 1e-4\n[material.glass]\nstiffness = 1e4\n"
                     "[[grain]]\nposition = [0, 0, 5]\nradius = 0.01\nmaterial = \"glass\"\n"
                     "[[grain]]\nposition = [1, 0, 5]\nradius = 0.01\nmaterial = \"glass\"\n";
  const auto s = simulationOf(setup::parseScene(text, "fall.toml"));
  stepUntil(*s, 1000);
  s->set({{0, InputKind::gravity, 0, false, {1.5, 0, -1.62}}});
  stepUntil(*s, 3000);
  const terrain::GrainSnapshot grains = s->ground().grains->snapshot();
  for (const auto& v : grains.velocity) {
    EXPECT_NEAR(v.x, 1.5 * 0.2, 1e-6);
    EXPECT_NEAR(v.z, -9.81 * 0.1 - 1.62 * 0.2, 1e-6);
  }
  const Ledger l = s->ledger();
  EXPECT_GT(l.turnover, 0);
  EXPECT_LT(std::fabs(l.residual), 1e-7 * l.turnover) << "forces are rounded to the kernel's precision";
  const double mass = 2 * 2500 * 4.0 / 3 * 3.14159265358979 * 1e-6;
  const double missed = 0.5 * mass * 1e-8 * (1000 * 9.81 * 9.81 + 2000 * (1.5 * 1.5 + 1.62 * 1.62));
  EXPECT_NEAR(std::fabs(l.integrationError), missed, 1e-3 * missed);
  EXPECT_LT(norm(l.momentumResidual), 1e-6 * norm(l.momentum));
  s->set({{0, InputKind::gravity, 0, true, {}}});
  stepUntil(*s, 3001);
  EXPECT_NEAR(s->ground().grains->snapshot().velocity.front().z, -9.81 * 0.1001 - 1.62 * 0.2, 1e-6);
}

TEST(Steering, AHitchHoldsWithTheForceThatIsSet) {
  const auto s =
      simulationOf(sceneOf("rigid.toml", {"hitch.kind=force", "hitch.force=0", "hitch.ramp=0", "hitch.start=0"}));
  stepUntil(*s, 600);
  s->set({{0, InputKind::hitchForce, 0, false, {250}}});
  s->restartMeans(Means::watch);
  stepUntil(*s, 700);
  EXPECT_NEAR(s->vehicle()->observe(Means::watch).drawbarPull, 250, 1);
  EXPECT_NEAR(s->vehicle()->towing()->observe(Means::watch).pull, 250, 1);
}

TEST(Steering, WatchingDoesNotChangeTheRows) {
  const scene::Scene scene = sceneOf("rigid.toml");
  const auto watched = simulationOf(scene), alone = simulationOf(scene);
  for (int k = 0; k < 6; ++k) watched->restartMeans(Means::watch), stepUntil(*watched, 100 * (k + 1));
  stepUntil(*alone, 600);
  const vehicle::Observation a = watched->vehicle()->observe(), b = alone->vehicle()->observe();
  EXPECT_EQ(a.grossTraction, b.grossTraction);
  EXPECT_EQ(a.groundForce.z, b.groundForce.z);
  EXPECT_EQ(a.tracks[0].slip, b.tracks[0].slip);
  EXPECT_EQ(watched->stateHash(), alone->stateHash());
}

TEST(Steering, WhatTheSceneDoesNotHaveIsRefusedAndNothingChanges) {
  const auto s = simulationOf(sceneOf("rigid.toml"));
  stepUntil(*s, 50);
  const std::string before = s->stateHash();
  const auto refused = [&](InputKind kind, std::int32_t target, const Values& value) {
    return messageOf([&] { s->set({{0, kind, target, false, value}}); });
  };
  EXPECT_NE(refused(InputKind::sprocketTorque, 0, {5}).find("driver.drive = \"torque\""), std::string::npos);
  EXPECT_NE(refused(InputKind::throttle, 0, {0.5}).find("driver.drive = \"engine\""), std::string::npos);
  EXPECT_NE(refused(InputKind::hitchForce, 0, {5}).find("[hitch] kind = \"force\""), std::string::npos);
  EXPECT_NE(refused(InputKind::sprocketSpeed, 2, {5}).find("no track 2"), std::string::npos);
  EXPECT_NE(refused(InputKind::sprocketSpeed, 0, {101}).find("[-100, 100] [rad/s]"), std::string::npos);
  EXPECT_NE(refused(InputKind::sprocketSpeed, 0, {NAN}).find("nan is not finite"), std::string::npos);
  EXPECT_NE(refused(InputKind::bodyLoad, 9999, {5}).find("no body 9999"), std::string::npos);
  EXPECT_NE(messageOf([&] { bodyIndex(*s, "chasis"); }).find("\"chassis\""), std::string::npos);
  EXPECT_TRUE(s->inputs().series().empty());
  EXPECT_EQ(s->stateHash(), before);
}

} // namespace
} // namespace grouser::coupling
