// SPDX-License-Identifier: BSD-3-Clause
// Prescribed motion is resolved by enough steps, or causes an error with the required number.
#include "runs/setup/load_scene.hpp"
#include "runs/setup/mechanism_model.hpp"
#include "runs/setup/mechanism_setup.hpp"
#include "runs/setup/step_limit.hpp"
#include "runs/setup/time_scales.hpp"

#include "runs/scene/scene.hpp"
#include "tests/vehicle/spec_variant.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fmt/format.h>
#include <regex>
#include <string>

namespace grouser::setup {
namespace {

std::string errorOf(const std::string& text, const std::vector<std::string>& overrides = {}) {
  try {
    chooseTimeStep(parseScene(text, "scene.toml", overrides));
  } catch (const base::InputError& error) {
    return error.what();
  }
  return "no error";
}

double stepOf(const std::string& text, const std::vector<std::string>& overrides = {}) {
  return chooseTimeStep(parseScene(text, "scene.toml", overrides));
}

/// The step suggested by an error message.
double stepAskedFor(const std::string& error) {
  std::smatch number;
  return std::regex_search(error, number, std::regex("set run.time_step to ([0-9.e-]+) s or less"))
             ? std::stod(number[1])
             : 0;
}

/// A rotor on an axle; `drive` completes it.
std::string rotor(const std::string& drive) {
  return "version = 1\n[run]\nduration = 2\noutput_interval = 0.1\ngravity = [0, 0, 0]\n[[body]]\nname = \"rotor\"\n"
         "mass = 1\ninertia = [0.1, 0.1, 0.1]\n[[joint]]\nname = \"axle\"\nbodies = [\"world\", \"rotor\"]\n"
         "point = [0, 0, 0]\naxis = [0, 0, 1]\n[[drive]]\nname = \"motor\"\njoint = \"axle\"\nimposes = \"torque\"\n" +
         drive;
}

/// A grain with contacts of milliseconds, beside `surface`.
std::string grainBeside(const std::string& surface) {
  return "version = 1\n[run]\nduration = 2\noutput_interval = 0.1\ngravity = [0, 0, 0]\n[material.soil]\nstiffness = "
         "1e4\n[[grain]]\nradius = 0.1\nposition = [0, 0, 1]\nmaterial = \"soil\"\n" +
         surface;
}

const std::string kPlane = "[[plane]]\nmaterial = \"soil\"\n";
const std::string kBox = "[[box]]\nname = \"lid\"\nmaterial = \"soil\"\nposition = [5, 0, 0]\nsize = [0.1, 0.1, 0.1]\n";

TEST(TimeScales, SineDriveBelowTwentyStepsAPeriodIsRefusedWithPlaceNumberAndRemedy) {
  const std::string scene = rotor("amplitude = 100\nfrequency = 1001\n");
  const std::string error = errorOf(scene, {"run.time_step=9.99000999e-4"});
  EXPECT_EQ(error.rfind("scene.toml:20: drive.0.frequency = 1001 [Hz] is under-resolved: a period of 0.000999 s spans "
                        "1 of the required 20 time steps of 0.000999 s (run.steps_per_period)",
                        0),
            0u)
      << error;
  // 1 / 1001 / 20 s; the suggested step is accepted, one 1 % longer is not.
  EXPECT_NEAR(stepAskedFor(error), 4.995e-5, 1e-9);
  EXPECT_EQ(errorOf(scene, {fmt::format("run.time_step={}", stepAskedFor(error))}), "no error");
  EXPECT_NE(errorOf(scene, {fmt::format("run.time_step={}", 1.01 * stepAskedFor(error))}), "no error");
}

TEST(TimeScales, SineThatBeginsDownwardsIsNoSlower) {
  EXPECT_NE(errorOf(rotor("amplitude = -100\nfrequency = 1001\n"), {"run.time_step=9.99000999e-4"})
                .find("drive.0.frequency = 1001 [Hz] is under-resolved"),
            std::string::npos);
}

TEST(TimeScales, FewerStepsAreTakenWhereTheSceneSaysSoAndMoreWhereItWantsThem) {
  const std::string scene = rotor("amplitude = 100\nfrequency = 10\n");
  EXPECT_NE(errorOf(scene, {"run.time_step=0.02"}), "no error") << "5 steps per period";
  EXPECT_EQ(errorOf(scene, {"run.time_step=0.02", "run.steps_per_period=5"}), "no error");
  EXPECT_NE(errorOf(scene, {"run.time_step=0.002", "run.steps_per_period=51"}), "no error") << "50 steps per period";
  EXPECT_EQ(errorOf(scene, {"run.time_step=0.002", "run.steps_per_period=50"}), "no error");
  EXPECT_NE(errorOf(scene, {"run.steps_per_period=1.9"}).find("outside [2, "), std::string::npos);
}

TEST(TimeScales, AutomaticStepResolvesSinesAndTables) {
  // A hundredth of a period of 1 ms; a twentieth of a gap of 1 ms; each an integer fraction of a row of 0.1 s.
  EXPECT_NEAR(stepOf(rotor("amplitude = 1\nfrequency = 1000\n")), 1e-5, 1e-12);
  EXPECT_NEAR(stepOf(rotor("time = [0, 1, 1.001]\nvalues = [0, 1, 0]\n")), 5e-5, 1e-7); // 1.001 - 1
  EXPECT_NEAR(stepOf(rotor("amplitude = 1\nfrequency = 1000\n"), {"run.steps_per_period=200"}), 5e-6, 1e-12);
  EXPECT_NEAR(stepOf(grainBeside(kPlane + "amplitude = [0, 0, 1e-6]\nfrequency = 1e4\n")), 5e-6, 1e-12);
  EXPECT_NEAR(stepOf(grainBeside(kBox + "spin = [0, 6283.185307179586, 0]\n")), 5e-5, 1e-9);
  EXPECT_NEAR(stepOf(grainBeside(kBox + "free = \"z\"\nmass = 1e3\nload = 1\nload_ramp = 1e-3\n")), 5e-5, 1e-12);
}

TEST(TimeScales, SmallestGapOfATableCountsThatBeginsBeforeTheEnd) {
  const std::string table = rotor("time = [0, 0.5, 0.504, 5, 5.00001]\nvalues = [0, 1, 0, 0, 0]\n");
  EXPECT_EQ(errorOf(table, {"run.time_step=2e-4"}), "no error");
  const std::string error = errorOf(table, {"run.time_step=1e-3"});
  EXPECT_NE(error.find("drive.0.time = a list of 5 entries [s] is under-resolved: the interval of 0.004 s from 0.5 to "
                       "0.504 s spans 4 of the required 20 time steps of 0.001 s"),
            std::string::npos)
      << error;
  EXPECT_NEAR(stepAskedFor(error), 2e-4, 1e-9);
}

TEST(TimeScales, TimeGivenTwiceIsAJumpThatNeedsNoSteps) {
  const std::string jump = rotor("time = [0, 1, 1, 2]\nvalues = [0, 1, 5, 7]\n");
  EXPECT_EQ(errorOf(jump, {"run.time_step=0.01"}), "no error");
  const multibody::TimeLaw law = buildModel(parseScene(jump, "scene.toml").mechanism).drives()[0].law;
  EXPECT_DOUBLE_EQ(law.value(0.5), 0.5);
  EXPECT_DOUBLE_EQ(law.value(1), 1) << "the first of the two";
  EXPECT_DOUBLE_EQ(law.value(std::nextafter(1.0, 2.0)), 5);
  EXPECT_DOUBLE_EQ(law.integral(2), 0.5 + 6);
  EXPECT_NE(errorOf(rotor("time = [0, 1, 1, 1]\nvalues = [0, 1, 5, 7]\n")).find("does not at entry 3"),
            std::string::npos);
  std::string position = rotor("time = [0, 1, 1, 2]\nvalues = [0, 1, 5, 7]\n");
  position.replace(position.find("\"torque\""), 8, "\"position\"");
  EXPECT_NE(errorOf(position).find("must increase, but does not at entry 2; sort the list (a position cannot jump)"),
            std::string::npos)
      << errorOf(position);
}

TEST(TimeScales, MovingSurfacesAreJudgedByPeriodAndTurnUnlessTheyAreRound) {
  const auto refused = [](const std::string& surface, const std::string& message) {
    const std::string error = errorOf(grainBeside(surface), {"run.time_step=1e-3"});
    EXPECT_NE(error.find(message), std::string::npos) << error;
  };
  refused(kPlane + "amplitude = [0, 0, 1e-6]\nfrequency = 100\n",
          "plane.0.frequency = 100 [Hz] is under-resolved: a period of 0.01 s spans 10 of the required 20 time steps "
          "of 0.001 s");
  refused(kBox + "spin = [0, 0, 628.3185307179586]\n",
          "box.0.spin = [0, 0, 628.3185307179587] [rad/s] is "
          "under-resolved: a turn of 0.01 s spans 10 of the required 20 time steps of 0.001 s");
  refused(kBox + "free = \"z\"\nmass = 1e3\nload = 1\nload_ramp = 0.01\n",
          "box.0.load_ramp = 0.01 [s] is under-resolved: the ramp of 0.01 s spans 10 of the required 20 time steps of "
          "0.001 s");
  const std::string rod = "[[cylinder]]\nmaterial = \"soil\"\nposition = [5, 0, 0]\nradius = 0.1\nlength = 1\n"
                          "axis = [0, 1, 0]\nspin = ";
  refused(rod + "[600, 0, 0]\n", "cylinder.0.spin");
  refused(rod + "[0, 600, 0]\npivot = [5.001, 0, 0]\n", "cylinder.0.spin");
  // A rod rotating about its own axis, a belt, a motion that starts after the end.
  for (const std::string& same :
       {rod + "[0, 600, 0]\n", rod + "[0, 600, 0]\npivot = [5, 3, 0]\n", kPlane + "spin = [0, 0, 600]\n",
        kPlane + "amplitude = [0, 0, 1e-6]\nfrequency = 100\nstart = 3\n"})
    EXPECT_EQ(errorOf(grainBeside(same), {"run.time_step=1e-3"}), "no error") << same;
}

TEST(TimeScales, DriversTableAndRampsAreJudged) {
  const auto vehicle = [](const std::string& driver) {
    return "version = 1\n[run]\nduration = 3\ntime_step = 1e-4\n[material.soil]\n[terrain]\nmaterial = "
           "\"soil\"\nheightmap = \"heightmaps/hills.png\"\nsize = "
           "[6, 4]\nheight_range = [0, 0.3]\nkind = \"rigid\"\n[vehicle]\nspec = \"vehicles/light_tracked.toml\"\n" +
           driver;
  };
  const std::string table = "[driver.table]\nleft = [0, 1, 1, 1]\nright = [0, 1, 1, 1]\ntime = ";
  EXPECT_NE(errorOf(vehicle(table + "[0, 1, 1.0015, 2]\n"))
                .find("driver.table.time = [0, 1, 1.0015, 2] [s] is under-resolved: the interval of 0.0015 s from 1 to "
                      "1.0015 s spans 15 of the required 20 time steps of 0.0001 s"),
            std::string::npos)
      << errorOf(vehicle(table + "[0, 1, 1.0015, 2]\n"));
  EXPECT_EQ(errorOf(vehicle(table + "[0, 1, 1, 2]\n")), "no error");
  EXPECT_EQ(errorOf(vehicle(table + "[0, 1, 1.002, 2]\n")), "no error");
  EXPECT_NE(errorOf(vehicle("[driver]\nsprocket_speed = 1\ndrive_ramp = 1e-3\n")).find("driver.drive_ramp = 0.001 [s]"),
            std::string::npos);
  EXPECT_EQ(errorOf(vehicle("[driver]\nsprocket_speed = 1\ndrive_ramp = 0\n")), "no error");
}

TEST(TimeScales, BodyThatTurnsTooFarInAStepAtTheStartIsRefused) {
  const std::string top =
      "version = 1\n[run]\nduration = 2\noutput_interval = 0.1\ngravity = [0, 0, 0]\n[[body]]\nname "
      "= \"top\"\nmass = 1\ninertia = [1, 1, 1.5]\nspin = [0, 30, 40]\n";
  const std::string error = errorOf(top, {"run.time_step=0.015"});
  EXPECT_EQ(
      error.rfind("--set: run.time_step = 0.015 [s] is too long for body \"top\", which initially rotates by 0.75 rad "
                  "per step, more than 0.3142 rad (run.steps_per_period = 20 steps per turn); set 0.006283 s or less",
                  0),
      0u)
      << error;
  EXPECT_EQ(errorOf(top, {"run.time_step=0.006283"}), "no error");
  EXPECT_EQ(errorOf(top, {"run.time_step=0.015", "run.steps_per_period=8"}), "no error");
}

/// A light body on a stiff spring beside a heavy one.
std::string stiffSpring() {
  return "version = 1\n[run]\nduration = 10\noutput_interval = 0.1\n[[body]]\nname = \"bead\"\nmass = 1e-3\npoint = "
         "true\n[[spring]]\nname = \"rod\"\nbodies = [\"world\", \"bead\"]\npoint_a = [0, 0, 1]\nstiffness = 1e9\n";
}

TEST(TimeScales, SpringThatNeedsMillionsOfStepsIsNamedWithTheWayOut) {
  // omega = 1e6 rad/s: a hundredth of a period is 63 ns.
  const auto note = [](const std::vector<std::string>& more) {
    return springStepNote(parseScene(stiffSpring(), "scene.toml", more));
  };
  EXPECT_NE(
      note({}).find(
          "run.time_step = \"auto\" is 6.283e-08 s (the run takes 1.59e+08 steps), because spring 'rod' has a period "
          "of 6.28e-06 s; run.springs = \"implicit\" is stable at any step size: run.time_step = 0.001 resolves"),
      std::string::npos)
      << note({});
  EXPECT_NE(note({"run.springs=explicit"}).find("run.springs = \"implicit\" allows run.time_step = 0.001"),
            std::string::npos);
  EXPECT_NE(note({"run.integrator=symplectic_euler"}).find("integrates springs implicitly: run.time_step = 0.001"),
            std::string::npos);
  EXPECT_EQ(note({"spring.0.stiffness=1e3"}), "");
}

TEST(TimeScales, StepThatDoesNotResolveASpringIsSaidAndNotRefused) {
  // 6.28 us per period.
  const auto note = [](const std::vector<std::string>& more) {
    const scene::Scene scene = parseScene(stiffSpring(), "scene.toml", more);
    chooseTimeStep(scene);
    return springStepNote(scene);
  };
  EXPECT_NE(note({"run.time_step=1e-3"})
                .find("spring 'rod' has a period of 6.28e-06 s, i.e. 0.00628 steps of run.time_step = 0.001 s; "
                      "implicit springs are stable but oscillate too slowly; to resolve the oscillation, set the step "
                      "to 3.141e-07 s or less"),
            std::string::npos)
      << note({"run.time_step=1e-3"});
  EXPECT_NE(note({"run.time_step=1e-3", "run.integrator=symplectic_euler"}).find("stable but damps the oscillation"),
            std::string::npos);
  EXPECT_NE(note({"run.time_step=1e-6", "run.springs=explicit"}).find("oscillate too fast"), std::string::npos);
  EXPECT_EQ(note({"run.time_step=3.14e-7"}), "");
  EXPECT_NE(
      errorOf(stiffSpring(), {"run.time_step=3e-6", "run.springs=explicit"})
          .find("beyond the stability limit 2e-06 s of explicit springs, set by spring 'rod'; take a shorter step, "
                "a softer spring, or run.springs = \"implicit\""),
      std::string::npos);
}

/// A slider of 4 kg on a rail; `more`: keys of the joint.
std::string slider(const std::string& more) {
  return "version = 1\n[run]\nduration = 1\noutput_interval = 0.1\n[[body]]\nname = \"slider\"\nmass = 4\n"
         "inertia = [1, 1, 1]\n[[joint]]\nname = \"rail\"\ntype = \"prismatic\"\nbodies = [\"world\", "
         "\"slider\"]\npoint = [0, 0, 0]\naxis = [0, 0, 1]\n" +
         more;
}

TEST(TimeScales, StepsThatPassThroughABounceAreRefusedWithTheNumber) {
  // Half a period at sqrt(4e8 / 4) = 1e4 rad/s: 314 us; a tenth of that.
  const std::string scene = slider("limits = [-1, 1]\nstop_stiffness = 4e8\n");
  const std::string error = errorOf(scene, {"run.time_step=1e-3"});
  EXPECT_EQ(error.rfind("--set: run.time_step = 0.001 [s] is too long for the end stops of ", 0), 0u) << error;
  EXPECT_NE(error.find("spring 'rail stops'"), std::string::npos) << error;
  EXPECT_NE(error.find("lasts 0.0003142 s, 0.314 steps instead of 10, half of run.steps_per_period; set "
                       "3.141e-05 s or less (\"auto\": 1.57e-05 s)"),
            std::string::npos)
      << error;
  EXPECT_EQ(errorOf(scene, {"run.time_step=3.141e-5"}), "no error");
  EXPECT_NE(errorOf(scene, {"run.time_step=3.15e-5"}), "no error");
  EXPECT_EQ(errorOf(scene, {"run.time_step=1e-4", "run.steps_per_period=6"}), "no error");
  EXPECT_NE(errorOf(scene, {"run.time_step=1e-3", "run.integrator=symplectic_euler"}), "no error");
  EXPECT_EQ(errorOf(scene, {"run.tolerance=1e-6"}), "no error");
  EXPECT_EQ(errorOf(slider(""), {"run.time_step=1e-3"}), "no error");
}

TEST(TimeScales, StepsThatTurnABrakedVelocityRoundAreRefusedWithTheNumber) {
  // 4 kg on 4e4 N s/m: decays in 100 us.
  const std::string scene = slider("damping = 4e4\n");
  const std::string error = errorOf(scene, {"run.time_step=1e-3"});
  EXPECT_EQ(error.rfind("--set: run.time_step = 0.001 [s] is too long for the damper of ", 0), 0u) << error;
  EXPECT_NE(error.find("time constant is 0.0001 s, and with rattle velocities change sign in every step longer than "),
            std::string::npos)
      << error;
  EXPECT_EQ(errorOf(scene, {"run.time_step=1.999e-4"}), "no error");
  EXPECT_NE(errorOf(scene, {"run.time_step=2.01e-4"}), "no error");
  EXPECT_EQ(errorOf(scene, {"run.time_step=1e-3", "run.integrator=symplectic_euler"}), "no error");
  EXPECT_NEAR(stepOf(scene), 1e-4, 2e-7) << "an integer fraction of a row of 0.1 s";
  EXPECT_NEAR(stepOf(scene, {"run.integrator=symplectic_euler"}), 1e-3, 1e-9);
  EXPECT_NE(
      springStepNote(parseScene(slider("damping = 4e9\n"), "scene.toml"))
          .find("time constant of 1e-09 s; run.integrator = \"symplectic_euler\" integrates dampers implicitly and is "
                "stable at run.time_step = 0.001"),
      std::string::npos)
      << springStepNote(parseScene(slider("damping = 4e9\n"), "scene.toml"));
}

TEST(TimeScales, SwingsOfAVehiclesSpringsAndStopsAreJudgedAtTheirKeys) {
  const auto scene = [](const test::SpecVariant& variant) {
    return "version = 1\n[run]\nduration = 3\n[material.soil]\n[terrain]\nmaterial = \"soil\"\nheightmap = "
           "\"heightmaps/hills.png\"\nsize = [6, 4]\nheight_range = [0, 0.3]\nkind = \"rigid\"\n[vehicle]\n"
           "spec = \"" +
           variant.path() + "\"\n";
  };
  struct Stiff {
    std::vector<test::KeyChange> changes;
    const char* words;
    double period;
  };
  // About the pivot 0.1 + 15 x 0.125^2 + 25 x 0.25^2 = 1.896875 kg m2; carrier and idler 28 kg.
  const Stiff all[] = {
      {{{"arm", "stiffness", "1e8"}}, "arm.stiffness = 100000000 [N m/rad] is under-resolved", 8.653648e-4},
      {{{"idler", "stiffness", "1e9"}, {"idler", "stop_stiffness", "1e9"}},
       "idler.stiffness = 1000000000 [N/m] is under-resolved",
       1.051378e-3},
      {{{"idler", "stop_stiffness", "1e10"}},
       "idler.stop_stiffness = 10000000000 [N/m] is under-resolved",
       3.324749e-4},
  };
  for (const Stiff& stiff : all) {
    const test::SpecVariant variant(stiff.changes);
    const std::string error = errorOf(scene(variant), {"run.time_step=1e-4"});
    EXPECT_TRUE(std::regex_search(error, std::regex("\\.toml:[0-9]+: "))) << error;
    EXPECT_NE(error.find(stiff.words), std::string::npos) << error;
    EXPECT_NE(error.find("an oscillation of "), std::string::npos) << error;
    EXPECT_NEAR(stepAskedFor(error), stiff.period / 20, 1e-3 * stiff.period / 20) << error;
    EXPECT_NEAR(stepOf(scene(variant)), stiff.period / 20, 1e-5 * stiff.period) << "auto";
    EXPECT_EQ(errorOf(scene(variant), {"run.time_step=1e-4", "run.steps_per_period=2"}), "no error");
  }
  EXPECT_EQ(errorOf(scene(test::SpecVariant({})), {"run.time_step=1.2e-4"}), "no error");
}

TEST(TimeScales, AutomaticStepTakesTwentyStepsForABounceOffAStop) {
  // A slider of 4 kg against a stop of 4e8 N/m: pi / sqrt(k / m) = 314 us; a twentieth of that.
  const std::string slider =
      "version = 1\n[run]\nduration = 1\noutput_interval = 0.1\n[[body]]\nname = \"slider\"\nmass "
      "= 4\ninertia = [1, 1, 1]\n[[joint]]\nname = \"rail\"\ntype = \"prismatic\"\nbodies = "
      "[\"world\", \"slider\"]\npoint = [0, 0, 0]\naxis = [0, 0, 1]\nlimits = [-1, 1]\nstop_stiffness = 4e8\n";
  EXPECT_NEAR(stepOf(slider), 1.5708e-5, 0.001 * 1.5708e-5);
}

} // namespace
} // namespace grouser::setup
