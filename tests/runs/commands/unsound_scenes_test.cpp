// SPDX-License-Identifier: BSD-3-Clause
// Unstable scenes are rejected or stopped, and the message names the true cause.
#include "tests/runs/program_fixture.hpp"
#include "tests/runs/scene_fixture.hpp"
#include "tests/system/guard_scenes.hpp"

#include <gtest/gtest.h>

#include <fmt/format.h>

namespace grouser::commands {

using namespace test; // fixtures and pieces of scenes

namespace {

struct Unsound {
  const char* name;
  int code;                       ///< 2: rejected; 3: stopped during the run
  std::string text;               ///< the scene
  std::vector<std::string> words; ///< required words of the message
  std::vector<std::string> never = {};
};
std::ostream& operator<<(std::ostream& out, const Unsound& u) { return out << u.name; }

class UnsoundScenes : public ProgramTest, public ::testing::WithParamInterface<Unsound> {};

TEST_P(UnsoundScenes, StopWithTheTrueCause) {
  put(folder_ / "scene.toml", GetParam().text);
  const Outcome o = call("run scene.toml --out out --threads 1 --set output.plots=false --set output.picture=false "
                         "--set output.frames=false");
  EXPECT_EQ(o.code, GetParam().code) << o.errors;
  EXPECT_EQ(std::filesystem::exists(folder_ / "out"), GetParam().code == 3);
  for (const std::string& word : GetParam().words)
    EXPECT_NE(o.errors.find(word), std::string::npos) << word << ": " << o.errors;
  for (const std::string& word : GetParam().never)
    EXPECT_EQ(o.errors.find(word), std::string::npos) << word << ": " << o.errors;
}

const auto kName = [](const auto& tested) { return std::string(tested.param.name); };
const std::string kStiffSpeed = "time_step = 5e-5\n";

/// The shipped vehicle on rigid, level ground, in the middle of 20 m; `driver` contains its ramps.
std::string vehicle(const std::string& driver, const std::string& more = "", const std::string& mount = "") {
  return run(0.4, "time_step = 1e-4\n" + more) + soil(0.5, 0.5, "", "1e7") +
         "[terrain]\nheightmap = \"heightmaps/flat.png\"\nsize = [20, 20]\nheight_range = [0, 0]\nkind = \"rigid\"\n"
         "material = \"soil\"\n[vehicle]\nspec = \"vehicles/light_tracked.toml\"\nsphere_radius = 0.03\n"
         "position = [8, 0]\n" +
         mount + "[driver]\n" + driver;
}
const std::string kQuickStart = "tension_ramp = 0.03\nweight_ramp = 0.05\ndrive_start = 0.1\n";

INSTANTIATE_TEST_SUITE_P(
    Refused, UnsoundScenes,
    ::testing::Values(
        Unsound{"StepAboveTheLimit",
                2,
                heap(0.3, soil(0.5, 0.5), {}, "time_step = 1e-3\n"),
                {"scene.toml:6: run.time_step", "is above 0.000114 s", "grain on grain of 'soil'"}},
        Unsound{"DashpotAboveTheStep",
                2,
                heap(0.3, "[material.soil]\nstiffness = 2e4\ndamping = 4e4\n", {}, kStiffSpeed),
                {"run.time_step", "the stability limit of the stiffest contact in the scene"}},
        Unsound{"AliasedShaker",
                2,
                run(0.3, kStiffSpeed) + soil(0.5, 0.5) + floor("amplitude = [0, 0, 1e-5]\nfrequency = 19990\n") +
                    grain("[0, 0, 0.02]"),
                {"plane.0.frequency", "a period of 5.003e-05 s spans 1 of the required 20"}},
        Unsound{"AliasedTurn",
                2,
                run(0.3, kStiffSpeed) + soil(0.5, 0.5) + floor() + grain("[0, 0, 0.02]") +
                    box("[0.05, 0, 0.02]", "[0.02, 0.001, 0.001]", "spin = [0, 0, 10000]\n"),
                {"box.0.spin", "a turn of 0.0006283 s spans 12.6 of the required 20"}},
        Unsound{"AliasedDrive",
                2,
                run(1, "time_step = 1e-3\n") + rotor("imposes = \"torque\"\namplitude = 100\nfrequency = 1001\n"),
                {"drive.0.frequency = 1001 [Hz] is under-resolved", "spans 0.999 of the required 20"}},
        Unsound{"AliasedTable",
                2,
                run(1, "time_step = 1e-2\n") +
                    rotor("imposes = \"torque\"\ntime = [0, 0.01, 0.02, 0.03]\nvalues = [0, 10, -10, 0]\n"),
                {"drive.0.time", "the interval of 0.01 s from 0.02 to 0.03 s spans 1 of the required 20"}},
        Unsound{"DriveTooQuick",
                2,
                run(1, "time_step = 1e-3\n") + rotor("value = 500\n"),
                {"is too long for body \"rotor\", which initially rotates by 0.5 rad per step"}},
        Unsound{"StartsTooFast",
                2,
                run(0.3, kStiffSpeed) + soil(0.5, 0.5) + floor() + grain("[0, 0, 0.5]", "velocity = [0, 0, -400]\n"),
                {"grain.0.velocity", "half the skin distance"}},
        Unsound{"StartsPressed",
                2,
                run(0.3, kStiffSpeed) + soil(0.5, 0.5) + floor() + grain("[0, 0, 0.5]") + grain("[0, 0, 0.507]"),
                {"grain.1.position", "overlaps grain 0", "by 0.003 m"}},
        Unsound{"SoftUnderItsWeight",
                2,
                run(0.3) + soil(0.5, 0.5, "", "0.5") + floor() + grain("[0, 0, 0.5]", "", "0.02"),
                {"material.soil.stiffness", "the weight of a grain", "raise it to 208"}},
        Unsound{"LightLid",
                2,
                heap(0.3, soil(0.5, 0.5), {}, "time_step = 8e-5\n") +
                    box("[0, 0, 0.09]", "[0.058, 0.058, 0.01]", "free = \"z\"\nmass = 1e-4\nload = -20\n"),
                {"run.time_step", "of 0.0001 kg on up to", "raise box.0.mass"}},
        Unsound{
            "StiffExplicitSpring",
            2,
            run(2, "springs = \"explicit\"\ntime_step = 0.01\n") + body("block", "[0, 0, 0]") +
                "[[spring]]\nname = \"bar\"\nbodies = [\"world\", \"block\"]\npoint_a = [0, 0, 1]\nstiffness = 1e5\n",
            {"beyond the stability limit", "spring 'bar'"}}),
    kName);

INSTANTIATE_TEST_SUITE_P(
    Grains, UnsoundScenes,
    ::testing::Values(
        Unsound{"HertzFasterThanItsStep",
                3,
                run(0.3, "gravity = [0, 0, 0]\nimpact_speed = 1e-3\ntime_step = 6.7e-5\nmax_overlap = 0.5\n") +
                    hertz(1, 0.5, "1e9") + floor() + walls(0.04) + plane("[0, 0, 0.08]", "[0, 0, -1]") +
                    grains({60, 0.04, 0, 0.08, "0.005", "velocity = [0.8, 0.5, 0.3]\n"}),
                {"time integration created", "hertz contacts assume run.impact_speed = 0.001 m/s: raise it"}},
        Unsound{"Crusher",
                3,
                run(0.3) + soil(0.5, 0.5) + floor("name = \"jaw\"\n") +
                    plane("[0, 0, 0.012]", "[0, 0, -1]", "name = \"ram\"\nvelocity = [0, 0, -0.1]\n") +
                    grain("[0, 0, 0.005]"),
                {"is about to pass through a rigid surface; plane 'jaw' overlaps it by 4 mm of its radius of 5 mm",
                 "it is pinched between plane 'jaw' (4 mm) and plane 'ram' (4 mm); the energies balance"},
                {"too long"}},
        Unsound{"PinchedByBoxes",
                3,
                run(0.3) + soil(0.5, 0.5) + floor() + grain("[0, 0, 0.005]") +
                    box("[-0.02, 0, 0.01]", "[0.02, 0.02, 0.019]", "name = \"left\"\n") +
                    box("[0.02, 0, 0.01]", "[0.02, 0.02, 0.019]", "name = \"right\"\nvelocity = [-0.1, 0, 0]\n"),
                {"it is pinched between box 'left' (4 mm) and box 'right' (4 mm)"},
                {"too long"}},
        Unsound{"PistonOnABed",
                3,
                heap(0.3, soil(0.5, 0.5)) +
                    box("[0, 0, 0.08]", "[0.058, 0.058, 0.01]", "name = \"piston\"\nvelocity = [0, 0, -0.5]\n"),
                {"it is pinched between", "less load or lower speed"},
                {"too long"}},
        Unsound{"LoadOnABed",
                3,
                heap(0.3, soil(0.5, 0.5)) + box("[0, 0, 0.08]", "[0.058, 0.058, 0.01]",
                                                "name = \"lid\"\nfree = \"z\"\nmass = 1\nload = -20000\n"),
                {"box 'lid'"},
                {"too long"}},
        Unsound{"MeshOnABed",
                3,
                run(0.5) + soil(0.5, 0.5, "", "1e5") + floor() + walls(0.2) + grains({30, 0.19, 0, 0.3, "0.03"}) +
                    "[[mesh]]\nname = \"tup\"\nfile = \"meshes/roller.obj\"\nposition = [0, 0, 0.5]\nvelocity = [0, 0, "
                    "-2]\nsphere_radius = 0.02\nmaterial = \"soil\"\n",
                {"mesh 'tup'"},
                {"too long"}},
        Unsound{"HitTooFast",
                3,
                run(0.3) + soil(0.5, 0.5) + floor() + grain("[0, 0, 0.02]", "velocity = [0, 0, -25]\n"),
                {"it is pressed by plane 0 (4", "it moves at"},
                {"too long"}},
        Unsound{"Blade",
                3,
                run(0.5) + soil(0.5, 0.5) + floor() + walls(0.03) + grains({60, 0.03, 0.04, 0.12}) +
                    box("[0, 0, 0.02]", "[0.05, 0.006, 0.03]", "name = \"blade\"\nspin = [0, 0, 1500]\n"),
                {"box 'blade'"},
                {"too long"}},
        Unsound{
            "TallStack",
            3,
            run(0.3, "gravity = [0, 0, -300]\n") + soil(0.5, 0.5, "", "3e3") + floor() + grains({1, 0.005, 0, 0.01}) +
                [] {
                  std::string more;
                  for (int i = 1; i < 50; ++i) more += grain(fmt::format("[0, 0, {:g}]", 0.005 + 0.01 * i));
                  return more;
                }(),
            {"it is pinched between grain", "and grain"},
            {"too long"}},
        Unsound{"FallsForEver",
                3,
                run(1, "gravity = [0, 0, -900]\n") + soil(0.5, 0.5) + grain("[0, 0, 0]"),
                {"it falls without contact: add a floor"},
                {"smaller time_step"}},
        Unsound{
            "LidThatRunsAway",
            3,
            run(3) + soil(0.5, 0.5) + floor() + grain("[0, 0, 0.005]") +
                box("[0, 0, 0.1]", "[0.05, 0.05, 0.01]", "name = \"lid\"\nfree = \"z\"\nmass = 0.01\nload = 1000\n"),
            {"the loaded surface lid moves at", "lower its load, raise its mass"}}),
    kName);

INSTANTIATE_TEST_SUITE_P(
    Vehicles, UnsoundScenes,
    ::testing::Values(
        Unsound{"StepAboveThatOfShoes",
                2,
                replaced(vehicle(kQuickStart + "sprocket_speed = 2\n"), "1e-4", "3e-4"),
                {"run.time_step", "shoe on rigid ground under a road wheel"}},
        Unsound{"WheelsTurnTooFar",
                2,
                vehicle(kQuickStart + "sprocket_speed = 20\n", "steps_per_period = 2000\n"),
                {"driver.tension_ramp"}},
        Unsound{
            "SprocketTurnsTooFar",
            2,
            vehicle("tension_ramp = 0\nweight_ramp = 0\ndrive_start = 0\ndrive_ramp = 0\nsprocket_speed = 20\n",
                    "steps_per_period = 2000\n"),
            {"driver.sprocket_speed = 20 [rad/s] is under-resolved", "a turn of the smallest wheel of 0.1154 s spans"}},
        Unsound{"TeethThatSkip",
                3,
                vehicle(kQuickStart + "sprocket_speed = 100\ndrive_ramp = 0.05\n"),
                {"left track skips: 2.", "tighten the track (idler.preload of the vehicle file, 9200 N)"}}),
    kName);

INSTANTIATE_TEST_SUITE_P(
    Mechanisms, UnsoundScenes,
    ::testing::Values(Unsound{"SpunUp",
                              3,
                              run(4, "time_step = 1e-3\n") + rotor("imposes = \"torque\"\nvalue = 10\n"),
                              {"body \"rotor\" rotates by 0.315 rad a step (spun up from 0 rad"}},
                      Unsound{"SpunUpTheWrongWay",
                              3,
                              run(5, "time_step = 1e-3\n") + rotor("imposes = \"torque\"\nvalue = -400\n"),
                              {"step 100,", "body \"rotor\" rotates by 0.4 rad a step (spun up"}},
                      Unsound{"DriveThatRunsAway",
                              3,
                              run(2, "time_step = 1e-3\n") + rotor("polynomial = [0, 400]\n"),
                              {"step 800,", "body \"rotor\" rotates by 0.32 rad a step"}},
                      Unsound{"GearThatTurnsTooFast",
                              3,
                              run(2, "time_step = 1e-3\n") + rotor("time = [0, 1]\nvalues = [0, 20]\n") +
                                  body("pinion", "[1, 0, 0]", "", 0.1, "[1e-4, 1e-4, 1e-4]") +
                                  joint("shaft", "world", "pinion", "[1, 0, 0]", "axis = [0, 0, 1]\n") +
                                  "[[coupling]]\nname = \"gears\"\njoints = [\"axle\", \"shaft\"]\nratio = -50\n",
                              {"body \"pinion\" rotates by"},
                              {"body \"rotor\""}},
                      Unsound{"TautChain",
                              3,
                              run(1, "time_step = 1e-3\n") + chain(10) +
                                  "[[spring]]\nname = \"pull\"\nbodies = [\"world\", \"link 9\"]\npoint_a = [5, 0, "
                                  "0]\npoint_b = [0.05, 0, 0]\nstiffness = 1e6\nfree_position = 1\n",
                              {"the load on joint 'pin 9' limits stable steps to 3.7e-05 s"}},
                      Unsound{"StopHitInOneStep",
                              3,
                              run(2, "time_step = 1e-3\nsteps_per_period = 2\nintegrator = \"symplectic_euler\"\n") +
                                  pendulum("limits = [-0.5, 0.7]\nstop_stiffness = 1e6\n"),
                              {"time integration ", "a bounce off spring 'pin stops' lasts 0.0016 s"}},
                      Unsound{
                          "WhirledChain",
                          3,
                          run(1, "time_step = 1e-3\n") + chain(10) +
                              "[[drive]]\nname = \"crank\"\njoint = \"pin 0\"\ntime = [0, 0.5]\nvalues = [0, 200]\n",
                          {"body \"link"}}),
    kName);

} // namespace
} // namespace grouser::commands
