// SPDX-License-Identifier: BSD-3-Clause
// Branches: runs with another driver or hitch that start from the state of a run.
#include "runs/commands/run_scene.hpp"

#include "base/error.hpp"
#include "coupling/inputs.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/setup/provenance.hpp"
#include "runs/storage/checkpoint.hpp"
#include "runs/support/hdf5_file.hpp"
#include "tests/runs/csv_fixture.hpp"
#include "tests/runs/program_fixture.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fmt/format.h>

namespace grouser::commands {

using namespace test; // fixtures

namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

/// A coarse vehicle on rigid ground, settled after 40 ms and driving from 50 ms.
constexpr const char* kVehicle = R"(version = 1
[run]
duration = 0.12
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
SPEED
[output]
frames = false
plots = false
picture = false
)";

class Branch : public ProgramTest {
protected:
  static std::string text(const std::string& drive = "sprocket_speed = 2", const std::string& more = "") {
    std::string text = kVehicle;
    return text.replace(text.find("SPEED"), 5, drive) + more;
  }
  scene::Scene scene(const std::string& drive = "sprocket_speed = 2", const std::string& more = "",
                     const Words& overrides = {}) const {
    return setup::parseScene(text(drive, more), folder_ / "scene.toml", overrides);
  }

  output::Summary run(const std::string& name, const scene::Scene& scene, bool untilRest = false,
                      std::optional<std::int64_t> steps = {}) const {
    session::RunRequest options;
    options.folder = folder_ / name, options.hash = true, options.untilRest = untilRest, options.steps = steps;
    return runScene(scene, setup::provenanceOf(scene), options);
  }
  output::Summary branch(const std::string& name, const std::string& from, const scene::Scene& scene,
                         std::optional<std::int64_t> steps = {}) const {
    session::RunRequest options;
    options.folder = folder_ / name, options.hash = true, options.steps = steps;
    options.resume = checkpoint(from), options.branch = true;
    return runScene(scene, setup::provenanceOf(scene), options);
  }
  output::Summary resume(const std::string& name, const scene::Scene& scene) const {
    session::RunRequest options;
    options.folder = folder_ / name, options.hash = true, options.resume = checkpoint(name);
    return runScene(scene, setup::provenanceOf(scene), options);
  }
  fs::path checkpoint(const std::string& name) const { return folder_ / name / storage::kCheckpointName; }

  /// Last value of a series; `back` rows before the end.
  double last(const std::string& name, const std::string& path, std::size_t back = 0) const {
    const auto all = series(name, path);
    return all.at(all.size() - 1 - back);
  }
  double first(const std::string& name, const std::string& path) const { return series(name, path).at(0); }
  std::vector<double> series(const std::string& name, const std::string& path) const {
    return support::Hdf5File::open(folder_ / name / "results.h5").numbers("/" + path + "/value");
  }
  std::string manifest(const std::string& name) const { return contents(folder_ / name / "manifest.json"); }

  /// The residual is at rounding level in all rows of a run.
  void expectBalanced(const std::string& name) const {
    const std::vector<double> residual = series(name, "ledger/residual"), turnover = series(name, "ledger/turnover");
    for (std::size_t i = 0; i < residual.size(); ++i)
      EXPECT_LT(std::fabs(residual[i]), 1e-9 * turnover[i]) << name << ", row " << i;
  }
};

const std::string kCarriage = "[hitch]\nkind = \"speed\"\nslip = 0.3\nramp = 0.02\n";
const std::string kForce = "[hitch]\nkind = \"force\"\nforce = 10e3\nramp = 0.02\n";
const std::string kCourse = "[driver.course]\nspeed = 0.5\nacceleration = 5\nx = [1, 3, 6]\ny = [0, 0.2, 0]\n";

TEST_F(Branch, WithTheSameKeysEndsAsTheRunStraightThrough) {
  const std::string hash = run("straight", scene()).stateHash;
  const output::Summary rest = run("rest", scene(), true);
  EXPECT_EQ(rest.steps, 500) << "the next step is the first of the drive";
  EXPECT_NE(manifest("rest").find("\"ended_by\": \"--until rest\""), std::string::npos);
  EXPECT_NE(manifest("rest").find("\"status\": \"finished\""), std::string::npos) << "no drive was requested";
  const std::string before = contents(checkpoint("rest"));
  EXPECT_EQ(branch("again", "rest", scene()).stateHash, hash);
  EXPECT_EQ(contents(checkpoint("rest")), before) << "the checkpoint is unchanged";
  EXPECT_NE(manifest("again").find(fmt::format("\"branched_from\": \"{}, step 500, state hash {}\"",
                                               checkpoint("rest").string(), rest.stateHash)),
            std::string::npos)
      << manifest("again");
  const Csv whole(folder_ / "straight/timeseries.csv"), part(folder_ / "again/timeseries.csv");
  ASSERT_EQ(whole.rows.size(), 13u);
  EXPECT_EQ(part.rows, decltype(part.rows)(whole.rows.begin() + 6, whole.rows.end())) << "rows from the branch onwards";
}

TEST_F(Branch, AtRestIsTheRunThatHadTheseKeysFromTheStart) {
  const output::Summary rest = run("rest", scene(), true);
  const struct {
    std::string name, drive, more;
  } kOthers[] = {{"slow", "sprocket_speed = 1", ""},
                 {"table", "[driver.table]\ntime = [0, 0.04]\nleft = [0, 2]\nright = [0, 1]", ""},
                 {"course", kCourse, ""},
                 {"hitch", "sprocket_speed = 2", kCarriage}};
  for (const auto& [name, drive, more] : kOthers) {
    // Its own state at the branch, then its end.
    EXPECT_EQ(run(name + "_rest", scene(drive, more), true).stateHash == rest.stateHash,
              name != "hitch" && name != "course")
        << name << ": hitch and course have states of their own";
    const std::string hash = run(name, scene(drive, more)).stateHash;
    EXPECT_EQ(branch(name + "_branch", "rest", scene(drive, more)).stateHash, hash) << name;
    expectBalanced(name + "_branch");
  }
  EXPECT_NE(run("straight", scene()).stateHash, branch("slow_again", "rest", scene("sprocket_speed = 1")).stateHash);
}

TEST_F(Branch, UntilRestEndsWhereAWaitingDriverWouldDriveOff) {
  const Words waits = {"driver.drive_start=auto", "driver.rest_speed=1", "driver.rest_load=0.5", "run.duration=0.4"};
  const output::Summary rest = run("rest", scene("sprocket_speed = 2", "", waits), true);
  EXPECT_LT(rest.steps, 4000);
  EXPECT_EQ(rest.steps % 50, 0);
  EXPECT_NEAR(rest.figures.at("drive_start_s"), 1e-4 * static_cast<double>(rest.steps), 1e-12);
  const std::string hash = run("straight", scene("sprocket_speed = 1", "", waits), false, rest.steps + 300).stateHash;
  EXPECT_EQ(branch("slow", "rest", scene("sprocket_speed = 1", "", waits), rest.steps + 300).stateHash, hash);
}

TEST_F(Branch, UntilRestOfAVehicleThatDoesNotComeToRestIsIncomplete) {
  const output::Summary brief =
      run("rest", scene("sprocket_speed = 2", "", {"driver.drive_start=auto", "run.duration=0.06"}), true);
  EXPECT_NE(brief.incomplete.find("had not come to rest"), std::string::npos) << brief.incomplete;
}

/// Control inputs of the parent run do not act on the drive of a branch.
TEST_F(Branch, OfASteeredRunDrivesAsItsOwnSceneSays) {
  run("steered", scene(), false, 900);
  storage::Checkpoint state = storage::readCheckpoint(checkpoint("steered"));
  coupling::Inputs inputs;
  for (const std::int32_t side : {0, 1}) inputs.set({600, coupling::InputKind::sprocketSpeed, side, false, {3}});
  state.state.inputs = inputs.save();
  storage::writeCheckpoint(checkpoint("steered"), state);
  branch("alike", "steered", scene());
  EXPECT_NEAR(last("alike", "vehicle/left/sprocket_speed"), 3, 1e-9) << "with the same keys it continues unchanged";
  branch("slow", "steered", scene("sprocket_speed = 1"));
  EXPECT_NEAR(last("slow", "vehicle/left/sprocket_speed"), 1, 1e-9);
  EXPECT_EQ(support::Hdf5File::open(folder_ / "slow/results.h5").numbers("/inputs/series").size(),
            4u * coupling::Input::kNumbers)
      << "two settings, two releases";
}

TEST_F(Branch, UnderWayPassesFromTheFormerSpeedIntoTheNewOne) {
  run("fast", scene(), false, 900);
  EXPECT_NEAR(last("fast", "vehicle/left/sprocket_speed"), 2, 1e-9);
  const auto slow = [&] { return scene("sprocket_speed = 1", "", {"run.output_interval=1e-3"}); };
  branch("slow", "fast", slow());
  const std::vector<double> speed = series("slow", "vehicle/left/sprocket_speed");
  ASSERT_EQ(speed.size(), 30u);
  for (std::size_t ms = 1; ms <= 20; ++ms) {
    const double s = static_cast<double>(ms) / 20;
    EXPECT_NEAR(speed[ms - 1], 2 - s * s * (3 - 2 * s), 0.01) << "one step behind"; // 1.5 / 20 ms * 0.1 ms
  }
  EXPECT_NEAR(speed.back(), 1, 1e-9);
  expectBalanced("slow");
  // A run stopped within the ramp resumes and keeps the ramp's initial speed.
  branch("stopped", "fast", slow(), 1000);
  EXPECT_EQ(resume("stopped", slow()).stateHash, branch("once", "fast", slow()).stateHash);
  EXPECT_NE(manifest("stopped").find("\"branched_from\": \"" + checkpoint("fast").string() + ", step 900"),
            std::string::npos);
}

TEST_F(Branch, ACourseUnderWayTakesUpItsSpeedFromTheHulls) {
  run("fast", scene(), false, 900);
  branch("course", "fast", scene(kCourse, "", {"run.output_interval=1e-3"}));
  const std::vector<double> speed = series("course", "vehicle/left/sprocket_speed");
  double before = last("fast", "vehicle/left/sprocket_speed");
  for (const double now : speed) {
    EXPECT_LT(std::fabs(now - before), 0.5) << "no jump, unlike a course from standstill";
    before = now;
  }
  expectBalanced("course");
}

TEST_F(Branch, AHitchAddedUnderWayTakesHoldThereAndKeepsTheBooks) {
  run("free", scene(), false, 700);
  branch("towing", "free", scene("sprocket_speed = 2", kForce));
  expectBalanced("towing");
  EXPECT_LT(std::fabs(first("towing", "hitch/pull")), 0.8 * 10e3) << "it rises over its ramp";
  EXPECT_NEAR(last("towing", "hitch/pull"), 10e3, 1);
  EXPECT_LT(std::fabs(first("towing", "hitch/work")), std::fabs(last("towing", "hitch/work")));
}

TEST_F(Branch, AHitchThatIsRemovedLeavesItsWorkInTheLedger) {
  run("towing", scene("sprocket_speed = 2", kForce), false, 1000);
  const double work = last("towing", "hitch/work");
  ASSERT_LT(work, -10);
  for (const std::string& more : {std::string(), kCarriage}) {
    const std::string name = more.empty() ? "free" : "carriage";
    branch(name, "towing", scene("sprocket_speed = 2", more), 1100);
    expectBalanced(name);
    EXPECT_LT(std::fabs(last(name, "ledger/integration_error") - last("towing", "ledger/integration_error")),
              0.3 * std::fabs(work))
        << "without that work the residual would be as large";
  }
  EXPECT_LT(std::fabs(last("carriage", "hitch/work")), 0.5 * std::fabs(work)) << "separate ledger";
}

TEST_F(Branch, KeysThatHaveShapedTheStateAreRefusedByName) {
  run("rest", scene(), true);
  for (const std::string key : {"driver.tension_ramp=0.01", "driver.weight_ramp=0.01", "driver.drive_start=0.06",
                                "vehicle.clearance=2e-6", "run.seed=2"}) {
    const std::string name = key.substr(0, key.find('='));
    try {
      branch("no", "rest", scene("sprocket_speed = 1", "", {key}));
      ADD_FAILURE() << key;
    } catch (const base::InputError& error) {
      const std::string what = error.what();
      EXPECT_NE(what.find(name + " = "), std::string::npos) << what;
      EXPECT_NE(what.find(" was "), std::string::npos) << what;
      EXPECT_NE(what.find("restore it"), std::string::npos) << what;
    }
  }
  try {
    branch("no", "rest", scene("drive = \"torque\"\ntorque = 100"));
    ADD_FAILURE();
  } catch (const base::InputError& error) {
    EXPECT_NE(std::string(error.what()).find("driver.drive = \"torque\" was \"speed\""), std::string::npos)
        << error.what();
  }
  EXPECT_FALSE(fs::exists(folder_ / "no"));
}

TEST_F(Branch, OtherAutomaticStepsAreRefused) {
  const Words step = {"run.time_step=auto"};
  run("rest", scene("sprocket_speed = 2", "", step), true);
  try {
    branch("no", "rest",
           scene("sprocket_speed = 2", "[hitch]\nkind = \"speed\"\nslip = 0.1\nstiffness = 1e11\n", step));
    ADD_FAILURE();
  } catch (const base::InputError& error) {
    EXPECT_NE(std::string(error.what()).find("run.time_step"), std::string::npos) << error.what();
  }
}

TEST_F(Branch, OfTheProgramGoesToAFolderOfItsOwn) {
  put(folder_ / "v.toml", text());
  const Outcome rest = call("run v.toml --until rest --hash");
  ASSERT_EQ(rest.code, 0) << rest.errors;
  const std::string rows = contents(folder_ / "out/v/timeseries.csv");
  const Outcome slow = call("run v.toml --resume --set driver.sprocket_speed=1 --hash");
  ASSERT_EQ(slow.code, 0) << slow.errors;
  const std::string hash = rest.hash().substr(11, 16);
  EXPECT_NE(slow.out.find(fmt::format("branch    from {}, step 500, state hash {} (0.05 s)\n",
                                      fs::canonical(folder_ / "out/v/checkpoint.h5").string(), hash)),
            std::string::npos)
      << slow.out;
  EXPECT_EQ(contents(folder_ / "out/v/timeseries.csv"), rows);
  EXPECT_TRUE(fs::exists(folder_ / "out/v_branch/results.h5"));
  const Outcome named =
      call("run v.toml --resume out/v/checkpoint.h5 --out named --set driver.sprocket_speed=1 --hash");
  EXPECT_EQ(named.hash(), slow.hash());
  // No overwriting: neither of the parent run, even with --force, nor of a branch.
  for (const char* words :
       {"run v.toml --resume --out out/v --force --set driver.sprocket_speed=1",
        "run v.toml --resume out/v/checkpoint.h5 --out out/v --force --set driver.sprocket_speed=1"}) {
    const Outcome over = call(words);
    EXPECT_EQ(over.code, 2);
    EXPECT_NE(over.error().find("out/v: contains the original run"), std::string::npos) << over.errors;
  }
  EXPECT_NE(call("run v.toml --resume --set driver.sprocket_speed=3").error().find("not empty"), std::string::npos);
  EXPECT_EQ(contents(folder_ / "out/v/timeseries.csv"), rows);
  // Without other keys the run continues in place.
  const Outcome on = call("run v.toml --resume --hash");
  EXPECT_NE(on.out.find("resumed   at step 500"), std::string::npos) << on.out;
  EXPECT_EQ(contents(folder_ / "out/v/timeseries.csv").rfind(rows, 0), 0u) << "rows are kept";
}

TEST_F(Branch, UntilRestNeedsAVehicle) {
  put(folder_ / "fall.toml", "version = 1\n[run]\nduration = 1e-3\ntime_step = 1e-5\n[material.glass]\n[[grain]]\n"
                             "position = [0, 0, 1]\nradius = 0.01\nmaterial = \"glass\"\n");
  const Outcome none = call("run fall.toml --until rest");
  EXPECT_EQ(none.code, 2);
  EXPECT_NE(none.error().find("--until rest requires a vehicle"), std::string::npos) << none.errors;
  EXPECT_EQ(call("run fall.toml --until dawn").code, 2);
}

} // namespace
} // namespace grouser::commands
