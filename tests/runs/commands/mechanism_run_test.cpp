// SPDX-License-Identifier: BSD-3-Clause
// A mechanism on the command line: results, hash, resume, plan, sweep.
#include "base/math.hpp"
#include "runs/support/hdf5_file.hpp"
#include "tests/runs/commands/chain_fixture.hpp"
#include "tests/runs/program_fixture.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <regex>
#include <string>
#include <utility>

namespace grouser::commands {

using namespace test; // fixtures

namespace {

namespace fs = std::filesystem;

const std::string kMechanisms = GROUSER_SOURCE_DIR "/runs/mechanisms/";
const std::string kNoPictures = " --set output.plots=false --set output.picture=false";

class MechanismRun : public ProgramTest {
protected:
  std::vector<double> series(const std::string& run, const std::string& path) const {
    return support::Hdf5File::open(folder_ / run / "results.h5").read<double>("/" + path + "/value");
  }
};

TEST_F(MechanismRun, WritesPosesReactionsDrivesAndLedger) {
  const Outcome o =
      call("run " + kMechanisms + "slider_crank.toml --out r --verbose --set run.duration=0.1" + kNoPictures);
  ASSERT_EQ(o.code, 0) << o.errors;
  EXPECT_NE(o.out.find("ledger"), std::string::npos);
  for (const char* path :
       {"bodies/piston/position", "bodies/piston/orientation", "bodies/crank/velocity", "bodies/crank/spin",
        "joints/crank pin/force", "joints/main bearing/torque", "joints/main bearing/position",
        "joints/cylinder/slide_position", "drives/motor/torque", "drives/motor/power", "ledger/residual",
        "momentum/linear", "constraints/position_error", "constraints/velocity_error"})
    EXPECT_NO_THROW(series("r", path)) << path;
  // The crank turns at 50 rad/s, so the motor's power is 50 times its torque.
  const std::vector<double> torque = series("r", "drives/motor/torque"), power = series("r", "drives/motor/power");
  for (std::size_t i = 1; i < torque.size(); ++i)
    EXPECT_NEAR(power[i], 50 * torque[i], 1e-9 * std::fabs(power[i]) + 1e-12); // the rate is exact to round-off
  // Closed form of the piston; second order at 1e-4 s, where a step turns the crank (0.1 m) by 5 mrad: 1e-6 m.
  const std::vector<double> place = series("r", "bodies/piston/position");
  const double t = 0.1, s = std::sin(50 * t);
  EXPECT_NEAR(place[place.size() - 3], 0.1 * std::cos(50 * t) + std::sqrt(0.09 - 0.01 * s * s), 1e-6);
  EXPECT_EQ(contents(folder_ / "r" / "timeseries.csv").rfind("step,time [s],bodies.crank.position.x [m]", 0), 0u);
  EXPECT_TRUE(fs::exists(folder_ / "r" / "frames.xdmf"));
}

TEST_F(MechanismRun, ForcesBeforeTheFirstStepAreMissingNotZero) {
  const Outcome o = call("run " + kMechanisms + "slider_crank.toml --out r --set run.duration=0.02" + kNoPictures);
  ASSERT_EQ(o.code, 0) << o.errors;
  for (const char* path : {"joints/crank pin/force", "joints/crank pin/torque", "joints/cylinder/slide_force_along",
                           "drives/motor/torque", "drives/motor/power"}) {
    const std::vector<double> values = series("r", path);
    EXPECT_TRUE(std::isnan(values.front())) << path;
    EXPECT_TRUE(std::isfinite(values.back())) << path;
  }
  EXPECT_TRUE(std::isfinite(series("r", "joints/main bearing/position").front()));
}

TEST_F(MechanismRun, ResumedRunHasTheBitsOfOneStraightThrough) {
  // A checkpoint between two rows: 0.0125 s, rows every 0.005 s.
  const std::string scene = kMechanisms + "slider_crank.toml" + kNoPictures +
                            " --set run.checkpoint_interval=0 --set run.output_interval=0.005 --hash";
  const Outcome straight = call("run " + scene + " --out straight --set run.duration=0.05");
  ASSERT_EQ(straight.code, 0) << straight.errors;
  ASSERT_EQ(call("run " + scene + " --out parts --set run.duration=0.0125").code, 0);
  const Outcome resumed = call("run " + scene + " --out parts --set run.duration=0.05 --resume");
  ASSERT_EQ(resumed.code, 0) << resumed.errors;
  EXPECT_TRUE(straight.hasHash()) << straight.out;
  EXPECT_EQ(resumed.hash(), straight.hash());
  EXPECT_EQ(contents(folder_ / "parts" / "timeseries.csv"), contents(folder_ / "straight" / "timeseries.csv"));
  EXPECT_EQ(call("hash parts/checkpoint.h5").hash(), straight.hash());
}

TEST_F(MechanismRun, HashDependsOnTheScene) {
  const std::string scene = "run " + kMechanisms + "pendulum.toml --steps 100 --hash --force --out r" + kNoPictures;
  const Outcome first = call(scene), weaker = call(scene + " --set run.gravity=[0,-9.8,0]");
  EXPECT_EQ(call(scene).hash(), first.hash());
  EXPECT_TRUE(call(scene + " --set body.0.mass=2").hasHash());
  EXPECT_TRUE(weaker.hasHash()) << weaker.errors;
  EXPECT_NE(weaker.hash(), first.hash());
}

TEST_F(MechanismRun, PlanNamesFreedomsAndRedundantRows) {
  const Outcome o = call("plan " + kMechanisms + "door.toml");
  EXPECT_EQ(o.code, 0) << o.errors;
  EXPECT_NE(o.out.find("RATTLE, order 2"), std::string::npos) << o.out;
  EXPECT_NE(o.out.find("degrees of freedom       1"), std::string::npos) << o.out;
  EXPECT_NE(o.out.find("redundant constraints    5"), std::string::npos) << o.out;
}

TEST_F(MechanismRun, AutomaticStepIsAHundredthOfASwing) {
  // sqrt(200 / 0.5) = 20 rad/s: a period of 0.314 s allows 3 ms, but steps are at most 1 ms; with 1e4 times the
  // stiffness the limit is 31.4 us, and a row of 0.01 s has 319 such steps, rounded up.
  const std::string scene = "plan " + kMechanisms + "spring_torsion.toml --set run.time_step=auto";
  EXPECT_NE(call(scene).out.find("time step                0.001 s"), std::string::npos) << call(scene).out;
  const Outcome stiff = call(scene + " --set spring.0.stiffness=2e6");
  EXPECT_NE(stiff.out.find("time step                3.135e-05 s"), std::string::npos) << stiff.out;
}

constexpr double kLean = 9.81e-3; ///< a thousandth of gravity

TEST_F(MechanismRun, AutomaticStepBearsWhatHangsOnTheJoints) {
  // 2 / omega of the fastest mode in closed form, as in `study multibody --stability`; a twentieth of the period is
  // pi / 10 of that, reduced to an integer fraction of rows of 0.01 s. Light chains keep 1 ms.
  for (const auto& [weight, stable] : {std::pair{1.0, 0.02801}, {1e2, 0.00744}, {1e4, 7.627e-4}, {1e6, 7.629e-5}}) {
    std::ofstream(folder_ / "chain.toml") << chainScene(weight, kLean);
    const Outcome o = call("run chain.toml --force --out r --set run.integrator=symplectic_euler" + kNoPictures);
    ASSERT_EQ(o.code, 0) << weight << ": " << o.errors;
    const double step =
        0.2 / static_cast<double>(
                  support::Hdf5File::open(folder_ / "r" / "results.h5").read<std::int64_t>("/series/step").back());
    EXPECT_LE(step, std::min(1e-3, base::kPi / 10 / 2 * stable * 1.01)) << weight;
    EXPECT_GE(step, std::min(1e-3, base::kPi / 10 / 2 * stable * 0.98)) << weight;
  }
}

TEST_F(MechanismRun, StepThatTautJointsCannotBearIsNamedWithTheLongestThatTheyCan) {
  std::ofstream(folder_ / "chain.toml") << chainScene(1e6, kLean);
  const Outcome o = call("run chain.toml --out r --set run.time_step=2e-4" + kNoPictures);
  EXPECT_EQ(o.code, 3) << o.errors;
  EXPECT_NE(o.errors.find("at 0.0002 s the load on joint 'pin 5' limits stable steps to 7.6e-05 s"), std::string::npos)
      << o.errors;
}

TEST_F(MechanismRun, PullThatGrowsSlowlyBeyondWhatAStepBearsIsNamedToo) {
  // A winch on a rail pulls the chain's end at 1e6 N/s. A run ends a few periods after the step limit.
  std::ofstream(folder_ / "winch.toml") << chainScene(1, kLean) << winch("polynomial = [0, -1e6]");
  for (const auto& [step, limit] : {std::pair{"5e-4", 0.0005}, {"2.5e-4", 0.00025}}) {
    const Outcome o = call(
        "run winch.toml --force --out r --set run.duration=2 --set run.time_step=" + std::string(step) + kNoPictures);
    EXPECT_EQ(o.code, 3) << step;
    std::smatch named;
    ASSERT_TRUE(std::regex_search(o.errors, named, std::regex("limits stable steps to ([0-9.e-]+) s"))) << o.errors;
    // The pull is checked after each growth by a twentieth, and the step depends on its root; two digits. A
    // peak of the links' own oscillation may exceed the limit first.
    EXPECT_LE(std::stod(named[1]), limit * 1.01) << step;
    EXPECT_GE(std::stod(named[1]), limit * 0.8) << step;
  }
}

TEST_F(MechanismRun, StepAboveWhatTautJointsBearAtTheStartIsWarnedOf) {
  // Straight and at rest, the chain would hang still at any step until the first disturbance.
  std::ofstream(folder_ / "chain.toml") << chainScene(1e6, kLean);
  const std::string still = " chain.toml --set run.gravity=[0,0,-9.81] --set run.time_step=",
                    warning = "the initial load on joint 'pin 5' limits stable steps to 7.6e-05 s";
  const Outcome plan = call("plan" + still + "2e-4"),
                run = call("run" + still + "2e-4 --steps 10 --out r" + kNoPictures);
  EXPECT_EQ(plan.code, 0) << plan.errors;
  EXPECT_NE(plan.out.find("WARNING: chain.toml: run.time_step = 0.0002 s: " + warning), std::string::npos) << plan.out;
  EXPECT_EQ(run.code, 0) << run.errors;
  EXPECT_NE(run.errors.find(warning), std::string::npos) << run.errors;
  for (const char* step : {"7e-5", "auto"}) {
    EXPECT_EQ(call("plan" + still + step).out.find("warning"), std::string::npos) << step;
    const Outcome quiet = call("run" + still + step + " --steps 10 --force --out r" + kNoPictures);
    EXPECT_EQ(quiet.code, 0) << quiet.errors;
    EXPECT_EQ(quiet.errors.find("warning"), std::string::npos) << quiet.errors;
  }
}

TEST_F(MechanismRun, NoShippedMechanismIsWarnedOf) {
  int scenes = 0;
  for (const fs::directory_entry& entry : fs::directory_iterator(kMechanisms)) {
    if (entry.path().extension() != ".toml") continue;
    const Outcome o = call("plan --no-probe " + entry.path().string());
    EXPECT_EQ(o.code, 0) << o.errors;
    EXPECT_EQ(o.out.find("warning"), std::string::npos) << o.out;
    ++scenes;
  }
  EXPECT_GE(scenes, 20);
}

TEST_F(MechanismRun, SweepRunsOverAKeyOfABody) {
  const Outcome o = call("sweep " + kMechanisms + "pendulum.toml --set body.0.mass=1,2 --out s" +
                         " --set run.duration=0.1 --set output.plots=false --set output.picture=false");
  EXPECT_EQ(o.code, 0) << o.errors;
  const std::string summary = contents(folder_ / "s" / "summary.csv"), header = summary.substr(0, summary.find('\n'));
  EXPECT_NE(header.find("integration error [J]"), std::string::npos) << header;
  for (const char* ofVehicles : {"teeth", "slip", "sinkage", "impulse"})
    EXPECT_EQ(header.find(ofVehicles), std::string::npos) << header;
}

TEST_F(MechanismRun, RecordKeepsOnlyWhatItNames) {
  const Outcome o = call("run " + kMechanisms +
                         "slider_crank.toml --out r --steps 10 --set 'output.record=[\"piston\"]'" + kNoPictures);
  ASSERT_EQ(o.code, 0) << o.errors;
  EXPECT_NO_THROW(series("r", "bodies/piston/position"));
  EXPECT_ANY_THROW(series("r", "bodies/crank/position"));
  const Outcome wrong =
      call("run " + kMechanisms + "slider_crank.toml --out w --steps 10 --set 'output.record=[\"pistn\"]'");
  EXPECT_EQ(wrong.code, 2);
  EXPECT_NE(wrong.errors.find("did you mean \"piston\"?"), std::string::npos) << wrong.errors;
}

TEST_F(MechanismRun, TooLongAStepForAnExplicitSpringIsRefusedWithItsLimit) {
  const Outcome o = call("run " + kMechanisms +
                         "joint_prismatic.toml --out r --set run.springs=explicit --set run.time_step=0.05 --set "
                         "run.output_interval=0.1 --set spring.0.stiffness=1e6" +
                         kNoPictures);
  EXPECT_EQ(o.code, 2) << o.errors;
  EXPECT_NE(o.errors.find("spring"), std::string::npos) << o.errors;
}

TEST_F(MechanismRun, StudyWritesTablesAndNamesTheNearestCase) {
  const Outcome o = call("study multibody --quick --cases pendulum,torsion --out s");
  ASSERT_EQ(o.code, 0) << o.errors;
  EXPECT_NE(o.out.find("cheapest integrator and step for a given precision"), std::string::npos);
  EXPECT_EQ(contents(folder_ / "s" / "multibody.csv").rfind("case,integrator,step [s],steps,error [-]", 0), 0u);
  EXPECT_NE(contents(folder_ / "s" / "cheapest.csv").find("torsion,0.1,"), std::string::npos);
  const Outcome wrong = call("study multibody --cases pendulm --out w");
  EXPECT_EQ(wrong.code, 2);
  EXPECT_NE(wrong.errors.find("did you mean pendulum?"), std::string::npos) << wrong.errors;
  EXPECT_EQ(call("study multibody --help").code, 0);
}

TEST_F(MechanismRun, PlotIsDrawn) {
  const Outcome o =
      call("run " + kMechanisms + "pendulum.toml --out r --set run.duration=1 --set output.picture=false");
  ASSERT_EQ(o.code, 0) << o.errors;
  if (o.errors.find("no plots") != std::string::npos) GTEST_SKIP() << o.errors;
  EXPECT_GT(fs::file_size(folder_ / "r" / "mechanism.png"), 10000u);
}

} // namespace
} // namespace grouser::commands
