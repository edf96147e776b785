// SPDX-License-Identifier: BSD-3-Clause
// summary.csv of runs in which all quantities change over the steady part, each in its own way.
#include "runs/campaigns/sweeps/sweep_summary.hpp"

#include "runs/output/channels.hpp"
#include "runs/output/output.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/setup/provenance.hpp"
#include "tests/runs/csv_fixture.hpp"
#include "tests/runs/folder_fixture.hpp"
#include "tests/runs/row_builder.hpp"
#include "tests/runs/scene_fixture.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace grouser::sweeps {

using namespace test; // fixtures

namespace {

class SummaryValues : public FolderTest {
protected:
  static SweepPlan planOf(const std::string& scene) {
    SweepPlan plan;
    plan.keys = {"run.seed"};
    plan.runs = {{"seed=1", {"1"}, {}, setup::parseScene(scene, std::string(GROUSER_SOURCE_DIR) + "/scene.toml")}};
    return plan;
  }
  Csv written(const SweepPlan& plan) const {
    return Csv(writeSummary(plan, {{output::RunStatus::finished, ""}}, folder_));
  }
};

/// The file has nine digits.
void expectNine(double is, double wanted, const char* what) {
  EXPECT_NEAR(is, wanted, 2e-9 * std::fabs(wanted)) << what;
}

TEST_F(SummaryValues, OfAVehicleAreMeansOverTheSteadyPartOfEachQuantityAndTheirProducts) {
  SweepPlan plan = planOf(goodScene());
  scene::Scene& scene = plan.runs[0].scene;
  scene.run.duration = 3, scene.driver.driveStart = 0.7, scene.driver.driveRamp = 0.3; // steady from 2 s on
  std::vector<output::Channel> channels = {
      {"vehicle/gross_traction", "N", "", 1, {}},    {"vehicle/drawbar_pull", "N", "", 1, {}},
      {"vehicle/motion_resistance", "N", "", 1, {}}, {"ledger/drive_work", "J", "", 1, {}},
      {"ledger/integration_error", "J", "", 1, {}},  {"ledger/impulse_residual", "N s", "", 3, {"x", "y", "z"}}};
  for (const std::string side : {"left", "right"}) {
    for (const char* scalar : {"sprocket_speed", "speed", "mean_torque", "drive_power", "teeth_passed"})
      channels.push_back({"vehicle/" + side + "/" + scalar, "", "", 1, {}});
    for (const char* shoes : {"sinkage", "tension"})
      channels.push_back({"vehicle/" + side + "/" + shoes, "", "", 3, {}});
  }
  output::RunWriter writer(folder_ / "seed=1", setup::provenanceOf(scene), channels, {});
  writer.constant(output::kPitchRadius, 0.25);
  RowBuilder row(channels);
  for (int r = 0; r <= 30; ++r) {
    // Before 2 s all values are far off; then u increases from -1 to 1 in 11 rows.
    const double u = r < 20 ? 50 : (r - 25) / 5.0;
    row.begin(100 * r, 0.1 * r);
    row.set("vehicle/left/sprocket_speed", 3 + u), row.set("vehicle/right/sprocket_speed", 2 - 0.5 * u);
    row.set("vehicle/left/mean_torque", 400 + 100 * u), row.set("vehicle/right/mean_torque", 300 + 60 * u);
    row.set("vehicle/left/drive_power", 1240 + 700 * u), row.set("vehicle/right/drive_power", 588 - 30 * u);
    row.set("vehicle/left/speed", 0.5 + 0.2 * u), row.set("vehicle/right/speed", 0.3 - 0.1 * u);
    row.set("vehicle/left/teeth_passed", 10 + 5 * u), row.set("vehicle/right/teeth_passed", 20 + 3 * u);
    // One shoe sinks, one rises, one carries load in one row only.
    for (const std::string side : {"left", "right"}) {
      const double of = side == "left" ? 1 : 2;
      row.set("vehicle/" + side + "/sinkage",
              std::vector<double>{of * (0.01 + 0.004 * u), of * (0.02 - 0.01 * u), r == 22 ? 0.05 : std::nan("")});
      row.set("vehicle/" + side + "/tension", std::vector<double>{of * 1000 * (2 + u), of * 5000, 700 * (1 - u)});
    }
    row.set("vehicle/gross_traction", 2800 + 640 * u), row.set("vehicle/drawbar_pull", 2000 + 300 * u);
    row.set("vehicle/motion_resistance", 800 + 340 * u);
    row.set("ledger/drive_work", 1000 + 7 * r), row.set("ledger/integration_error", -0.25 * r);
    row.set("ledger/impulse_residual", base::Vec3d{0.02 * r, -0.03 * r, 0.06 * r});
    writer.row(row.row());
  }
  output::Summary summary;
  summary.steps = 3000, summary.wallTime = 12.5, summary.simulatedTime = 3.25;
  writer.finish(summary);

  const Csv csv = written(plan);
  const auto number = [&](const char* column) { return csv.number(0, column); };
  // Mean of u: 0; of u^2 over -1, -0.8 ... 1: 0.4.
  expectNine(number("wall time [s]"), 12.5, "wall time");
  expectNine(number("steps"), 3000, "steps");
  expectNine(number("simulated time [s]"), 3.25, "simulated time");
  expectNine(number("teeth passed [-]"), 0.5 * (10 + 6), "teeth");
  expectNine(number("speed [m/s]"), 0.4, "speed");
  expectNine(number("slip [-]"), 1 - 0.4 / (2.5 * 0.25), "slip");
  expectNine(number("drive torque [N m]"), 700, "torque");
  expectNine(number("drive power [W]"), 1240 + 588, "power");
  expectNine(number("gross traction [N]"), 2800, "traction");
  expectNine(number("drawbar pull [N]"), 2000, "pull");
  expectNine(number("motion resistance [N]"), 800, "resistance");
  // 11 rows of two shoes and one row of a third, both tracks.
  expectNine(number("sinkage mean [m]"), (11 * (0.01 + 0.02) * 3 + 2 * 0.05) / 46, "sinkage");
  expectNine(number("sinkage max [m]"), 2 * 0.03, "largest sinkage");
  expectNine(number("tension mean [N]"), (3 * 2000 + 3 * 5000 + 2 * 700) / 6.0, "tension");
  expectNine(number("tension peak [N]"), 10000, "largest tension");
  expectNine(number("drive work [J]"), 1210, "work at the end");
  expectNine(number("integration error [J]"), -7.5, "error at the end");
  expectNine(number("impulse residual [N s]"), 2.1, "|(0.6, -0.9, 1.8)| at the end");
  expectNine(number("steady from [s]"), 2, "steady from");
}

TEST_F(SummaryValues, OfSurfacesAreMeansByAxisAndPlacesAtTheEnd) {
  const SweepPlan plan =
      planOf("version = 1\n[run]\nduration = 2\ntime_step = 1e-4\n[material.glass]\n"
             "[[plane]]\nname = \"belt\"\nmaterial = \"glass\"\n"
             "[[box]]\nname = \"lid\"\nposition = [0, 0, 1]\nsize = [1, 1, 1]\nmaterial = \"glass\"\n"
             "[[grain]]\nposition = [0, 0, 0.1]\nradius = 0.01\nmaterial = \"glass\"\n");
  std::vector<output::Channel> channels = output::surfaceColumns("belt").channels();
  const std::vector<output::Channel> lid = output::surfaceColumns("lid").channels();
  channels.insert(channels.end(), lid.begin(), lid.end());
  output::RunWriter writer(folder_ / "seed=1", setup::provenanceOf(plan.runs[0].scene), channels, {});
  RowBuilder row(channels);
  for (int r = 0; r <= 20; ++r) {
    // Steady from 1 s on: u = 0 ... 10, mean 5.
    const double u = r < 10 ? 1e3 : r - 10;
    row.begin(1000 * r, 0.1 * r);
    for (const std::string name : {"belt", "lid"}) {
      const double of = name == "belt" ? 1 : -2;
      row.set("surfaces/" + name + "/force", base::Vec3d{1 + u, 2 + u, 3 + u} * of);
      row.set("surfaces/" + name + "/torque", base::Vec3d{4 + u, 5 + u, 6 + u} * of);
      row.set("surfaces/" + name + "/power", (7 + u) * of);
      row.set("surfaces/" + name + "/position", base::Vec3d{0.1 * r, 0.2 * r, 0.3 * r} * of);
    }
    writer.row(row.row());
  }
  writer.finish({});
  const Csv csv = written(plan);
  for (const std::string name : {"belt", "lid"}) {
    const double of = name == "belt" ? 1 : -2;
    for (int a = 0; a < 3; ++a) {
      const std::string axis(1, "xyz"[a]);
      expectNine(csv.number(0, name + " force " + axis + " [N]"), (6 + a) * of, "force");
      expectNine(csv.number(0, name + " torque " + axis + " [N m]"), (9 + a) * of, "torque");
      expectNine(csv.number(0, name + " position " + axis + " at the end [m]"), 2 * (1 + a) * of, "position");
    }
    expectNine(csv.number(0, name + " power [W]"), 12 * of, "power");
  }
  expectNine(csv.number(0, "steady from [s]"), 1, "steady from");
}

} // namespace
} // namespace grouser::sweeps
