// SPDX-License-Identifier: BSD-3-Clause
// A mechanism that becomes too fast for its step ends with the true cause, at a step that depends on the
// motion only.
#include "tests/runs/commands/chain_fixture.hpp"
#include "tests/runs/program_fixture.hpp"
#include "tests/runs/scene_fixture.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <regex>
#include <string>

namespace grouser::commands {

using namespace test; // fixtures

namespace {

const std::string kBare = " --set output.plots=false --set output.picture=false";

class MechanismJudge : public ProgramTest {
protected:
  void write(const std::string& name, const std::string& text) const { std::ofstream(folder_ / name) << text; }
};

/// 10 N m on 0.1 kg m2: 100 rad/s2.
const std::string kRotor = R"(version = 1
[run]
duration = 4
output_interval = 0.1
time_step = 1e-3
gravity = [0, 0, 0]
checkpoint_interval = 0
[[body]]
name = "rotor"
mass = 1
inertia = [0.1, 0.1, 0.1]
[[joint]]
name = "axle"
bodies = ["world", "rotor"]
point = [0, 0, 0]
axis = [0, 0, 1]
[[drive]]
name = "motor"
joint = "axle"
imposes = "torque"
value = 10
)";

TEST_F(MechanismJudge, RotorThatIsSpunUpEndsTheRunWhereATurnHasTooFewSteps) {
  write("rotor.toml", kRotor);
  // Each step adds 1e-4 rad per step: 2 pi / 20 = 0.31416 is exceeded in step 3142, and checked in step 3150.
  const std::string expected = "step 3150, time 3.15 s: body \"rotor\" rotates by 0.315 rad a step (spun up from 0 rad "
                               "a step at the start), more than 0.3142 rad (run.steps_per_period = 20 steps a turn)";
  for (const char* interval : {"0.1", "0.013", "3.9"}) {
    const Outcome o = call("run rotor.toml --force --out r --set run.output_interval=" + std::string(interval) + kBare);
    EXPECT_EQ(o.code, 3) << interval;
    EXPECT_NE(o.errors.find(expected), std::string::npos) << interval << ": " << o.errors;
  }
  ASSERT_EQ(call("run rotor.toml --out parts --set run.duration=3.123" + kBare).code, 0);
  const Outcome resumed = call("run rotor.toml --out parts --set run.duration=4 --resume" + kBare);
  EXPECT_EQ(resumed.code, 3);
  EXPECT_NE(resumed.errors.find(expected), std::string::npos) << resumed.errors;
  EXPECT_EQ(call("run rotor.toml --force --out r --set run.steps_per_period=15" + kBare).code, 0);
}

TEST_F(MechanismJudge, PullThatStaysAboveWhatTheStepBearsEndsTheRunEvenWhereNothingSwingsYet) {
  // Straight and at rest the chain hangs still, at 2.6 times the longest stable step of 7.6e-5 s.
  write("chain.toml", chainScene(1e6));
  for (const char* interval : {"0.01", "0.003"}) {
    const Outcome o = call("run chain.toml --force --out r --set run.time_step=2e-4 --set run.output_interval=" +
                           std::string(interval) + kBare);
    EXPECT_EQ(o.code, 3) << o.errors;
    EXPECT_NE(
        o.errors.find("step 100, time 0.02 s: transverse oscillations of tensioned joints may have grown 1e+06 times"),
        std::string::npos)
        << o.errors;
    EXPECT_NE(o.errors.find("the load on joint 'pin 5' limits stable steps to 7.6e-05 s"), std::string::npos)
        << o.errors;
  }
  EXPECT_EQ(call("run chain.toml --force --out r --set run.time_step=7e-5" + kBare).code, 0);
}

TEST_F(MechanismJudge, PullThatPassesSoonIsNoError) {
  // 5e-4 s are stable up to some 2.3e5 N; a peak of 2.6e5 N exceeds that for three steps.
  write("pulse.toml", chainScene(1) + winch("time = [0, 0.05, 0.06, 0.07]\nvalues = [0, 0, -2.6e5, 0]"));
  const Outcome o = call("run pulse.toml --out r --set run.time_step=5e-4" + kBare);
  EXPECT_EQ(o.code, 0) << o.errors;
  // The same force permanently.
  write("pull.toml", chainScene(1) + winch("time = [0, 0.05, 0.06, 0.07]\nvalues = [0, 0, -2.6e5, -2.6e5]"));
  const Outcome stays = call("run pull.toml --out s --set run.time_step=5e-4" + kBare);
  EXPECT_EQ(stays.code, 3) << stays.errors;
  EXPECT_NE(stays.errors.find("limits stable steps to 0.00049 s"), std::string::npos) << stays.errors;
}

TEST_F(MechanismJudge, PlanAndRunNameTheSpringThatAsksForMillionsOfSteps) {
  write("bead.toml", "version = 1\n[run]\nduration = 10\noutput_interval = 0.1\n[[body]]\nname = \"bead\"\nmass = "
                     "1e-3\npoint = true\n[[spring]]\nname = \"rod\"\nbodies = [\"world\", \"bead\"]\npoint_a = "
                     "[0, 0, 1]\nstiffness = 1e9\n");
  const std::string note = "note: bead.toml: run.time_step = \"auto\" is 6.283e-08 s (the run takes 1.59e+08 steps), "
                           "because spring 'rod' has a period of 6.28e-06 s";
  EXPECT_NE(call("plan bead.toml").out.find(note), std::string::npos) << call("plan bead.toml").out;
  const Outcome run = call("run bead.toml --steps 10 --out r" + kBare);
  EXPECT_EQ(run.code, 0) << run.errors;
  EXPECT_NE(run.errors.find(note), std::string::npos) << run.errors;
}

/// A door driven by wind against a damped stop.
std::string doorUnder(const std::string& tolerance) {
  return std::string("run ") + GROUSER_SOURCE_DIR + "/runs/mechanisms/door.toml --set run.time_step=auto --set " +
         "run.tolerance=" + tolerance +
         " --set joint.0.limits=[-0.1,0.5] --set run.checkpoint_interval=0 --set run.output_interval=0.05" + kBare +
         " --hash --verbose";
}

TEST_F(MechanismJudge, StepsThatFollowAnErrorAreTheSameResumedAndAreCounted) {
  const Outcome straight = call(doorUnder("1e-5") + " --out straight --set run.duration=2");
  ASSERT_EQ(straight.code, 0) << straight.errors;
  // Rows, hash and counts at the end: a stop between two rows, at 1.15 s.
  ASSERT_EQ(call(doorUnder("1e-5") + " --out parts --set run.duration=1.15").code, 0);
  const Outcome resumed = call(doorUnder("1e-5") + " --out parts --set run.duration=2 --resume");
  ASSERT_EQ(resumed.code, 0) << resumed.errors;
  EXPECT_TRUE(straight.hasHash()) << straight.out;
  EXPECT_EQ(resumed.hash(), straight.hash());
  EXPECT_EQ(contents(folder_ / "parts" / "timeseries.csv"), contents(folder_ / "straight" / "timeseries.csv"));
  const auto steps = [](const Outcome& o) {
    std::smatch line;
    return std::regex_search(o.out, line, std::regex("steps     mechanism: [0-9]+ steps of [^\n]*")) ? line.str()
                                                                                                     : o.out;
  };
  EXPECT_EQ(steps(resumed), steps(straight));
  const std::string manifest = contents(folder_ / "straight" / "manifest.json");
  for (const char* figure :
       {"mechanism_steps", "mechanism_stretches_rejected", "mechanism_step_smallest_s", "mechanism_step_largest_s"})
    EXPECT_NE(manifest.find(figure), std::string::npos) << figure;
  const Outcome coarse = call(doorUnder("1e-4") + " --out coarse --set run.duration=2");
  EXPECT_NE(coarse.hash(), straight.hash());
}

TEST_F(MechanismJudge, ToleranceIsRefusedWhereItHasNoMeaning) {
  const auto refused = [&](const std::string& sets, const std::string& message) {
    const std::string automatic = "--set run.time_step=auto";
    const bool isOfStep = sets.find("run.time_step") != std::string::npos;
    const Outcome o =
        call(replaced(doorUnder("1e-5"), automatic, isOfStep ? "" : automatic) + " --out r --force " + sets);
    EXPECT_EQ(o.code, 2) << sets;
    EXPECT_NE(o.errors.find(message), std::string::npos) << o.errors;
  };
  refused("--set run.time_step=1e-3", "run.tolerance = 1e-05 [m/s or rad/s] is mutually exclusive with time_step");
  refused("--set run.integrator=symplectic_euler", "requires integrator = \"rattle\" with integrator_order = 2");
  refused("--set run.integrator_order=4", "requires integrator = \"rattle\" with integrator_order = 2");
  refused("--set run.springs=explicit", "requires springs = \"implicit\"");
  write("grain.toml", "version = 1\n[run]\nduration = 1\ntolerance = 1e-5\n[material.a]\n[[grain]]\nposition = [0, 0, "
                      "1]\nradius = 0.01\nmaterial = \"a\"\n");
  const Outcome grain = call("run grain.toml --out g");
  EXPECT_EQ(grain.code, 2);
  EXPECT_NE(grain.errors.find("grain.toml:4: run.tolerance = 1e-05 [m/s or rad/s] applies to mechanisms only"),
            std::string::npos)
      << grain.errors;
}

} // namespace
} // namespace grouser::commands
