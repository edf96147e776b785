// SPDX-License-Identifier: BSD-3-Clause
// The multibody benchmark runs the printed models, and its results are complete.
#include "runs/validation/bench/multibody.hpp"

#include "tests/runs/program_fixture.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace grouser::bench {

using namespace test; // fixtures

namespace {

MultibodyBench tinyBench() {
  MultibodyBench b;
  b.steps = 20, b.batches = 2;
  return b;
}

TEST(BenchMultibody, DrivesTheVehiclesGraph) {
  const VehicleGraphFigures f = benchVehicleGraph(tinyBench());
  EXPECT_EQ(f.bodies, 125);
  EXPECT_EQ(f.joints, 124);
  // 88 + 30 revolutes and two slides of five rows, two universals of four, two sphericals of three.
  EXPECT_EQ(f.rows, 5 * (88 + 30 + 2) + 4 * 2 + 3 * 2);
  EXPECT_EQ(f.loops, 2);
  // A track of pitch radius 0.3 m at 3 rad/s, a tenth of a second after the ramp: it moves, with slip.
  EXPECT_GT(f.hullSpeed, 0.2);
  EXPECT_LT(f.hullSpeed, 2);
  EXPECT_GE(f.iterations, 1);
  EXPECT_LE(f.mostIterations, 4);
  EXPECT_LE(f.positionError, 1e-10);
  for (const BatchTimes* t : {&f.step, &f.linearise, &f.solve}) {
    EXPECT_EQ(t->microseconds.size(), 2u);
    EXPECT_GT(t->least(), 0);
  }
  EXPECT_GT(f.step.least(), f.linearise.least()) << "the factorisation is part of a step";
}

TEST(BenchMultibody, WorkGrowsLinearlyWithTheShoes) {
  MultibodyBench b = tinyBench();
  b.steps = 5;
  const RingFigures f46 = benchRings(46, b), f92 = benchRings(92, b), f184 = benchRings(184, b);
  EXPECT_EQ(f46.bodies, 2 * 46 + 33);
  EXPECT_EQ(f184.bodies, 2 * 184 + 33);
  EXPECT_EQ(f184.multiplications - f92.multiplications, 2 * (f92.multiplications - f46.multiplications));
  EXPECT_LT(f184.multiplications, 2.0 * f92.multiplications) << "the hull does not grow";
  EXPECT_GE(f46.iterations, 1);
}

class BenchMultibodyCommand : public ProgramTest {};

TEST_F(BenchMultibodyCommand, PrintsFiguresAndWritesThemAsJson) {
  const Outcome o = call("bench multibody --steps 5 --batches 2 --json figures.json");
  ASSERT_EQ(o.code, 0) << o.errors;
  for (const char* part : {"machine ", "commit ", "125 bodies", "us (median", "each iteration", "growth", "184"})
    EXPECT_NE(o.out.find(part), std::string::npos) << part << "\n" << o.out;
  const nlohmann::json j = nlohmann::json::parse(contents(folder_ / "figures.json"));
  for (const char* key : {"device", "machine", "commit", "compiler", "vehicle", "growth", "goal_microseconds"})
    EXPECT_TRUE(j.contains(key)) << key;
  ASSERT_EQ(j["growth"].size(), 3u);
  EXPECT_EQ(j["growth"][2]["shoes"], 184);
  EXPECT_TRUE(j["growth"][1].contains("times_the_one_before"));
  EXPECT_GT(j["vehicle"]["microseconds_a_step"]["median"].get<double>(), 0);

  EXPECT_EQ(call("bench multibody --time-step 1").code, 2);
  EXPECT_EQ(call("bench multibody --vehicle nosuch.toml").code, 2);
}

} // namespace
} // namespace grouser::bench
