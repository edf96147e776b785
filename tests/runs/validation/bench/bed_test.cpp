// SPDX-License-Identifier: BSD-3-Clause
// Benchmarks compute the same physics as runs, and their figures are complete.
#include "runs/setup/load_scene.hpp"
#include "runs/validation/bench/bench.hpp"

#include "base/error.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/simulation_setup.hpp"
#include "tests/runs/program_fixture.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace grouser::bench {

using namespace test; // fixtures

namespace {

BedBench tinyBed() {
  BedBench b;
  b.grains = 320, b.settleTime = 0.1, b.steps = 20, b.batches = 3;
  return b;
}

/// The coupled scene, unsettled and coarse, for bitwise comparison.
scene::Scene shortScene() {
  return setup::loadScene(std::string(GROUSER_SOURCE_DIR) + "/tests/scenes/coupled.toml",
                          {"terrain.settle_time_limit=0", "vehicle.sphere_radius=0.03", "run.skin=0.03",
                           "driver.tension_ramp=0.005", "driver.weight_ramp=0.005", "driver.drive_start=0.01"});
}

TEST(StageTimer, ComputesTheSameBitsAsTheLoop) {
  const scene::Scene scene = shortScene();
  const auto quiet = [](double, double) {};
  coupling::Simulation timed(setup::simulationSetup(scene), base::cpuExec(1), quiet),
      plain(setup::simulationSetup(scene), base::cpuExec(1), quiet);
  coupling::StageTimer timer(timed, base::cpuExec(1));
  for (int i = 0; i < 150; ++i) timer.step(), plain.step();
  EXPECT_EQ(timed.stateHash(), plain.stateHash());
  EXPECT_EQ(timed.steps(), plain.steps());
  EXPECT_EQ(timer.steps(), 150);
  EXPECT_EQ(timed.ground().grains->system().rebuilds, plain.ground().grains->system().rebuilds);
  EXPECT_GE(timer.rebuilds(), 1) << "the pass must contain a rebuild";
  for (const coupling::StageTimer::Part& part : timer.parts()) EXPECT_GT(part.microseconds, 0) << part.name;
  EXPECT_GT(timer.part(coupling::Stage::grainStep).microseconds,
            timer.part(coupling::Stage::grainStepEnded).microseconds);
}

TEST(StageTimer, ComputesTheSameBitsForAMechanism) {
  const scene::Scene scene = setup::loadScene(std::string(GROUSER_SOURCE_DIR) + "/runs/mechanisms/gears.toml", {});
  const auto quiet = [](double, double) {};
  coupling::Simulation timed(setup::simulationSetup(scene), base::cpuExec(1), quiet),
      plain(setup::simulationSetup(scene), base::cpuExec(1), quiet);
  const std::string atRest = plain.stateHash();
  coupling::StageTimer timer(timed, base::cpuExec(1));
  for (int i = 0; i < 150; ++i) timer.step(), plain.step();
  EXPECT_NE(plain.stateHash(), atRest);
  EXPECT_EQ(timed.stateHash(), plain.stateHash());
  EXPECT_GT(timer.part(coupling::Stage::multibody).microseconds, 0);
}

TEST(BenchBed, SettlesAndCountsWhatItSays) {
  const BedBench b = tinyBed();
  const BedFigures f = benchBed(b, base::cpuExec(1));
  EXPECT_EQ(f.times.microseconds.size(), 3u);
  EXPECT_GT(f.times.least(), 0);
  EXPECT_LE(f.times.least(), f.times.median());
  EXPECT_LE(f.times.median(), f.times.most());
  EXPECT_EQ(f.stepsTaken, 2000 + 25 + 3 * 20) << "settling, warm-up, batches";
  // 8 x 8 sites per layer: each settled grain has at least one contact.
  EXPECT_GT(f.contactsPerGrain, 0.5);
  EXPECT_LT(f.contactsPerGrain, 6);
  EXPECT_GT(f.listLength, f.contactsPerGrain);
  EXPECT_GT(f.rebuildMicroseconds, 0);
  EXPECT_GT(f.bytesPerGrain, 100);
  EXPECT_GE(f.peakBytesPerGrain, f.bytesPerGrain);
  EXPECT_GE(f.reservedPerGrain, f.peakBytesPerGrain);
}

TEST(BenchBed, IsOneBedForAllThreadsAndSkins) {
  BedBench b = tinyBed();
  b.hash = true, b.settleTime = 0.02;
  const std::string hash = benchBed(b, base::cpuExec(1)).stateHash;
  b.skin = 0.6;
  EXPECT_EQ(benchBed(b, base::cpuExec(2)).stateHash, hash);
  b.jitter = 0.5;
  EXPECT_NE(benchBed(b, base::cpuExec(1)).stateHash, hash) << "the hash must see the bed";
}

TEST(BenchBed, OfSoilIsOneBedForAllLanes) {
  BedBench b{.grains = 500,
             .radiiSpread = 0.25,
             .hertz = true,
             .rolling = 0.1,
             .fixedFloor = true,
             .periodic = true,
             .settleTime = 0.05,
             .steps = 10,
             .batches = 1,
             .ledger = true,
             .hash = true};
  const BedFigures wide = benchBed(b, base::cpuExec(2));
  EXPECT_EQ(wide.features, "hertz, friction, rolling friction, many radii, periodic boundaries, fixed grains, ledger");
  b.lanes = 1;
  EXPECT_EQ(benchBed(b, base::cpuExec(1)).stateHash, wide.stateHash);
  b.rolling = 0;
  EXPECT_NE(benchBed(b, base::cpuExec(1)).stateHash, wide.stateHash);
  EXPECT_GT(wide.contactsPerGrain, 0);
}

TEST(BenchBed, UnstableStepIsAnInputError) {
  BedBench b = tinyBed();
  b.timeStep = 1e-2;
  EXPECT_THROW(benchBed(b, base::cpuExec(1)), base::InputError);
}

class BenchCommands : public ProgramTest {};

TEST_F(BenchCommands, PrintFiguresAndWriteThemAsJson) {
  const Outcome bed = call("bench bed --grains 100 --settle 0.01 --steps 5 --threads 1 --device cpu --hash "
                           "--json bed.json");
  ASSERT_EQ(bed.code, 0) << bed.errors;
  for (const char* part : {"particle-steps/s", "us (median", "listed neighbours", "rebuild ", "bytes per grain",
                           "at the peak", "machine ", "commit ", "state-hash "})
    EXPECT_NE(bed.out.find(part), std::string::npos) << part << "\n" << bed.out;
  const nlohmann::json b = nlohmann::json::parse(contents(folder_ / "bed.json"));
  for (const char* key :
       {"device", "machine", "commit", "grains", "microseconds_a_step", "particle_steps_per_second", "contacts_a_grain",
        "neighbours_listed_a_grain", "steps_between_rebuilds", "rebuild_microseconds", "bytes_a_grain",
        "peak_bytes_a_grain", "reserved_bytes_a_grain", "state_hash"})
    EXPECT_TRUE(b.contains(key)) << key;
  EXPECT_EQ(b["microseconds_a_step"]["batches"].size(), 5u);
  EXPECT_NEAR(b["particle_steps_per_second"]["median"].get<double>() * b["microseconds_a_step"]["median"].get<double>(),
              100 * 1e6, 1);

  const std::string scene = std::string(GROUSER_SOURCE_DIR) + "/tests/scenes/coupled.toml";
  const Outcome step = call("bench step " + scene +
                            " --set terrain.settle_time_limit=0 --set vehicle.sphere_radius=0.03 --after 0.03 "
                            "--steps 10 --batches 2 --threads 1 --device cpu --json step.json");
  ASSERT_EQ(step.code, 0) << step.errors;
  for (const char* part : {"without internal timers", "instrumented pass", "grain kernel", "multibody",
                           "track contacts", "grain on grain", "grain on part", "memory "})
    EXPECT_NE(step.out.find(part), std::string::npos) << part << "\n" << step.out;
  const nlohmann::json s = nlohmann::json::parse(contents(folder_ / "step.json"));
  double sum = 0;
  for (const auto& [name, microseconds] : s["instrumented_microseconds_a_step"].items())
    if (name != "sum") sum += microseconds.get<double>();
  EXPECT_NEAR(sum, s["instrumented_microseconds_a_step"]["sum"].get<double>(), 1e-9 * sum);
  EXPECT_GT(s["contacts_a_step"]["grain_boundary"].get<double>(), 0) << "the bottom layer is on the floor";
  EXPECT_GT(s["host_peak_bytes"].get<double>(), 1e6);

  EXPECT_EQ(s["timed"], "standing");
  EXPECT_TRUE(s["drive_start_s"].is_null() || s["drive_start_s"].get<double>() > 0.03);
  EXPECT_NE(step.out.find("timed     the vehicle is at rest"), std::string::npos) << step.out;

  EXPECT_EQ(call("bench bed --grains 0").code, 2);
  EXPECT_EQ(call("bench step nosuch.toml").code, 2);
}

/// `grouser bench step` of a vehicle with ramps up to 0.02 s; batch and instrumented pass: ten steps of 1e-4 s.
class BenchStep : public BenchCommands {
protected:
  nlohmann::json timed(const std::string& words) const {
    const Outcome o = call("bench step " GROUSER_SOURCE_DIR
                           "/tests/scenes/rigid.toml --set vehicle.sphere_radius=0.03 --set driver.tension_ramp=0.02 "
                           "--set driver.weight_ramp=0.02 --set driver.drive_ramp=0.02 --steps 5 --batches 1 --threads "
                           "1 --device cpu --json step.json " +
                           words);
    EXPECT_EQ(o.code, 0) << words << o.errors;
    return nlohmann::json::parse(contents(folder_ / "step.json"));
  }
  void expect(const std::string& words, const std::string& word, double from) const {
    const nlohmann::json json = timed("--set driver.drive_start=0.05 " + words);
    EXPECT_EQ(json["timed"], word) << words;
    EXPECT_NEAR(json["timed_from_s"].get<double>(), from, 1e-9) << words;
    EXPECT_EQ(json["drive_start_s"].get<double>(), 0.05);
  }
};

TEST_F(BenchStep, TimesADrivingVehicleUnlessATimeIsGiven) { expect("", "driving", 0.07); }

TEST_F(BenchStep, WaitsForAStartThatOnlyTheRunKnows) {
  // At a check of the vehicle (every 50 steps): 0.05 s at rest after the ramps.
  const nlohmann::json waited = timed("--set driver.rest_speed=10 --set driver.rest_load=0.5 --after drive");
  EXPECT_EQ(waited["timed"], "speeding up");
  EXPECT_GE(waited["drive_start_s"].get<double>(), 0.09 - 1e-9);
  EXPECT_NEAR(waited["timed_from_s"].get<double>(), waited["drive_start_s"].get<double>(), 1e-9);
}

TEST_F(BenchStep, SaysHowTheVehicleMovesAtEachTime) {
  expect("--after 0.01", "standing", 0.01), expect("--after 0.0495", "driving off", 0.0495);
  expect("--after drive+0.01", "speeding up", 0.06);
}

TEST_F(BenchStep, RefusesATimeThatIsNone) {
  const Outcome wrong = call("bench step x.toml --after driven");
  EXPECT_EQ(wrong.code, 2);
  EXPECT_NE(
      wrong.errors.find("driven is neither a time in seconds (0 or more) nor drive or drive+TIME, e.g. drive+0.5"),
      std::string::npos)
      << wrong.errors;
}

} // namespace
} // namespace grouser::bench
