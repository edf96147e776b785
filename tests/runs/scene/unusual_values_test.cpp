// SPDX-License-Identifier: BSD-3-Clause
// Values in a wrong unit are noted with the unit that was probably meant, in scenes, soil files and vehicle files; the
// scenes, soils and vehicles of this repository have no such notes.
#include "runs/scene/scene_file.hpp"
#include "runs/scene/soil.hpp"
#include "tests/message_of.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace grouser::scene {
namespace {

namespace fs = std::filesystem;

const fs::path kSource = GROUSER_SOURCE_DIR;

/// A scene of the repository with one key in a wrong unit, and the unit that the note names.
struct Slip {
  const char *scene, *set, *unit;
};

constexpr const char* kScm = "runs/scenes/scm_drive.toml";
constexpr const char* kDrawbar = "runs/scenes/drawbar.toml";
constexpr const char* kSurfaces = "tests/scenes/moving.toml";
constexpr const char* kBed = "runs/scenes/quickstart_grains.toml";
constexpr const char* kBodies = "tests/scenes/bodies.toml";
constexpr const char* kCrank = "runs/mechanisms/slider_crank.toml";
constexpr const char* kDoor = "runs/mechanisms/door.toml";
constexpr const char* kFluid = "tests/scenes/fluid.toml";
constexpr const char* kSource1 = "tests/scenes/rain.toml";

const Slip kSlips[] = {
    {kScm, "scm.phi=0.54", "in radians? 0.54 rad = 30.94 deg"},
    {kScm, "scm.k_phi=5301", "in kN/m^(n+2)? 5301 kN/m^(n+2) = 5.301e+06"},
    {kScm, "scm.k_phi=5.301", "in MN/m^(n+2)? 5.301 MN/m^(n+2) = 5.301e+06"},
    {kScm, "scm.k_c=0.99", "in kN/m^(n+1)? 0.99 kN/m^(n+1) = 990"},
    {kScm, "scm.c=1.3", "in kPa? 1.3 kPa = 1300 Pa"},
    {kScm, "scm.c=5e6", "check the value"},
    {kScm, "scm.n=2.5", "check the value"},
    {kScm, "scm.K=0.4", "in centimetres? 0.4 cm = 0.004 m"},
    {kScm, "scm.repose_angle=0.52", "in radians? 0.52 rad = 29.79 deg"},
    {kScm, "scm.bulk_density=1.6", "in g/cm3 or t/m3? 1.6 g/cm3 = 1600 kg/m3"},
    {kScm, "scm.damping=30", "in kPa s/m? 30 kPa s/m = 3e+04 Pa s/m"},
    {kScm, "scm.unloading_stiffness=8000", "in kN/m3? 8000 kN/m3 = 8e+06 N/m3"},
    {kScm, "scm.node_spacing=0.9", "in centimetres? 0.9 cm = 0.009 m"},
    {kScm, "scm.largest_sinkage=5", "in centimetres? 5 cm = 0.05 m"},
    {kScm, "scm.maximum_slip_sinkage=0.9", "in millimetres? 0.9 mm = 0.0009 m"},
    {kScm, "vehicle.heading=0.54", "in radians? 0.54 rad = 30.94 deg"},
    {kScm, "vehicle.heading=1.5708", "in radians? 1.5708 rad = 90 deg"},
    {kScm, "vehicle.heading=1.5708", "is a common fraction of a turn; in radians? 1.5708 rad = 90 deg"},
    {kScm, "vehicle.heading=3.14", "in radians? 3.14 rad = 179.9 deg"},
    {kScm, "vehicle.clearance=2", "in millimetres? 2 mm = 0.002 m"},
    {kScm, "vehicle.sphere_radius=0.9", "in centimetres? 0.9 cm = 0.009 m"},
    {kScm, "driver.sprocket_speed=90", "in revolutions per minute? 90 rpm = 9.425 rad/s"},
    {kScm, "driver.weight_ramp=300", "in milliseconds? 300 ms = 0.3 s"},
    {kScm, "driver.drive_ramp=300", "in milliseconds? 300 ms = 0.3 s"},
    {kScm, "run.duration=5000", "in milliseconds? 5000 ms = 5 s"},
    {kScm, "run.time_step=0.1", "in milliseconds? 0.1 ms = 0.0001 s"},
    {kScm, "run.output_interval=20", "in milliseconds? 20 ms = 0.02 s"},
    {kScm, "run.gravity=[0, 0, -9810]", ""}, // outside the hard range
    {kScm, "run.gravity=[0, 0, -981]", "in cm/s2? -981 cm/s2 = -9.81 m/s2"},
    {kScm, "run.gravity=[0, 0, -1]", "in multiples of g? -1 g = -9.807 m/s2"},
    {kScm, "terrain.size=[26000, 12000]", "in millimetres? 26000 mm = 26 m"},
    {kScm, "spec.arm.stiffness=2e7", "check the value"},
    {kScm, "spec.shoe.pitch=0.9", "in centimetres? 0.9 cm = 0.009 m"},
    {kScm, "spec.contact.foundation_modulus=1e4", "in kN/m3? 10000 kN/m3 = 1e+07 N/m3"},
    {kScm, "spec.contact.relaxation_time=0.1", "in milliseconds? 0.1 ms = 0.0001 s"},
    {kScm, "spec.idler.stiffness=50", "in N/mm or kN/m? 50 kN/m = 5e+04 N/m"},
    {kScm, "spec.idler.stop_stiffness=10", "in N/mm or kN/m? 10 kN/m = 1e+04 N/m"},
    {kScm, "spec.contact.friction_ground=3", "tan of the friction angle, not the angle"},
    {kDrawbar, "hitch.slip=5", "in percent? 5 % = 0.05"},
    {kDrawbar, "hitch.slip=20", "in percent? 20 % = 0.2"},
    {kDrawbar, "hitch.slip=-2", ""},
    {kDrawbar, "hitch.position=[-500, 0, 0]", ""},
    {kDrawbar, "hitch.position=[-50, 0, 0]", "in millimetres? -50 mm = -0.05 m"},
    {kDrawbar, "hitch.ramp=300", "in milliseconds? 300 ms = 0.3 s"},
    {kSurfaces, "box.0.size=[200, 100, 50]", "in millimetres"},
    {kSurfaces, "cylinder.0.spin=[0, 300, 0]", "in revolutions per minute? 300 rpm = 31.42 rad/s"},
    {kSurfaces, "cylinder.0.amplitude=[0, 0, 20]", "in millimetres? 20 mm = 0.02 m"},
    {kSurfaces, "cylinder.0.phase=-1.5708", "in radians? -1.5708 rad = -90 deg"},
    {kSurfaces, "cylinder.0.frequency=5e4", "in revolutions per minute"},
    {kSurfaces, "cylinder.0.radius=300", "in millimetres? 300 mm = 0.3 m"},
    {kSurfaces, "material.glass.density=2.65", "in g/cm3 or t/m3? 2.65 g/cm3 = 2650 kg/m3"},
    {kSurfaces, "material.glass.friction=5", "tan of the friction angle, not the angle"},
    {kSurfaces, "material.glass.friction=30", "tan of the friction angle, not the angle"},
    {kSurfaces, "material.glass.stiffness=1", "in N/mm or kN/m? 1 kN/m = 1000 N/m"},
    {kSurfaces, "material.glass.cohesion=5000", "in mJ/m2? 5000 mJ/m2 = 5 J/m2"},
    {kBed, "terrain.grain_radius=5", "in millimetres? 5 mm = 0.005 m"},
    {kBed, "terrain.depth=30", "in millimetres? 30 mm = 0.03 m"},
    {kBed, "terrain.settle_time_limit=3000", "in milliseconds? 3000 ms = 3 s"},
    {kBed, "terrain.wall_friction=5", "tan of the friction angle, not the angle"},
    {kBodies, "body.0.mass=5e6", "in grams? 5e+06 g = 5000 kg"},
    {kBodies, "body.0.velocity=[500, 0, 0]", "in km/h? 500 km/h = 138.9 m/s"},
    {kBodies, "body.0.spin=[0, 0, 3000]", "in revolutions per minute? 3000 rpm = 314.2 rad/s"},
    {kBodies, "body.0.position=[2000, 0, 500]", "in millimetres? 2000 mm = 2 m"},
    {kCrank, "drive.0.value=9000", "in degrees per second? 9000 deg/s = 157.1 rad/s"},
    {kCrank, "drive.0.value=500", "in revolutions per minute? 500 rpm = 52.36 rad/s"},
    {kDoor, "joint.0.limits=[-90, 90]", "in degrees? -90 deg = -1.571 rad or m"},
    {kFluid, "fluid.density=1.0", "in g/cm3 or t/m3? 1 g/cm3 = 1000 kg/m3"},
    {kFluid, "fluid.viscosity=1e-6", "kinematic viscosity? multiply it by the density"},
    {kFluid, "fluid.spacing=5", "in millimetres? 5 mm = 0.005 m"},
    {kFluid, "fluid.sound_speed=5000", "in km/h? 5000 km/h = 1389 m/s"},
    {kSource1, "source.0.radius=4", "in millimetres? 4 mm = 0.004 m"},
    {kSource1, "source.0.every=500", "in milliseconds? 500 ms = 0.5 s"},
};

TEST(UnusualValues, AWrongUnitIsNotedOrRefusedWithTheUnitThatWasMeant) {
  for (const Slip& slip : kSlips) {
    const std::string set = slip.set, key = set.substr(0, set.find('='));
    std::string all;
    const std::string error = test::messageOf([&] {
      for (const std::string& note : unusualValues(readScene(kSource / slip.scene, {set}))) all += note + "\n";
    });
    if (*slip.unit == 0) {
      EXPECT_NE(error, "") << set;
      continue;
    }
    const std::string& text = error.empty() ? all : error;
    const std::string last = key.substr(key.rfind('.') + 1) + " = ";
    EXPECT_NE(text.find("--set"), std::string::npos) << set << " of " << slip.scene << ": " << text;
    EXPECT_NE(text.find(last), std::string::npos) << set << ": " << text;
    EXPECT_NE(text.find(slip.unit), std::string::npos) << set << ": " << text;
  }
}

TEST(UnusualValues, NoSlipThatDragsTheVehicleBackwardsIsAccepted) {
  for (const char* slip : {"hitch.slip=1.01", "hitch.slip=5", "hitch.slip=-1.5"}) {
    const std::string error = test::messageOf([&] { readScene(kSource / kDrawbar, {slip}); });
    EXPECT_NE(error.find("[-] is outside [-1, 1]"), std::string::npos) << error;
  }
  EXPECT_EQ(test::messageOf([&] { readScene(kSource / kDrawbar, {"hitch.slip=1"}); }), "");
}

TEST(UnusualValues, ErrorsContainOnlyNotesOnTheirOwnKeys) {
  const std::string unusual = "scm.n=2.5", other = test::messageOf([&] {
                                             readScene(kSource / kScm, {unusual, "nosuch=1"});
                                           });
  EXPECT_NE(other.find("unknown key nosuch"), std::string::npos) << other;
  EXPECT_EQ(other.find("usual span"), std::string::npos) << other;
  const std::string own = test::messageOf([&] {
    readScene(kSource / kScm, {unusual, "run.output_interval=11", "run.checkpoint_interval=1e-320"});
  });
  EXPECT_NE(own.find("run.checkpoint_interval = 1e-320 [s] is below"), std::string::npos) << own;
  EXPECT_NE(own.find("; note: --set: run.checkpoint_interval = 1e-320 [s] is outside the usual span"),
            std::string::npos)
      << own;
  EXPECT_EQ(own.find("scm.n"), std::string::npos) << own;
  EXPECT_EQ(own.find("output_interval"), std::string::npos) << own;
}

TEST(UnusualValues, EngineSpeedsInRevolutionsPerMinuteAreNoted) {
  const std::vector<std::string> engine = {"spec.engine.speed=[800, 2600]", "spec.engine.torque=[900, 800]",
                                           "spec.engine.ratio=12.0",        "spec.engine.governed_speed=2800",
                                           "spec.engine.droop=200",         "spec.engine.inertia=1.0"};
  const std::vector<std::string> notes = unusualValues(readScene(kSource / kScm, engine));
  ASSERT_EQ(notes.size(), 3u);
  for (const std::string& note : notes) EXPECT_NE(note.find("in revolutions per minute?"), std::string::npos) << note;
}

TEST(UnusualValues, ConstantsOfASoilFileAreNotedWithItsLine) {
  const fs::path folder = fs::temp_directory_path() / "grouser_unusual_soil";
  fs::create_directories(folder / "soils");
  std::ifstream in(kSource / "assets/soils/dry_sand.toml");
  std::string text((std::istreambuf_iterator<char>(in)), {});
  const std::size_t at = text.find("quantity = \"phi\"");
  ASSERT_NE(at, std::string::npos);
  const std::size_t value = text.find("value = ", at), end = text.find('\n', value);
  text.replace(value, end - value, "value = 0.49");
  std::ofstream(folder / "soils/sand.toml") << text;
  fs::copy_file(kSource / kScm, folder / "scm_drive.toml", fs::copy_options::overwrite_existing);
  std::string all;
  for (const std::string& note : unusualValues(readScene(folder / "scm_drive.toml", {"terrain.material=sand"})))
    all += note + "\n";
  fs::remove_all(folder);
  EXPECT_NE(all.find("sand.toml:"), std::string::npos) << all;
  EXPECT_NE(all.find("value of phi = 0.49 [deg] is outside the usual span, 4 to 50 deg; in radians?"),
            std::string::npos)
      << all;
}

TEST(UnusualValues, ScenesSoilsAndVehiclesOfTheRepositoryHaveNone) {
  int read = 0;
  for (const char* folder : {"runs/scenes", "runs/mechanisms", "tests/scenes", "docs/evidence"})
    for (const fs::directory_entry& entry : fs::directory_iterator(kSource / folder)) {
      if (entry.path().extension() != ".toml") continue;
      Scene scene;
      if (const std::string error = test::messageOf([&] { scene = readScene(entry.path()); }); !error.empty()) continue;
      ++read;
      for (const std::string& note : unusualValues(scene)) ADD_FAILURE() << note;
    }
  EXPECT_GT(read, 80);
  const fs::path soils = kSource / "assets/soils";
  for (const fs::directory_entry& entry : fs::directory_iterator(soils))
    if (entry.path().extension() == ".toml")
      for (const base::UnusualValue& u : readSoil(entry.path()).document->unusual()) ADD_FAILURE() << u.note;
}

} // namespace
} // namespace grouser::scene
