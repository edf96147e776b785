// SPDX-License-Identifier: BSD-3-Clause
// Table of a sweep: steady part of a run, its figures, and their intervals over seeds.
#include "runs/campaigns/sweeps/run_figures.hpp"
#include "runs/campaigns/sweeps/sweep.hpp"
#include "runs/campaigns/sweeps/sweep_intervals.hpp"
#include "runs/campaigns/sweeps/sweep_summary.hpp"
#include "runs/output/output.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/setup/provenance.hpp"
#include "tests/runs/csv_fixture.hpp"
#include "tests/runs/row_builder.hpp"
#include "tests/runs/scene_fixture.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <string>
#include <vector>

namespace grouser::sweeps {

using namespace test; // fixtures

namespace {

class SweepSummary : public FolderTest {};

TEST_F(SweepSummary, SteadyPartIsTheSecondHalfOfWhatFollowsTheRamp) {
  scene::Scene scene = setup::parseScene(goodScene(), std::string(GROUSER_SOURCE_DIR) + "/scene.toml");
  scene.run.duration = 3, scene.driver.driveStart = 0.7, scene.driver.driveRamp = 0.3;
  EXPECT_DOUBLE_EQ(steadyFrom(scene), 2.0);
  EXPECT_DOUBLE_EQ(steadyFrom(scene, 1.0, 2.3), 1.8) << "it started later, and [stop] ended the run";
  scene.driver.table = scene::SpeedTable{{0, 1.3}, {0, 1}, {0, 1}};
  EXPECT_DOUBLE_EQ(steadyFrom(scene), 2.5);
  scene.run.duration = 1;
  EXPECT_TRUE(std::isnan(steadyFrom(scene)));
  scene.vehicle.reset();
  EXPECT_DOUBLE_EQ(steadyFrom(scene), 0.5);
}

/// Speed of a vehicle that starts at t = 2 s; formulas below.
TEST_F(SweepSummary, FiguresAreMeansAndExtremesOverTheSteadyPart) {
  SweepPlan plan;
  plan.keys = {"driver.sprocket_speed"};
  plan.runs = {
      {"sprocket_speed=2", {"2"}, {}, setup::parseScene(goodScene(), std::string(GROUSER_SOURCE_DIR) + "/scene.toml")}};
  scene::Scene& scene = plan.runs[0].scene;
  scene.run.duration = 30, scene.driver.driveStart = 0.7, scene.driver.driveRamp = 0.3; // steady from 2 s on: see below

  std::vector<output::Channel> channels = {{"vehicle/motion_resistance", "N", "", 1, {}},
                                           {"ledger/integration_error", "J", "", 1, {}},
                                           {"ledger/impulse_residual", "N s", "", 3, {"x", "y", "z"}}};
  for (const std::string side : {"left", "right"}) {
    for (const char* scalar : {"sprocket_speed", "speed", "mean_torque", "drive_power", "teeth_passed"})
      channels.push_back({"vehicle/" + side + "/" + scalar, "", "", 1, {}});
    for (const char* shoes : {"sinkage", "tension"})
      channels.push_back({"vehicle/" + side + "/" + shoes, "", "", 2, {}});
  }
  output::RunWriter writer(folder_ / "sprocket_speed=2", setup::provenanceOf(scene), channels, {});
  writer.constant(output::kPitchRadius, 0.25);
  RowBuilder row(channels);
  for (int r = 0; r <= 30; ++r) {
    const bool isSteady = r >= 20;
    row.begin(100 * r, 0.1 * r);
    for (const std::string side : {"left", "right"}) {
      const double of = side == "left" ? 1 : 3;
      row.set("vehicle/" + side + "/sprocket_speed", isSteady ? 2 : 77);
      row.set("vehicle/" + side + "/speed", isSteady ? 0.2 * of : 77); // mean 0.4 of 0.5 m/s
      row.set("vehicle/" + side + "/teeth_passed", 0.5 * r * of);      // 10 rows: 5 and 15
      row.set("vehicle/" + side + "/mean_torque", isSteady ? 100 * of : 77);
      row.set("vehicle/" + side + "/drive_power", isSteady ? 200 * of : 77);
      row.set("vehicle/" + side + "/sinkage",
              std::vector<double>{isSteady ? 0.01 * of : 77, std::nan("")}); // one shoe is off the ground
      row.set("vehicle/" + side + "/tension",
              std::vector<double>{isSteady ? 1000.0 : 77e3, isSteady && r == 25 ? 6000 * of : 1000.0});
    }
    row.set("vehicle/motion_resistance", isSteady ? 50 + 10 * (r % 2 ? 1 : -1) : 77);
    row.set("ledger/integration_error", 0.1 * r);
    row.set("ledger/impulse_residual", base::Vec3d{0, 3, 4});
    writer.row(row.row());
  }
  output::Summary summary;
  summary.steps = 3000, summary.wallTime = 12.5, summary.stateHash = "0123456789abcdef";
  summary.simulatedTime = 3;
  writer.finish(summary);

  const Csv csv(writeSummary(plan, {{output::RunStatus::finished, ""}}, folder_));
  const auto number = [&](const char* column) { return std::stod(csv.at(0, column)); };
  EXPECT_EQ(csv.at(0, "driver.sprocket_speed"), "2");
  EXPECT_EQ(number("wall time [s]"), 12.5);
  EXPECT_EQ(csv.at(0, "state hash"), "0123456789abcdef");
  // Nine digits are written.
  EXPECT_NEAR(number("steady from [s]"), 2, 1e-8);
  EXPECT_NEAR(number("teeth passed [-]"), 10, 1e-8) << "mean of both sprockets";
  EXPECT_NEAR(number("speed [m/s]"), 0.4, 1e-8);
  EXPECT_NEAR(number("slip [-]"), 1 - 0.4 / 0.5, 1e-8);
  EXPECT_NEAR(number("sinkage mean [m]"), 0.02, 1e-9);
  EXPECT_NEAR(number("sinkage max [m]"), 0.03, 1e-9);
  EXPECT_NEAR(number("drive torque [N m]"), 400, 1e-6);
  EXPECT_NEAR(number("drive power [W]"), 800, 1e-6);
  EXPECT_NEAR(number("tension mean [N]"), 1000 + (5000 + 17000) / 40.0, 1e-5) << "10 rows (5 teeth), 2 tracks, 2 shoes";
  EXPECT_NEAR(number("tension peak [N]"), 18000, 1e-4);
  EXPECT_NEAR(number("motion resistance [N]"), 50, 1e-7) << "the ripple of a whole number of teeth cancels";
  EXPECT_NEAR(number("integration error [J]"), 3, 1e-8) << "at the end";
  EXPECT_NEAR(number("impulse residual [N s]"), 5, 1e-8);
  EXPECT_EQ(csv.at(0, "drawbar pull [N]"), "") << "values missing in the results stay empty";
  // A report uses the same steady part; its end depends on [stop].
  const auto printed = nlohmann::json(runFigures(folder_ / "sprocket_speed=2"));
  ASSERT_TRUE(printed["steady_from"].is_number()) << printed.dump();
  EXPECT_NEAR(printed["steady_from"].get<double>(), 2, 1e-12);
}

/// By hand: 2, 4, 6 have mean 4 and half width t(2) 2 / sqrt 3, t(2) = 4.3027; the differences to 1, 2, 3
/// are 1, 2, 3 with mean 2 and half width t(2) / sqrt 3, divided by the first's mean of 2.
TEST(SweepIntervals, AreStudentsOverTheSeedsAndPairedWhereTheyDiffer) {
  SweepPlan plan;
  plan.keys = {kCaseKey, kSeedKey};
  for (const char* name : {"base", "other"})
    for (const char* seed : {"1", "2", "3"}) plan.runs.push_back({"", {name, seed}, {}, {}});
  plan.runs.push_back({"", {"other", "4"}, {}, {}}); // has no match among the first
  SweepFigures figures;
  figures.columns = {"speed [m/s]", "slip [-]"};
  for (const double v : {1.0, 2.0, 3.0, 2.0, 4.0, 6.0}) figures.values.push_back({v, std::nan("")});
  figures.values.push_back({std::nan(""), std::nan("")}); // a failed run
  const SeedIntervals all = seedIntervals(plan, figures);
  ASSERT_EQ(all.groups.size(), 2u);
  EXPECT_EQ(all.keys, std::vector<std::string>{kCaseKey});
  EXPECT_EQ(all.groups[1].values, std::vector<std::string>{"other"});
  EXPECT_EQ(all.groups[1].runs, 3);
  const double t = 4.30265 / std::sqrt(3.0); // the program's quantile has three decimals
  EXPECT_NEAR(all.groups[1].figures[0].value, 4, 1e-12);
  EXPECT_NEAR(all.groups[1].figures[0].halfWidth, 2 * t, 1e-3);
  EXPECT_NEAR(all.groups[1].differences[0].value, 1, 1e-12);
  EXPECT_NEAR(all.groups[1].differences[0].halfWidth, t / 2, 1e-3);
  EXPECT_EQ(all.groups[0].differences[0].value, 0);
  EXPECT_TRUE(std::isnan(all.groups[1].figures[1].value)) << "no run has this figure";
  EXPECT_NEAR(all.groups[1].changes[0].value, 2, 1e-12);
  EXPECT_NEAR(all.groups[1].changes[0].halfWidth, t, 1e-3);
  // 2 +- 2.48 includes zero: no relative values.
  EXPECT_NE(intervalsText(all).find("+2.0 +- 2.5\n"), std::string::npos) << intervalsText(all);
  for (std::vector<double>& row : figures.values) row[0] += 10;
  EXPECT_NE(intervalsText(seedIntervals(plan, figures)).find("+16.7 +- "), std::string::npos);
  plan.keys = {kCaseKey, "run.skin"};
  EXPECT_TRUE(seedIntervals(plan, figures).groups.empty()) << "no seeds, no intervals";
}

} // namespace
} // namespace grouser::sweeps
