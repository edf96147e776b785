// SPDX-License-Identifier: BSD-3-Clause
// Sweeps with runs that branch from one vehicle at rest.
#include "tests/runs/csv_fixture.hpp"
#include "tests/runs/program_fixture.hpp"

#include <gtest/gtest.h>

namespace grouser::sweeps {

using namespace test; // fixtures

namespace {

namespace fs = std::filesystem;

class BranchedSweep : public ProgramTest {
protected:
  void SetUp() override {
    ProgramTest::SetUp();
    put(folder_ / "v.toml", R"(version = 1
[run]
duration = 0.08
time_step = 1e-4
output_interval = 0.01
threads = 1
[material.steel]
stiffness = 1e6
[terrain]
kind = "rigid"
heightmap = "heightmaps/flat.png"
size = [8, 3]
height_range = [0, 0]
material = "steel"
[vehicle]
spec = "vehicles/light_tracked.toml"
sphere_radius = 0.04
hull_touches = false
clearance = 1e-6
[driver]
tension_ramp = 0.02
weight_ramp = 0.02
drive_start = 0.05
drive_ramp = 0.02
[output]
frames = false
plots = false
picture = false
)");
  }
  /// With the sphere sets of the folder.
  Outcome sweep(const std::string& words) const {
    return call("sweep v.toml " + words, "export GROUSER_CACHE=cache\n");
  }
  Outcome run(const std::string& words) const { return call("run v.toml " + words, "export GROUSER_CACHE=cache\n"); }
  std::string hashOf(const std::string& sweep, std::size_t row) const {
    return Csv(folder_ / sweep / "summary.csv").at(row, "state hash");
  }
};

TEST_F(BranchedSweep, LowersTheVehicleOnceAndEndsAsPlainRunsDo) {
  const Outcome plain = sweep("--set driver.sprocket_speed=1,2 --out plain");
  ASSERT_EQ(plain.code, 0) << plain.errors;
  const Outcome branched = sweep("--set driver.sprocket_speed=1,2 --from-checkpoint --out branched");
  ASSERT_EQ(branched.code, 0) << branched.errors;
  EXPECT_EQ(hashOf("branched", 0), hashOf("plain", 0));
  EXPECT_EQ(hashOf("branched", 1), hashOf("plain", 1));
  const Csv all(folder_ / "plain/sprocket_speed=1/timeseries.csv"),
      behind(folder_ / "branched/sprocket_speed=1/timeseries.csv");
  ASSERT_EQ(behind.rows.size(), 3u);
  EXPECT_EQ(behind.rows, decltype(behind.rows)(all.rows.begin() + 6, all.rows.end()));
  EXPECT_NE(contents(folder_ / "branched/sprocket_speed=2/manifest.json").find("branched/settled/checkpoint.h5, step"),
            std::string::npos);
  // The same run started by hand from the same state.
  const Outcome hand = run("--resume branched/settled/checkpoint.h5 --set driver.sprocket_speed=2 --out hand --hash");
  EXPECT_EQ(hand.hash().substr(11, 16), hashOf("branched", 1)) << hand.errors;
  const Outcome given = sweep("--set driver.sprocket_speed=1,2 --from-checkpoint branched/settled/checkpoint.h5 "
                              "--out given");
  EXPECT_EQ(hashOf("given", 0), hashOf("plain", 0)) << given.errors;
  EXPECT_FALSE(fs::exists(folder_ / "given/settled"));

  // A second call performs nothing; with one more value, only that run.
  const auto ended = [&](const char* what) {
    return fs::last_write_time(folder_ / "branched" / what / "manifest.json");
  };
  const auto settled = ended("settled"), first = ended("sprocket_speed=1");
  EXPECT_EQ(sweep("--set driver.sprocket_speed=0.5,1,2 --from-checkpoint --out branched").code, 0);
  EXPECT_EQ(ended("settled"), settled);
  EXPECT_EQ(ended("sprocket_speed=1"), first);
  EXPECT_TRUE(fs::exists(folder_ / "branched/sprocket_speed=0.5/results.h5"));
  // Without the option runs include rows from their start.
  EXPECT_EQ(sweep("--set driver.sprocket_speed=1,2 --out branched").code, 0);
  EXPECT_EQ(contents(folder_ / "branched/sprocket_speed=1/manifest.json").find("branched_from"), std::string::npos);
}

TEST_F(BranchedSweep, HasOneVehicleAtRestForEachSeed) {
  const Outcome seeds =
      sweep("--case 'slow: driver.sprocket_speed=1' --case "
            "'towing: driver.sprocket_speed=1, hitch.kind=force, hitch.force=1e3' --seeds 2 --from-checkpoint");
  ASSERT_EQ(seeds.code, 0) << seeds.errors;
  const fs::path out = folder_ / "out/v_sweep";
  for (const char* seed : {"1", "2"})
    EXPECT_NE(contents(out / (std::string("towing,seed=") + seed) / "manifest.json")
                  .find(std::string("settled,seed=") + seed + "/checkpoint.h5"),
              std::string::npos)
        << seed;
  EXPECT_TRUE(fs::exists(out / "intervals.csv"));
}

TEST_F(BranchedSweep, KeysThatShapeTheStateAreRefusedBeforeAnythingRuns) {
  const struct {
    const char *words, *key;
  } kWrong[] = {{"--set driver.weight_ramp=0.01,0.02", "driver.weight_ramp is 0.01 in run weight_ramp=0.01 and 0.02"},
                {"--set vehicle.clearance=0,1e-6", "vehicle.clearance"},
                {"--set driver.sprocket_speed=1,2 --case 'a' --case 'b: run.time_step=5e-5'", "run.time_step"},
                {"--case settled --case 'b: driver.sprocket_speed=2'", "settled"}};
  for (const auto& [words, key] : kWrong) {
    const Outcome wrong = sweep(std::string(words) + " --from-checkpoint --out no");
    EXPECT_EQ(wrong.code, 2) << words;
    EXPECT_NE(wrong.error().find("--from-checkpoint"), std::string::npos) << wrong.errors;
    EXPECT_NE(wrong.error().find(key), std::string::npos) << wrong.errors;
    EXPECT_FALSE(fs::exists(folder_ / "no")) << words;
  }
  ASSERT_EQ(run("--until rest --out base").code, 0);
  const Outcome other =
      sweep("--set driver.sprocket_speed=1,2 --seeds 2 --from-checkpoint base/checkpoint.h5 --out no");
  EXPECT_EQ(other.code, 2);
  EXPECT_NE(other.error().find("run.seed = 2 was 1"), std::string::npos) << other.errors;
  EXPECT_FALSE(fs::exists(folder_ / "no"));
}

} // namespace
} // namespace grouser::sweeps
