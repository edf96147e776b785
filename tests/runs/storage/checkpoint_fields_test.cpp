// SPDX-License-Identifier: BSD-3-Clause
// Every member of the saved state, with unique values, through the file; and the members of the state hash. The
// compiler lists the members: this detects a new member that is not stored.
#include "coupling/simulation.hpp"
#include "multibody/state.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/setup/simulation_setup.hpp"
#include "runs/storage/checkpoint.hpp"
#include "tests/runs/folder_fixture.hpp"
#include "tests/runs/shared_cache.hpp"
#include "tests/runs/storage/record_fields.hpp"

#include <gtest/gtest.h>

#include <functional>

namespace grouser::storage {

using namespace test; // fixtures

namespace {

/// Three grains, three contacts, and three of all other items; no number is a default, and all differ.
coupling::SimulationState filled() {
  coupling::SimulationState s;
  int next = 1;
  forEachNumber(
      s,
      [&](const std::string&, auto& number) { number = static_cast<std::decay_t<decltype(number)>>(++next * 5 / 4); },
      true);
  terrain::GrainState& g = *s.grains;
  g.total = 3, g.id = {0, 1, 2}, g.contacts = {1, 0, 2};
  g.layout = {1, 1, 1, 1, 1, 1, 1, 1}, g.wallBits = {1, 1, 1};
  // Ledger members follow those of the motion; the hash excludes them.
  for (std::vector<double>* bodies : {&s.vehicle->bodies, &s.mechanism->bodies})
    for (std::size_t k = 0; k < multibody::State::kBooks; ++k) bodies->push_back(++next);
  return s;
}

class CheckpointFields : public FolderTest {
protected:
  std::filesystem::path path() const { return folder_ / "checkpoint.h5"; }
};

TEST_F(CheckpointFields, AreAllReadBackAsTheyWereWritten) {
  Checkpoint c;
  c.scene = "scene", c.inputs = "inputs", c.commit = "commit";
  c.timeStep = 0.125, c.rows = 7, c.frames = 5;
  c.lengths = GrainLengths{0.25, 3};
  c.branchedFrom = BranchPoint{"/a/checkpoint.h5", 450, "0123"};
  c.state = filled();
  const auto written = numbersOf(c.state);
  ASSERT_GT(written.size(), 200u);
  for (const auto& [place, bits] : written) // except counts of contacts and ids, which set array shapes
    EXPECT_TRUE(bits != 0 || place.rfind(".6", 0) == 0) << place;
  writeCheckpoint(path(), c);
  const Checkpoint read = readCheckpoint(path());
  const auto is = numbersOf(read.state);
  ASSERT_EQ(is.size(), written.size());
  for (std::size_t i = 0; i < is.size(); ++i) {
    EXPECT_EQ(is[i].first, written[i].first);
    EXPECT_EQ(is[i].second, written[i].second) << "member " << is[i].first << " of SimulationState";
  }
  EXPECT_EQ(read.scene, "scene");
  EXPECT_EQ(read.inputs, "inputs");
  EXPECT_EQ(read.commit, "commit");
  EXPECT_EQ(read.timeStep, 0.125);
  EXPECT_EQ(read.rows, 7);
  EXPECT_EQ(read.frames, 5);
  ASSERT_TRUE(read.branchedFrom);
  EXPECT_EQ(read.branchedFrom->text(), "/a/checkpoint.h5, step 450, state hash 0123");
  ASSERT_TRUE(read.lengths);
  EXPECT_EQ(read.lengths->unit, 0.25);
  EXPECT_EQ(read.lengths->radius, 3);
}

TEST_F(CheckpointFields, OfPartsThatASceneLacksAreNotMadeUp) {
  Checkpoint c;
  c.state.steps = 4;
  writeCheckpoint(path(), c);
  const coupling::SimulationState read = readCheckpoint(path()).state;
  EXPECT_FALSE(read.grains || read.ground || read.surfaces || read.vehicle || read.mechanism);
  EXPECT_EQ(read.steps, 4);
}

using Change = std::function<void(coupling::SimulationState&)>;
struct NamedChange {
  const char* what;
  Change change;
};

/// Members that affect the next step.
const NamedChange kHashed[] = {
    {"position", [](coupling::SimulationState& s) { s.grains->position[1].y ^= 1; }},
    {"velocity", [](coupling::SimulationState& s) { s.grains->velocity[2].z += 1; }},
    {"spin", [](coupling::SimulationState& s) { s.grains->spin[0].x += 1; }},
    {"remainder of velocity and spin",
     [](coupling::SimulationState& s) { s.grains->remainders[1].axis[2] ^= 0x10001; }},
    {"remainder of the position", [](coupling::SimulationState& s) { s.grains->remainders[1].position ^= 1; }},
    {"radius", [](coupling::SimulationState& s) { s.grains->radius[1] += 1; }},
    {"material", [](coupling::SimulationState& s) { s.grains->material[1] ^= 1; }},
    {"neighbour", [](coupling::SimulationState& s) { s.grains->neighbour[1] ^= 1; }},
    {"spring of a contact", [](coupling::SimulationState& s) { s.grains->contactShear[2].y += 1; }},
    {"rolling angle of a contact", [](coupling::SimulationState& s) { s.grains->contactRolling[0].z += 1; }},
    {"spring of a wall", [](coupling::SimulationState& s) { s.grains->wallShear[1].x += 1; }},
    {"rolling angle of a wall", [](coupling::SimulationState& s) { s.grains->wallRolling[1].y += 1; }},
    {"ground of another kind", [](coupling::SimulationState& s) { (*s.ground)[1] += 1; }},
    {"offset of a surface", [](coupling::SimulationState& s) { s.surfaces->surfaces[1].offset += 1; }},
    {"lift onto a settled bed", [](coupling::SimulationState& s) { s.lifts[1] += 1; }},
    {"speed of a surface", [](coupling::SimulationState& s) { s.surfaces->surfaces[2].speed += 1; }},
    {"patch on a mesh", [](coupling::SimulationState& s) { s.surfaces->patches.memories[2] ^= 1; }},
    {"rolling angle on a mesh", [](coupling::SimulationState& s) { s.surfaces->patches.angles[1] += 1; }},
    {"body of the vehicle", [](coupling::SimulationState& s) { s.vehicle->bodies[0] += 1; }},
    {"hitch", [](coupling::SimulationState& s) { s.vehicle->hitch[1] += 1; }},
    {"what was set from outside", [](coupling::SimulationState& s) { s.inputs[4] += 1; }},
    {"spring of the track", [](coupling::SimulationState& s) { s.vehicle->contacts.track.states[1].shear.y += 1; }},
    {"stiffness of a track's spring",
     [](coupling::SimulationState& s) { s.vehicle->contacts.track.states[1].stiffness += 1; }},
    {"spring on the ground", [](coupling::SimulationState& s) { s.vehicle->contacts.ground.states[2].shear.z += 1; }},
    {"spring on an obstacle",
     [](coupling::SimulationState& s) { s.vehicle->contacts.surfaces.states[1].shear.x += 1; }},
    {"patch on a part", [](coupling::SimulationState& s) { s.vehicle->contacts.bed.memories[0] ^= 1; }},
    {"rolling angle on a part", [](coupling::SimulationState& s) { s.vehicle->contacts.bed.angles[2] += 1; }},
    {"dent on a part", [](coupling::SimulationState& s) { s.vehicle->contacts.bed.dents[2] += 1; }},
    {"dent on a mesh", [](coupling::SimulationState& s) { s.surfaces->patches.dents[1] += 1; }},
    {"body of the mechanism", [](coupling::SimulationState& s) { s.mechanism->bodies[2] += 1; }},
    {"patch on a body", [](coupling::SimulationState& s) { s.mechanism->touching->contacts.bed.memories[1] ^= 1; }},
};

/// Sums for rows and alarms: without effect on the next step.
const NamedChange kUnhashed[] = {
    {"travel since the list", [](coupling::SimulationState& s) { s.grains->travelled[1].x ^= 1; }},
    {"books", [](coupling::SimulationState& s) { s.grains->ledgerSums[1] += 1; }},
    {"energy guard", [](coupling::SimulationState& s) { s.guard[1] += 1; }},
    {"ledger at the start", [](coupling::SimulationState& s) { s.ledgerAtStart[1] += 1; }},
    {"crossings", [](coupling::SimulationState& s) { s.grains->crossings[1].y += 1; }},
    {"skin", [](coupling::SimulationState& s) { s.grains->skin += 1; }},
    {"work of a surface", [](coupling::SimulationState& s) { s.surfaces->surfaces[0].work += 1; }},
    {"mean force of a surface", [](coupling::SimulationState& s) { s.surfaces->surfaces[0].force.x += 1; }},
    {"sums of the track", [](coupling::SimulationState& s) { s.vehicle->contacts.track.sums[0].elastic += 1; }},
    {"mean ground force", [](coupling::SimulationState& s) { s.vehicle->groundForces[1].z += 1; }},
    {"book of the vehicle's bodies", [](coupling::SimulationState& s) { s.vehicle->bodies.back() += 1; }},
    {"book of the mechanism", [](coupling::SimulationState& s) { s.mechanism->bodies.back() += 1; }},
    {"grains taken out", [](coupling::SimulationState& s) { s.taken.mass += 1; }},
    {"sums of an obstacle", [](coupling::SimulationState& s) { s.vehicle->contacts.surfaces.sums[0].elastic += 1; }},
    {"books of the hitch", [](coupling::SimulationState& s) { s.vehicle->hitchSums[0] += 1; }},
    {"speeds that were asked for", [](coupling::SimulationState& s) { s.vehicle->asked[1] += 1; }},
    {"steps without way", [](coupling::SimulationState& s) { s.vehicle->stalledSteps += 50; }},
    {"what was pressed most", [](coupling::SimulationState& s) { s.vehicle->contacts.bed.deepest[1] ^= 1; }},
    {"worst gap", [](coupling::SimulationState& s) { s.mechanism->worst[0] += 1; }},
    {"mean force on a body", [](coupling::SimulationState& s) { s.mechanism->touching->forces[1].x += 1; }},
    {"work of loads on bodies", [](coupling::SimulationState& s) { s.mechanism->touching->appliedWork[0] += 1; }},
};

TEST(StateHash, TakesWhatTheNextStepDependsOnAndNothingElse) {
  coupling::SimulationState state = filled();
  coupling::Inputs inputs;
  inputs.set({7, coupling::InputKind::sprocketSpeed, 1, false, {1.25}});
  state.inputs = inputs.save();
  const std::string hash = state.hash();
  for (const auto& [what, change] : kHashed) {
    coupling::SimulationState other = state;
    change(other);
    EXPECT_NE(other.hash(), hash) << what;
  }
  for (const auto& [what, change] : kUnhashed) {
    coupling::SimulationState other = state;
    change(other);
    EXPECT_EQ(other.hash(), hash) << what;
  }
}

void expectSame(const coupling::SimulationState& is, const coupling::SimulationState& was) {
  const auto a = numbersOf(is), b = numbersOf(was);
  ASSERT_EQ(a.size(), b.size());
  std::size_t shown = 0;
  for (std::size_t i = 0; i < a.size() && shown < 5; ++i) {
    if (a[i] == b[i]) continue;
    ADD_FAILURE() << "member " << b[i].first << " of coupling::SimulationState was not restored";
    ++shown;
  }
}

/// Runs a scene, restores its saved state in another simulation, and saves that again.
void expectRestored(const scene::Scene& scene, std::int64_t steps) {
  coupling::Simulation straight(
      setup::simulationSetup(scene), base::cpuExec(1), [](double, double) {}, {}, nullptr, sharedSpheres());
  while (straight.steps() < steps / 2) straight.step();
  straight.restartMeans();
  while (straight.steps() < steps) straight.step();
  const coupling::SimulationState saved = straight.save();
  const coupling::Simulation resumed(setup::simulationSetup(scene), base::cpuExec(1), saved, {}, sharedSpheres());
  expectSame(resumed.save(), saved);
}

TEST(RestoredSimulation, OfAVehicleOnRigidGroundSavesWhatItWasGiven) {
  expectRestored(setup::loadScene(std::string(GROUSER_SOURCE_DIR) + "/tests/scenes/rigid.toml",
                                  {"vehicle.sphere_radius=0.04", "vehicle.clearance=1e-6", "driver.tension_ramp=0.002",
                                   "driver.weight_ramp=0.002", "driver.drive_ramp=0.002"}),
                 95); // the track has been checked, and ground impacts measured
}

TEST(RestoredSimulation, SumsOfTheRowAndOfTheAlarmAreKeptApart) {
  const scene::Scene scene =
      setup::loadScene(std::string(GROUSER_SOURCE_DIR) + "/tests/scenes/rigid.toml",
                       {"vehicle.sphere_radius=0.04", "vehicle.clearance=1e-6", "driver.tension_ramp=0.002",
                        "driver.weight_ramp=0.002", "driver.drive_ramp=0.002"});
  coupling::Simulation simulation(
      setup::simulationSetup(scene), base::cpuExec(1), [](double, double) {}, {}, nullptr, sharedSpheres());
  while (simulation.steps() < 20) simulation.step();
  const coupling::VehicleState first = *simulation.save().vehicle;
  simulation.restartMeans(); // a row is written; the track is checked every 50 steps
  while (simulation.steps() < 45) simulation.step();
  const coupling::VehicleState then = *simulation.save().vehicle;
  EXPECT_EQ(first.meanSteps, 20);
  EXPECT_EQ(then.meanSteps, 25);
  EXPECT_EQ(then.alarmSteps, 45);
  ASSERT_EQ(then.alarmForces.size(), then.groundForces.size());
  bool any = false;
  for (std::size_t c = 0; c < then.alarmForces.size(); ++c) {
    EXPECT_EQ(then.alarmForces[c], first.groundForces[c] + then.groundForces[c]) << c;
    any = any || !(first.groundForces[c] == base::Vec3l{});
  }
  EXPECT_TRUE(any) << "the ground has exerted forces before the row";
}

TEST(RestoredSimulation, OfBodiesAmongGrainsSavesWhatItWasGiven) {
  expectRestored(setup::loadScene(std::string(GROUSER_SOURCE_DIR) + "/tests/scenes/bodies.toml"), 900);
}

TEST(RestoredSimulation, OfGrainsAndSurfacesSavesWhatItWasGiven) {
  expectRestored(setup::loadScene(std::string(GROUSER_SOURCE_DIR) + "/tests/scenes/moving.toml"), 900);
}

TEST(RestoredSimulation, OfAMechanismSavesWhatItWasGiven) {
  expectRestored(setup::loadScene(std::string(GROUSER_SOURCE_DIR) + "/runs/mechanisms/slider_crank.toml"), 61);
}

} // namespace
} // namespace grouser::storage
