// SPDX-License-Identifier: BSD-3-Clause
// The bench of the multibody solver steps what it says, and its figures are whole.
#include "runs/bench_multibody.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sys/wait.h>

namespace grouser::runs {
namespace {

namespace fs = std::filesystem;

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
  // A track of pitch radius 0.3 m at 3 rad/s, a tenth of a second after the drive is up: it moves, if with slip.
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

TEST(BenchMultibody, PrintsFiguresAndWritesThemAsJson) {
  const fs::path folder = fs::path(testing::TempDir()) / "grouser_bench_multibody";
  fs::remove_all(folder);
  fs::create_directories(folder);
  const fs::path program = fs::read_symlink("/proc/self/exe").parent_path() / "grouser";
  const auto call = [&](const std::string& words) {
    return WEXITSTATUS(std::system(
        (program.string() + " bench multibody " + words + " >" + (folder / "out.txt").string() + " 2>&1").c_str()));
  };
  ASSERT_EQ(call("--steps 5 --batches 2 --json " + (folder / "figures.json").string()), 0);
  std::ifstream out(folder / "out.txt");
  const std::string text{std::istreambuf_iterator<char>(out), {}};
  for (const char* part : {"machine ", "commit ", "125 bodies", "us (median", "each iteration", "growth", "184"})
    EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
  std::ifstream file(folder / "figures.json");
  const nlohmann::json j = nlohmann::json::parse(file);
  for (const char* key : {"device", "machine", "commit", "compiler", "vehicle", "growth", "goal_microseconds"})
    EXPECT_TRUE(j.contains(key)) << key;
  ASSERT_EQ(j["growth"].size(), 3u);
  EXPECT_EQ(j["growth"][2]["shoes"], 184);
  EXPECT_TRUE(j["growth"][1].contains("times_the_one_before"));
  EXPECT_GT(j["vehicle"]["microseconds_a_step"]["median"].get<double>(), 0);

  EXPECT_EQ(call("--time-step 1"), 2);
  EXPECT_EQ(call("--vehicle nosuch.toml"), 2);
  fs::remove_all(folder);
}

} // namespace
} // namespace grouser::runs
