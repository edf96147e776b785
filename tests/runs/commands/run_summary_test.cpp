// SPDX-License-Identifier: BSD-3-Clause
// The last lines of a run: figures, energy check, results; details with --verbose; a second run beside it.
#include "runs/commands/run_summary.hpp"
#include "tests/runs/program_fixture.hpp"
#include "tests/runs/shared_cache.hpp"

#include <gtest/gtest.h>

#include <string>

namespace grouser::commands {

using namespace test; // fixtures

namespace {

class RunSummary : public ProgramTest {
protected:
  void SetUp() override {
    ProgramTest::SetUp();
    put(folder_ / "scene.toml",
        "version = 1\n[run]\ntime_step = 1e-4\nduration = 0.25\noutput_interval = 0.005\n[material.ground]\n"
        "stiffness = 1e7\n[terrain]\nheightmap = \"heightmaps/flat.png\"\nsize = [6, 2.6]\nheight_range = [0, 0]\n"
        "kind = \"rigid\"\nmaterial = \"ground\"\n[vehicle]\nspec = \"vehicles/light_tracked.toml\"\n"
        "sphere_radius = 0.04\n[driver]\nsprocket_speed = 20\ntension_ramp = 0\nweight_ramp = 0\ndrive_start = 0.01\n"
        "drive_ramp = 0.05\n[output]\nframes = false\nplots = false\npicture = false\n");
  }
  /// Text after a label at the beginning of a line; empty if there is none.
  static std::string line(const std::string& out, const std::string& label) {
    const std::size_t at = ("\n" + out).find("\n" + label + " ");
    return at == std::string::npos ? "" : out.substr(at, out.find('\n', at) - at);
  }
};

TEST_F(RunSummary, EndsInFiguresEnergyAndResultsInThisOrder) {
  const Outcome run = call("run scene.toml --out a", withSharedCache());
  ASSERT_EQ(run.code, 0) << run.errors;
  std::size_t last = 0;
  for (const char* label : {"speed", "slip", "torque", "energy", "results"}) {
    const std::string text = line(run.out, label);
    ASSERT_NE(text, "") << label << "\n" << run.out;
    EXPECT_GT(run.out.find(text), last) << run.out;
    last = run.out.find(text);
  }
  EXPECT_NE(line(run.out, "speed").find(" m/s"), std::string::npos) << run.out;
  EXPECT_NE(line(run.out, "torque").find("both sprockets"), std::string::npos) << run.out;
  EXPECT_NE(line(run.out, "results").find("grouser report a"), std::string::npos) << run.out;
  for (const char* detail : {"ledger", "momentum", "wall", "file"}) EXPECT_EQ(line(run.out, detail), "") << run.out;

  const Outcome whole = call("run scene.toml --out b --verbose --beside a", withSharedCache());
  ASSERT_EQ(whole.code, 0) << whole.errors;
  for (const char* detail : {"ledger", "momentum", "wall", "file"}) EXPECT_NE(line(whole.out, detail), "") << whole.out;
  // The same run twice: the second column repeats the first.
  const std::string speed = line(run.out, "speed").substr(10), both = line(whole.out, "speed");
  const std::size_t first = both.find(speed.substr(0, speed.find_last_not_of(' ') + 1));
  ASSERT_NE(first, std::string::npos) << both;
  EXPECT_NE(both.find(speed.substr(0, speed.find_last_not_of(' ') + 1), first + 1), std::string::npos) << both;
}

TEST_F(RunSummary, WarnsOfALargeTimeIntegrationError) {
  output::Summary summary;
  summary.steps = 1000;
  summary.figures = {
      {"energy_converted_J", 20}, {"energy_residual_J", 0}, {"integration_error_J", 0.99}, {"quiet_energy_J", 0.1}};
  EXPECT_EQ(integrationWarning(summary), "");
  summary.figures["integration_error_J"] = -2.4;
  EXPECT_NE(integrationWarning(summary).find("is 12 % of the work of all forces, 20 J"), std::string::npos);
  EXPECT_EQ(energyText(summary).rfind("WARNING: the time-integration error", 0), 0u) << energyText(summary);
  summary.figures["energy_converted_J"] = 1e-3, summary.figures["integration_error_J"] = 0.099;
  EXPECT_EQ(integrationWarning(summary), "") << "at rest";
  summary.figures["quiet_energy_J"] = 0, summary.steps = 10;
  EXPECT_EQ(integrationWarning(summary), "") << "few steps";
  summary.steps = 1000;
  EXPECT_NE(integrationWarning(summary), "");
  summary.figures["solver_missed_steps"] = 0;
  EXPECT_EQ(integrationWarning(summary), "") << "complementarity contacts";
}

TEST_F(RunSummary, WarnsOfASinkageBeyondTheTable) {
  output::Summary summary;
  EXPECT_EQ(sinkageWarning(summary, 0.1), "") << "no deformable soil";
  summary.figures["largest_sinkage_m"] = 0.09;
  EXPECT_EQ(sinkageWarning(summary, 0.1), "");
  summary.figures["largest_sinkage_m"] = 0.124;
  EXPECT_NE(sinkageWarning(summary, 0.1).find("sank by 0.124 m, more than scm.largest_sinkage, 0.1 m"),
            std::string::npos);
}

TEST_F(RunSummary, WarnsFirstIfFiguresAreInconclusive) {
  // Three teeth in all, fewer than two in the steady part: the run is complete, its results are inconclusive.
  const Outcome run = call("run scene.toml --out a --set driver.sprocket_speed=10", withSharedCache());
  ASSERT_EQ(run.code, 0) << run.errors;
  const std::size_t warning = run.out.find("WARNING: the figures are inconclusive: ");
  ASSERT_NE(warning, std::string::npos) << run.out;
  EXPECT_LT(warning, run.out.find(line(run.out, "speed"))) << run.out;
}

TEST_F(RunSummary, WarnsIfTheSpeedStillVariesInTheSteadyPart) {
  const Outcome surging = call("run scene.toml --out a", withSharedCache());
  const std::size_t warning = surging.out.find("WARNING: the speed varies from ");
  ASSERT_NE(warning, std::string::npos) << surging.out;
  EXPECT_LT(warning, surging.out.find(line(surging.out, "speed"))) << surging.out;
}

TEST_F(RunSummary, OnRigidGroundShoesDoNotSink) {
  const Outcome run = call("run scene.toml --out a", withSharedCache());
  ASSERT_EQ(run.code, 0) << run.errors;
  // light_tracked.toml: grousers of 15 mm. The column of the results remains the height below the pads.
  EXPECT_NE(line(run.out, "sinkage").find("none: the shoes stand on their grousers, with the pads 1"),
            std::string::npos)
      << run.out;
  EXPECT_NE(line(run.out, "sinkage").find(" mm above the rigid ground"), std::string::npos) << run.out;
  EXPECT_EQ(run.out.find("sinkage   -"), std::string::npos) << run.out;
  EXPECT_EQ(line(run.out, "pull"), "") << "no hitch";
}

TEST_F(RunSummary, AHitchAddsDrawbarPullAndMotionResistanceWithTheirInterval) {
  const Outcome run = call("run scene.toml --out a --set hitch.kind=force --set hitch.force=2000 --set hitch.ramp=0.01",
                           withSharedCache());
  ASSERT_EQ(run.code, 0) << run.errors;
  const std::string pull = line(run.out, "pull"), motion = line(run.out, "motion");
  // The drive starts at 0.01 s and its ramp ends at 0.06 s, so the steady part begins at 0.155 s or up to a tooth
  // later.
  EXPECT_NE(pull.find(" 2 kN, drawbar pull, mean from 0.1"), std::string::npos) << run.out;
  EXPECT_NE(pull.find(" to 0.25 s"), std::string::npos) << run.out;
  EXPECT_NE(motion.find(" kN, motion resistance, mean from 0.1"), std::string::npos) << run.out;
}

TEST_F(RunSummary, ASceneWithoutVehicleHasEnergyAndResults) {
  put(folder_ / "ball.toml", "version = 1\n[run]\nduration = 0.1\n[material.glass]\nstiffness = 1e4\n[[plane]]\n"
                             "material = \"glass\"\n[[grain]]\nposition = [0, 0, 0.02]\nradius = 0.01\n"
                             "material = \"glass\"\n");
  const Outcome run = call("run ball.toml --out ball");
  ASSERT_EQ(run.code, 0) << run.errors;
  EXPECT_EQ(line(run.out, "speed"), "") << run.out;
  EXPECT_NE(line(run.out, "energy"), "") << run.out;
  EXPECT_NE(line(run.out, "results"), "") << run.out;
}

} // namespace
} // namespace grouser::commands
