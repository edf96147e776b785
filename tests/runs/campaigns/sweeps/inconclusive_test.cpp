// SPDX-License-Identifier: BSD-3-Clause
// Results of runs in reverse, with pivot turns, on one track, or with hardly any driving.
#include "runs/campaigns/sweeps/check_report.hpp"
#include "runs/campaigns/sweeps/sweep_intervals.hpp"
#include "runs/campaigns/sweeps/sweep_summary.hpp"

#include "runs/output/output.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/setup/provenance.hpp"
#include "tests/runs/csv_fixture.hpp"
#include "tests/runs/folder_fixture.hpp"
#include "tests/runs/row_builder.hpp"
#include "tests/runs/scene_fixture.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

namespace grouser::sweeps {

using namespace test; // fixtures

namespace {

/// One track: sprocket [rad/s], hull there [m/s], torque [N m], teeth per second.
struct Driven {
  double turns, speed, torque, teeth;
};

class Inconclusive : public FolderTest {
protected:
  SweepPlan plan_;

  /// Runs of 3 s, steady from 2 s.
  Inconclusive() {
    plan_.keys = {"run.seed"};
    for (const std::string seed : {"1", "2"}) {
      plan_.runs.push_back(
          {"seed=" + seed, {seed}, {}, setup::parseScene(goodScene(), GROUSER_SOURCE_DIR "/scene.toml")});
      scene::Scene& scene = plan_.runs.back().scene;
      scene.run.duration = 3, scene.driver.driveStart = 0.7, scene.driver.driveRamp = 0.3;
    }
  }
  /// `turned`: in every second row the vehicle moves backwards. `resumed`: at this step, of 3000.
  void write(std::size_t run, const Driven& left, const std::optional<Driven>& right, bool turned = false,
             double resumed = 0) {
    std::vector<output::Channel> channels;
    for (const std::string side : {"left", "right"})
      for (const char* scalar : {"sprocket_speed", "speed", "mean_torque", "drive_power", "teeth_passed"})
        if (side == "left" || right) channels.push_back({"vehicle/" + side + "/" + scalar, "", "", 1, {}});
    channels.push_back({"vehicle/gross_traction", "N", "", 1, {}});
    std::filesystem::remove_all(folder_ / plan_.runs[run].name);
    output::RunWriter writer(folder_ / plan_.runs[run].name, setup::provenanceOf(plan_.runs[run].scene), channels, {});
    writer.constant(output::kPitchRadius, 0.25);
    RowBuilder row(channels);
    for (int r = 0; r <= 30; ++r) {
      row.begin(100 * r, 0.1 * r);
      const auto set = [&](const std::string& side, const Driven& d) {
        row.set("vehicle/" + side + "/sprocket_speed", d.turns), row.set("vehicle/" + side + "/speed", d.speed);
        row.set("vehicle/" + side + "/mean_torque", d.torque), row.set("vehicle/" + side + "/drive_power", 1);
        row.set("vehicle/" + side + "/teeth_passed", d.teeth * 0.1 * r);
      };
      set("left", left);
      if (right) set("right", *right);
      const double torque = left.torque + (right ? right->torque : 0),
                   way = left.turns < 0 || (turned && r % 2) ? -1 : 1;
      row.set("vehicle/gross_traction", way * torque / 0.25);
      writer.row(row.row());
    }
    output::Summary summary;
    summary.steps = 3000, summary.simulatedTime = 3, summary.wallTime = 10;
    if (resumed > 0) summary.figures["resumed_at_step"] = resumed;
    writer.finish(summary);
  }
  Csv written(output::RunStatus status = output::RunStatus::finished, const std::string& message = "") const {
    return Csv(writeSummary(plan_, {{status, message}, {}}, folder_));
  }
};

/// The file has nine digits.
constexpr double kNine = 2e-9;

TEST_F(Inconclusive, SlipIsThatOfEachTrackWhereItRunsTo) {
  // Slip 0.4 each: in reverse, in a pivot turn, and in the opposite pivot turn.
  for (const double way : {-1.0, 1.0})
    for (const double other : {-1.0, 1.0}) {
      write(0, {way * 2, way * 0.3, 500, way * 4}, Driven{other * 2, other * 0.3, 500, other * 4});
      const Csv csv = written();
      EXPECT_NEAR(csv.number(0, "slip [-]"), 0.4, kNine) << way << " " << other;
      EXPECT_NEAR(csv.number(0, "teeth passed [-]"), 4, 4 * kNine) << way << " " << other;
      EXPECT_EQ(csv.at(0, "inconclusive"), "");
    }
  // Braked: the hull is faster than its tracks.
  write(0, {2, 0.6, -500, 4}, Driven{2, 0.6, -500, 4});
  EXPECT_NEAR(written().number(0, "slip [-]"), -0.2, kNine);
}

/// A locked sprocket rotates by rounding errors.
TEST_F(Inconclusive, ALockedTrackHasNoPartInTheSlip) {
  for (const double rounding : {7.6e-48, -7.6e-48, 0.0}) {
    write(0, {rounding, 0.25, 0, 0}, Driven{2, 0.3, 500, 4});
    EXPECT_NEAR(written().number(0, "slip [-]"), 0.4, kNine) << rounding;
  }
}

TEST_F(Inconclusive, MeansAlongADirectionThatChangesAreMarkedAndCountInNoMean) {
  const std::string turned = "direction of motion changes: gross traction, drawbar pull, motion resistance";
  write(0, {2, 0.3, 500, 4}, Driven{2, 0.3, 500, 4});
  EXPECT_EQ(written().at(0, "inconclusive"), "") << "all forward";
  write(0, {-2, -0.3, -500, 4}, Driven{-2, -0.3, -500, 4});
  EXPECT_EQ(written().at(0, "inconclusive"), "") << "all backward";
  write(0, {2, 0.3, 500, 4}, Driven{2, 0.3, 500, 4}, true);
  EXPECT_EQ(written().at(0, "inconclusive"), turned);
  EXPECT_TRUE(std::isfinite(written().number(0, "gross traction [N]")));
  SweepFigures figures = sweepFigures(plan_, {{output::RunStatus::finished, ""}, {}}, folder_);
  figures.dropInconclusive({0});
  const auto valueOf = [&](const char* column) {
    const auto at = std::find(figures.columns.begin(), figures.columns.end(), column) - figures.columns.begin();
    return figures.values[0].at(static_cast<std::size_t>(at));
  };
  EXPECT_TRUE(std::isnan(valueOf("gross traction [N]")));
  EXPECT_NEAR(valueOf("speed [m/s]"), 0.3, 1e-12);
}

/// Half of the steps precede the resume.
TEST_F(Inconclusive, WallTimeIsThatOfAllStepsOfAResumedRun) {
  write(0, {2, 0.3, 500, 4}, Driven{2, 0.3, 500, 4}, false, 1500);
  EXPECT_NEAR(written().number(0, "wall time [s]"), 20, 20 * kNine);
  write(0, {2, 0.3, 500, 4}, Driven{2, 0.3, 500, 4}, false, 3000);
  EXPECT_NEAR(written().number(0, "wall time [s]"), 10, 10 * kNine) << "it resumed from its end";
}

TEST_F(Inconclusive, OneTrackHasFiguresOfItsOwn) {
  write(0, {2, 0.3, 500, 4}, {});
  const Csv csv = written();
  EXPECT_NEAR(csv.number(0, "drive torque [N m]"), 500, 500 * kNine);
  EXPECT_NEAR(csv.number(0, "teeth passed [-]"), 4, 4 * kNine);
  EXPECT_EQ(csv.at(0, "inconclusive"), "");
}

TEST_F(Inconclusive, FewerThanTwoTeethAreMarkedAndCountInNoMeanBesideSoundRuns) {
  const std::string few = "the steady part covers 1.9 teeth, fewer than 2";
  const auto ofSeeds = [&] {
    return seedIntervals(
        plan_, sweepFigures(plan_, {{output::RunStatus::finished, ""}, {output::RunStatus::finished, ""}}, folder_));
  };
  const auto torqueOf = [](const SeedIntervals& intervals) {
    for (std::size_t c = 0; c < intervals.columns.size(); ++c)
      if (intervals.columns[c] == "drive torque [N m]") return intervals.groups[0].figures[c].value;
    return std::nan("");
  };
  write(0, {2, 0.3, 500, 1.4}, Driven{2, 0.3, 500, 1.9});
  EXPECT_EQ(written().at(0, "inconclusive"), few) << "for the track with more teeth";
  write(1, {2, 0.3, 700, 2.1}, Driven{2, 0.3, 700, 1});
  EXPECT_EQ(ofSeeds().groups[0].runs, 1);
  EXPECT_EQ(ofSeeds().groups[0].doubt, "");
  EXPECT_NEAR(torqueOf(ofSeeds()), 1400, 1e-9);
  // None is conclusive: their mean is marked.
  write(1, {2, 0.3, 700, 1.9}, Driven{2, 0.3, 700, 1});
  EXPECT_EQ(ofSeeds().groups[0].runs, 2);
  EXPECT_EQ(ofSeeds().groups[0].doubt, few);
  EXPECT_NEAR(torqueOf(ofSeeds()), 1200, 1e-9);
  EXPECT_NE(intervalsText(ofSeeds()).find("2 seeds  inconclusive"), std::string::npos) << intervalsText(ofSeeds());
  EXPECT_EQ(Csv(writeIntervals(ofSeeds(), folder_)).at(0, "inconclusive"), few);
  // A scene that keeps the vehicle at rest requests means over zero teeth.
  plan_.runs[0].scene.driver.sprocketSpeed = 0;
  plan_.runs[0].scene.driver.left.reset(), plan_.runs[0].scene.driver.right.reset();
  EXPECT_EQ(written().at(0, "inconclusive"), "");
}

TEST_F(Inconclusive, AnIncompleteRunSaysWhy) {
  write(0, {0, 0, 0, 0}, Driven{0, 0, 0, 0});
  const Csv csv = written(output::RunStatus::incomplete, "the vehicle never drove");
  EXPECT_EQ(csv.at(0, "status"), "incomplete");
  EXPECT_EQ(csv.at(0, "message"), "the vehicle never drove");
  EXPECT_EQ(csv.at(0, "inconclusive"), "see message") << "once";
  EXPECT_EQ(csv.number(0, "steps"), 3000);
}

/// If the runs of a check hardly drove, only values that are 0 in all of them are conclusive.
TEST_F(Inconclusive, WhatIs0InAllRunsOfACheckIsSure) {
  CheckResults results;
  results.doubt = "the steady part covers 1.9 teeth, fewer than 2";
  for (const double value : {0.0, 500.0}) {
    CheckFigure& figure = results.figures.emplace_back();
    figure.name = "drive torque [N m]", figure.value = {value, 0}, figure.bar = 0;
  }
  const auto json = nlohmann::json::parse(checkJson({}, results));
  EXPECT_EQ(json["figures"][0]["inconclusive"], false);
  EXPECT_EQ(json["figures"][1]["inconclusive"], true);
}

/// -47 +- 12155: even the sign is unknown.
TEST_F(Inconclusive, IntervalsBeyondTheirOwnSizeAreMarked) {
  SweepFigures figures;
  figures.columns = {"drive torque [N m]", "speed [m/s]"};
  figures.values = {{-1000, 0.5}, {900, 0.51}};
  const SeedIntervals intervals = seedIntervals(plan_, figures);
  const std::string text = intervalsText(intervals);
  const std::size_t mark = text.find("inconclusive");
  EXPECT_GT(mark, text.find("drive torque")) << text;
  EXPECT_LT(mark, text.find("speed [m/s]")) << text;
  EXPECT_EQ(text.find("inconclusive", mark + 1), std::string::npos) << text;
  const Csv csv(writeIntervals(intervals, folder_));
  EXPECT_EQ(csv.at(0, "inconclusive"), "interval wider than the value");
  EXPECT_EQ(csv.at(1, "inconclusive"), "");
}

} // namespace
} // namespace grouser::sweeps
