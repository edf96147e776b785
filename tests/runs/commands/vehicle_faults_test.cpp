// SPDX-License-Identifier: BSD-3-Clause
// Invalid vehicles, rejected before the run; valid vehicles, which run; sinkage from frames.
#include "base/error.hpp"
#include "coupling/simulation.hpp"
#include "runs/render/image.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/setup/simulation_setup.hpp"
#include "tests/device_under_test.hpp"
#include "tests/runs/program_fixture.hpp"
#include "tests/runs/shared_cache.hpp"
#include "tests/vehicle/spec_variant.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fmt/format.h>

namespace grouser::commands {
namespace {

using test::KeyChange;
using test::SpecVariant;

class VehicleFaults : public test::ProgramTest {};

/// The complete scene of a vehicle on rigid, level ground; `more`: lines of [run].
std::string rigidScene(const std::string& spec, const std::string& more = "duration = 0.02\n") {
  return "version = 1\n[run]\ntime_step = 1e-4\n" + more +
         "[material.ground]\nstiffness = 1e7\n[terrain]\nheightmap = \"heightmaps/flat.png\"\nsize = [6, 2.6]\n"
         "height_range = [0, 0]\nkind = \"rigid\"\nmaterial = \"ground\"\n[vehicle]\nspec = \"" +
         spec +
         "\"\nsphere_radius = 0.03\n[driver]\nsprocket_speed = 2\n[output]\nframes = false\nplots = false\n"
         "picture = false\n";
}

struct Refused {
  KeyChange change;
  std::vector<std::string> words;
};

/// Faults of the running gear, and meshes that do not fit modified lengths, on the command line.
TEST_F(VehicleFaults, PlanAndRunRefuseThemAlikeAndWriteNothing) {
  const Refused all[] = {
      {{"road_wheel", "spacing", "0.30"},
       {"road_wheel.spacing = 0.3", "road wheel 0 and road wheel 1 overlap by 80.0 mm"}},
      {{"shoe", "count", "45"}, {"shoe.count = 45", "-80.7 mm", "set shoe.count = 46"}},
      {{"road_wheel", "radius", "0.18"}, {"road_wheel.radius = 0.18", "road_wheel.obj", "190.0 mm"}},
      {{"roller", "radius", "0.07"}, {"roller.radius = 0.07", "roller.obj", "set roller.radius = 0.09"}},
      {{"shoe", "half_length", "0.06"}, {"shoe.half_length = 0.06", "68.0 mm", "set shoe.half_length = 0.068"}},
      {{"shoe", "pad_half_width", "0.2"},
       {"shoe.pad_half_width = 0.2", "the pads reach to |y| = 140.0 mm", "set shoe.pad_half_width = 0.14"}},
      {{"shoe", "pad_bottom", "-0.06"}, {"shoe.pad_bottom = -0.06", "shoe.obj", "-55.0 mm", "= -0.04,"}},
      {{"shoe", "horn_height", "0.07"}, {"shoe.horn_height = 0.07", "60.0 mm"}},
      {{"shoe", "grouser_height", "0.03"}, {"shoe.grouser_height = 0.03", "15.0 mm"}},
      {{"sprocket", "mesh", "\"idler.obj\""}, {"sprocket.teeth = 10", "249.2 mm", "idler.obj"}},
      {{"vehicle", "track_offset", "0.5"},
       {"track_offset = 0.5 [m] places the left shoe 0 inside the hull chassis.obj"}},
      {{"vehicle", "track_offset", "0.9"},
       {"makes the hull chassis.obj and the left shoe 0 overlap by 35.0 mm", "set vehicle.track_offset = 0.94"}},
      {{"chassis", "mass", "0.5"}, {"kg/m3, lighter than air; choose a mass in ["}},
      {{"roller", "mass", "500"}, {"roller.obj", "kg/m3, heavier than any metal"}},
      {{"shoe", "inertia", "[1e-9, 1e-9, 1e-9]"},
       {"for 8.5 kg, a radius of gyration of 1.08e-05 m", "shoe.obj extends 0.199 m"}},
      {{"road_wheel", "inertia", "[9, 9, 9]"},
       {"for 25 kg, a radius of gyration of 0.6 m", "road_wheel.obj extends 0.218 m"}},
      {{"arm", "length", "0.01"}, {"arm.inertia", "the arm extends 0.01 m"}},
      {{"chassis", "centre", "[1.437, 0, 10]"}, {"9250 mm beyond the hull", "z must be in [-1.15, 1.7]"}},
      {{"shoe", "mesh", "\"nix.obj\""}, {"shoe.mesh = \"nix.obj\"", "nix.obj: no such file"}},
      {{"vehicle", "mesh_folder", "\"/nix\""}, {"chassis.mesh = \"chassis.obj\" in vehicle.mesh_folder", "/nix"}},
      {{"roller", "mesh", "\"sprocket.obj\""}, {"roller.radius", "sprocket.obj", "269.2 mm"}},
  };
  for (const Refused& r : all) {
    const SpecVariant variant({r.change});
    test::put(folder_ / "scene.toml", rigidScene(variant.path()));
    for (const char* command : {"plan scene.toml", "run scene.toml --out out"}) {
      const test::Outcome o = call(command);
      EXPECT_EQ(o.code, 2) << r.change.key << " " << command << o.out << o.errors;
      EXPECT_TRUE(std::regex_search(o.errors, std::regex("^grouser: error: .*\\.toml:[0-9]+: "))) << o.errors;
      EXPECT_EQ(std::count(o.errors.begin(), o.errors.end(), '\n'), 1) << o.errors;
      for (const std::string& word : r.words)
        EXPECT_NE(o.errors.find(word), std::string::npos) << word << ": " << o.errors;
      EXPECT_FALSE(std::filesystem::exists(folder_ / "out"));
    }
  }
}

TEST_F(VehicleFaults, GravityThatLiftsTheVehicleIsRefused) {
  test::put(folder_ / "scene.toml", rigidScene(GROUSER_SOURCE_DIR "/assets/vehicles/light_tracked.toml"));
  for (const char* gravity : {"[0, 0, 9.81]", "[0, 0, 0.1]", "[9.81, 0, 0]"})
    for (const char* chassis : {"free", "guided", "level"})
      for (const char* command : {"plan scene.toml --no-probe", "run scene.toml --out out"}) {
        const test::Outcome o =
            call(std::string(command) + " --set 'run.gravity=" + gravity + "' --set vehicle.chassis=" + chassis);
        EXPECT_EQ(o.code, 2);
        EXPECT_NE(o.errors.find(std::string("--set: run.gravity = ") + gravity +
                                " [m/s2] must point down for a vehicle with chassis = \"" + chassis),
                  std::string::npos)
            << o.errors;
        EXPECT_FALSE(std::filesystem::exists(folder_ / "out"));
      }
  EXPECT_EQ(call("plan scene.toml --no-probe --set run.gravity=[-1.7,0,-9.6]").code, 0) << "a slope";
  EXPECT_EQ(call("plan scene.toml --no-probe --set run.gravity=[0,0,0]").code, 0) << "weightless";
}

TEST_F(VehicleFaults, PlanRefusesSectionsThatTheVehicleFileLacks) {
  test::put(folder_ / "scene.toml", rigidScene(GROUSER_SOURCE_DIR "/assets/vehicles/light_tracked.toml"));
  const test::Outcome o = call("plan scene.toml --no-probe --set driver.drive=engine");
  EXPECT_EQ(o.code, 2);
  EXPECT_NE(o.errors.find("driver.drive = \"engine\" requires a section [engine] in the vehicle file"),
            std::string::npos)
      << o.errors;
}

TEST_F(VehicleFaults, PlanSaysWhichMaterialsDoNothing) {
  test::put(folder_ / "scene.toml", rigidScene(GROUSER_SOURCE_DIR "/assets/vehicles/light_tracked.toml"));
  EXPECT_NE(call("plan scene.toml --no-probe")
                .out.find("note: material.ground has no effect in this scene: the vehicle file defines all contact "
                          "parameters between vehicle and rigid ground"),
            std::string::npos);
}

struct Sound {
  std::string name;
  std::vector<KeyChange> changes;
};
std::ostream& operator<<(std::ostream& out, const Sound& s) { return out << s.name; }

class SoundVehicle : public ::testing::TestWithParam<Sound> {};

/// No check rejects a valid vehicle: no impact of an overlapping part in the first 200 steps. During track tensioning
/// (0.15 s) speeds stay within the take-up of slack.
TEST_P(SoundVehicle, RunsWithoutABlow) {
  const SpecVariant variant(GetParam().changes);
  coupling::Simulation simulation(
      setup::simulationSetup(setup::parseScene(rigidScene(variant.path()), GROUSER_SOURCE_DIR "/tests/scenes/x.toml")),
      testExec(), [](double, double) {}, {}, nullptr, sharedSpheres());
  double fastest = 0;
  while (simulation.steps() < 200) {
    simulation.step();
    for (const auto& twist : simulation.vehicle()->state().twist) fastest = std::max(fastest, norm(twist.v));
  }
  EXPECT_LT(fastest, 0.5) << "m/s"; // a roller 21 mm deep in its track makes 7e4 J of nothing
  simulation.checkEnergy();
}

INSTANTIATE_TEST_SUITE_P(
    Variants, SoundVehicle,
    ::testing::Values(
        Sound{"Shipped", {}}, Sound{"HeavyHull", {{"chassis", "mass", "5000.0"}}},
        Sound{"StiffTensioner", {{"idler", "stiffness", "6e5"}}}, Sound{"StiffBars", {{"arm", "stiffness", "12000"}}},
        Sound{"HeavyShoes", {{"shoe", "mass", "12"}}}, Sound{"WideTrack", {{"vehicle", "track_offset", "1.1"}}},
        Sound{"LowRollers", {{"roller", "z", "[0.1, 0.1, 0.1]"}}},
        Sound{"OtherRollers", {{"roller", "x", "[1.0, 1.7, 2.0]"}}},
        Sound{"TightTrack", {{"idler", "preload", "15000"}}},
        Sound{"FourWheels", {{"road_wheel", "count", "4"}, {"road_wheel", "spacing", "0.5944"}}},
        Sound{"LongVehicle", {{"shoe", "count", "48"}, {"road_wheel", "spacing", "0.4843"}, {"idler", "x", "2.9013"}}}),
    [](const auto& tested) { return tested.param.name; });

/// Ground that rises by 10 degrees to the left, from two rows of pixels: a plane.
void putSlope(const std::filesystem::path& file) {
  const std::uint8_t white = 255;
  render::writePng({2, 2, {white, white, white, white, white, white, 0, 0, 0, 0, 0, 0}}, file);
}

std::string slopeScene(const std::string& map) {
  // 2.6 m tan(10 degrees)
  return fmt::format(
      "version = 1\n[run]\ntime_step = 1e-4\nduration = 0.6\noutput_interval = 0.01\nframe_interval = 0.1\n"
      "[material.ground]\nstiffness = 1e7\n[terrain]\nheightmap = \"{}\"\nsize = [6, 2.6]\n"
      "height_range = [0, 0.45845]\nkind = \"rigid\"\nmaterial = \"ground\"\n[vehicle]\nspec = \"{}\"\n"
      "sphere_radius = 0.02\n[driver]\nsprocket_speed = 1\ntension_ramp = 0.05\nweight_ramp = 0.15\n"
      "drive_start = 0.25\n[output]\nplots = false\npicture = false\n",
      map, GROUSER_SOURCE_DIR "/assets/vehicles/light_tracked.toml");
}

TEST_F(VehicleFaults, SinkageOnASideSlopeIsThatOfTheFrames) {
  putSlope(folder_ / "slope.png");
  test::put(folder_ / "scene.toml", slopeScene("slope.png"));
  const test::Outcome run = call("run scene.toml --out out", withSharedCache());
  ASSERT_EQ(run.code, 0) << run.errors;
  // Poses are written in double precision: differences are rounding, 1e-9 m of the iteration.
  const test::Outcome check = shell("/usr/bin/python3 '" GROUSER_SOURCE_DIR "/runs/plots/check_sinkage.py' out 1e-8");
  if (check.errors.find("No module named") != std::string::npos) GTEST_SKIP() << check.errors;
  EXPECT_EQ(check.code, 0) << check.out << check.errors;
  // Rigid ground carries the grousers: every pad is 15 mm above it, less the contact overlap.
  double deepest = -1;
  ASSERT_EQ(
      std::sscanf(check.out.c_str(), "%*d values compared, largest difference %*f m, maximum sinkage %lf m", &deepest),
      1)
      << check.out;
  EXPECT_NEAR(deepest, -0.015, 0.001) << check.out;
}

TEST_F(VehicleFaults, SinkageInABedOnASideSlopeIsThatOfTheFrames) {
  putSlope(folder_ / "slope.png");
  std::string scene = slopeScene("slope.png");
  scene.replace(scene.find("kind = \"rigid\""), 14,
                "grain_radius = 0.045\nlayers = 2\narrangement = \"lattice\"\nfloor_grains = false\nwall_friction = "
                "0.5\nsettle_time_limit = 0");
  scene.replace(scene.find("size = [6,"), 10, "size = [4.4,");
  scene.replace(scene.find("stiffness = 1e7"), 15, "stiffness = 1e6");
  test::put(folder_ / "scene.toml", scene);
  ASSERT_EQ(call("run scene.toml --out out --set run.duration=0.4", withSharedCache()).code, 0);
  const test::Outcome check = shell("/usr/bin/python3 '" GROUSER_SOURCE_DIR "/runs/plots/check_sinkage.py' out 1e-8");
  if (check.errors.find("No module named") != std::string::npos) GTEST_SKIP() << check.errors;
  EXPECT_EQ(check.code, 0) << check.out << check.errors;
}

TEST_F(VehicleFaults, AVehicleThatNeverRestsIsSaid) {
  test::put(folder_ / "scene.toml",
            rigidScene(GROUSER_SOURCE_DIR "/assets/vehicles/light_tracked.toml", "duration = 0.5\n"));
  const test::Outcome o =
      call("run scene.toml --out out --set driver.rest_speed=1e-9 --set driver.rest_time_limit=0.05 "
           "--set driver.tension_ramp=0.02 --set driver.weight_ramp=0.03",
           withSharedCache());
  EXPECT_NE(o.code, 0);
  EXPECT_NE(o.errors.find("has not come to rest within driver.rest_time_limit = 0.05 s"), std::string::npos)
      << o.errors;
  EXPECT_TRUE(std::regex_search(o.errors, std::regex("step 10[05]0, "))) << o.errors;
}

TEST_F(VehicleFaults, ARunThatIsResumedBeforeItRestsDrivesOffAtTheSameStep) {
  test::put(folder_ / "scene.toml",
            rigidScene(GROUSER_SOURCE_DIR "/assets/vehicles/light_tracked.toml", "duration = 0.9\n"));
  const std::string keys = " --hash --set driver.tension_ramp=0.05 --set driver.weight_ramp=0.1 ";
  const test::Outcome whole = call("run scene.toml --out whole" + keys, withSharedCache());
  ASSERT_EQ(whole.code, 0) << whole.errors;
  EXPECT_TRUE(std::regex_search(whole.out, std::regex("sprockets start at 0\\.[1-7]"))) << whole.out;
  ASSERT_EQ(call("run scene.toml --out parts --steps 1500" + keys, withSharedCache()).code, 0);
  const test::Outcome rest = call("run scene.toml --out parts --resume parts/checkpoint.h5" + keys, withSharedCache());
  EXPECT_EQ(rest.hash(), whole.hash()) << rest.errors;
  EXPECT_TRUE(whole.hasHash());
}

} // namespace
} // namespace grouser::commands
