// SPDX-License-Identifier: BSD-3-Clause
// Vehicle and driver of a scene: keys of the vehicle file, torques, engines, courses.
#include "runs/scene/scene_file.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/setup/placement.hpp"
#include "runs/setup/vehicle_setup.hpp"

#include "base/error.hpp"
#include "tests/runs/scene_fixture.hpp"

#include <gtest/gtest.h>

namespace grouser::setup {

using namespace test; // fixtures

namespace {

std::string withDriver(const std::string& driver, const std::string& behind = "") {
  return replaced(goodScene(), "sprocket_speed = 1\n", driver + "\n") + behind;
}

/// The error message of a scene or its vehicle.
std::string refusal(const std::string& text, const std::vector<std::string>& overrides = {}) {
  try {
    vehicleSetup(parseScene(text, "scene.toml", overrides));
  } catch (const base::InputError& error) {
    return error.what();
  }
  return "";
}

void expectRefused(const std::string& text, const std::vector<std::string>& words,
                   const std::vector<std::string>& overrides = {}) {
  const std::string message = refusal(text, overrides);
  for (const std::string& word : words) EXPECT_NE(message.find(word), std::string::npos) << word << ": " << message;
}

TEST(SpecKeys, ChangeTheVehicleFileAndStandInTheResolvedCopy) {
  const std::string text = goodScene() + "[spec.idler]\npreload = 8000\n";
  const scene::Scene scene = parseScene(text, "scene.toml", {"spec.shoe.pin_damping=7.5", "spec.vehicle.name=mine"});
  const vehicle::VehicleSpec spec = vehicleSetup(scene).spec;
  EXPECT_EQ(spec.idler.preload, 8000);
  EXPECT_EQ(spec.shoe.pinDamping, 7.5);
  EXPECT_EQ(spec.name, "mine");
  const std::string resolved = scene::resolvedToml(scene);
  for (const char* line : {"[spec.idler]\npreload = 8000.0\n", "[spec.shoe]\npin_damping = 7.5\n", "name = \"mine\""})
    EXPECT_NE(resolved.find(line), std::string::npos) << line << resolved;
  const scene::Scene again = parseScene(resolved, "scene.toml");
  EXPECT_EQ(*again.vehicle, *scene.vehicle);
  EXPECT_EQ(scene::resolvedToml(again), resolved);
}

TEST(SpecKeys, MistakesAreNamedWhereTheyStand) {
  expectRefused(goodScene(), {"--set: spec.shoe.count = 4", "[12, 400]"}, {"spec.shoe.count=4"});
  expectRefused(goodScene(), {"spec.sho", "shoe"}, {"spec.sho.count=46"});
  expectRefused(goodScene(), {"spec.shoe.cuont", "count"}, {"spec.shoe.cuont=46"});
  expectRefused(goodScene(), {"spec.shoe.mesh", "string in quotes"}, {"spec.shoe.mesh=3"});
  expectRefused(goodScene(), {"--set", "light_tracked.toml", "shoe.count = 47", "set idler.x"}, {"spec.shoe.count=47"});
  const std::string noVehicle =
      "version = 1\n[run]\nduration = 1\n[material.m]\n[[plane]]\nmaterial = \"m\"\n[[grain]]\n"
      "position = [0, 0, 1]\nradius = 0.01\nmaterial = \"m\"\n[spec.shoe]\ncount = 46\n";
  expectRefused(noVehicle, {"scene.toml:11", "spec", "[vehicle]"});
}

TEST(SpecKeys, RigidArmsAndRollersLeftOutNeedNoOtherFile) {
  const scene::Scene scene =
      parseScene(goodScene(), "scene.toml", {"spec.arm.suspension=rigid", "spec.roller.x=[]", "spec.roller.z=[]"});
  const vehicle::VehicleSpec spec = vehicleSetup(scene).spec;
  EXPECT_EQ(spec.arm.suspension, vehicle::Suspension::rigid);
  EXPECT_TRUE(spec.roller.x.empty());
  const std::string resolved = scene::resolvedToml(scene);
  EXPECT_NE(resolved.find("x = []"), std::string::npos) << resolved;
  EXPECT_EQ(*parseScene(resolved, "scene.toml").vehicle, *scene.vehicle);
}

TEST(ReadyVehicles, FitTheirMeshes) {
  for (const char* name : {"light_tracked", "m113_like", "robot"}) {
    const scene::Scene scene =
        parseScene(goodScene(), "scene.toml",
                   {std::string("vehicle.spec=vehicles/") + name + ".toml", "vehicle.sphere_radius=0.005"});
    EXPECT_NO_THROW(checkParts(scene)) << name;
  }
  const scene::Scene wide =
      parseScene(goodScene(), "scene.toml", {"vehicle.spec=vehicles/m113_like.toml", "spec.shoe.pad_half_width=0.18"});
  EXPECT_THROW(checkParts(wide), base::InputError) << "the mesh keeps its width";
}

TEST(DriverByTorque, TablesAndConstantsReachTheDriver) {
  const auto driver = [](const std::string& text) { return vehicleSetup(parseScene(text, "scene.toml")).driver; };
  const auto constant = driver(withDriver("drive = \"torque\"\nleft_torque = 100\nright_torque = -50"));
  EXPECT_EQ(constant.drive, vehicle::SprocketDrive::torque);
  EXPECT_EQ(constant.torques.left, std::vector<double>{100});
  EXPECT_EQ(constant.torques.right, std::vector<double>{-50});
  const auto table =
      driver(withDriver("drive = \"torque\"", "[driver.torques]\ntime = [0, 1]\nleft = [0, 10]\nright = [0, 20]\n"));
  EXPECT_EQ(table.torques.right, (std::vector<double>{0, 20}));
  EXPECT_EQ(table.driveRamp, 0) << "a table is followed without a ramp";
}

TEST(DriverByTorque, MixedUpWithSpeedsIsRefused) {
  expectRefused(withDriver("torque = 100"), {"driver.torque = 100", "drive = \"torque\""});
  expectRefused(withDriver("drive = \"torque\"\nsprocket_speed = 1"), {"driver.sprocket_speed", "left_torque"});
  expectRefused(withDriver("drive = \"torque\"\nleft_torque = 1"), {"left_torque", "requires right_torque"});
  expectRefused(withDriver("drive = \"torque\"\ntorque = 1\nleft_torque = 1\nright_torque = 1"),
                {"conflicts with another torque setting"});
  expectRefused(withDriver("drive = \"torque\"", "[driver.torques]\ntime = [0, 1]\nleft = [0]\nright = [0, 1]\n"),
                {"driver.torques.left", "[N m]", "as many entries as time (2)"});
  expectRefused(withDriver("drive = \"steam\""), {"driver.drive", "speed, torque, engine"});
}

TEST(DriverByEngine, NeedsOneInTheVehicleFile) {
  expectRefused(withDriver("drive = \"engine\"\nsprocket_speed = 1"), {"driver.drive = \"engine\"", "[engine]"});
  const std::vector<std::string> engine = {"spec.engine.speed=[0, 300]", "spec.engine.torque=[400, 300]",
                                           "spec.engine.ratio=20",       "spec.engine.governed_speed=250",
                                           "spec.engine.droop=10",       "spec.engine.inertia=40"};
  EXPECT_EQ(refusal(withDriver("drive = \"engine\"\nsprocket_speed = 1"), engine), "");
  expectRefused(goodScene(), {"[engine]", "torque"}, {"spec.engine.speed=[0, 300]"});
}

TEST(DriverOfACourse, ReachesTheDriver) {
  const std::string path = "[driver.course]\nspeed = 1.5\nx = [1, 2, 3]\ny = [0, 0, 1]\nturn_gain = 0.25\n";
  const scene::Scene scene = parseScene(withDriver("", path), "scene.toml");
  const auto course = vehicleSetup(scene).driver.course;
  ASSERT_TRUE(course);
  EXPECT_EQ(course->speed, 1.5);
  EXPECT_EQ(course->y, (std::vector<double>{0, 0, 1}));
  EXPECT_NEAR(course->lookAhead, 4 * 0.4458, 1e-15) << "auto: from first to last road wheel";
  EXPECT_EQ(course->turnGain, 0.25);
  EXPECT_NEAR(course->tread, 1.9, 1e-15);
  EXPECT_EQ(parseScene(scene::resolvedToml(scene), "scene.toml").driver, scene.driver);
  const scene::Scene circle = parseScene(withDriver("", "[driver.course]\nspeed = 1\nradius = -4\n"), "scene.toml");
  EXPECT_EQ(vehicleSetup(circle).driver.course->curvature, -0.25);
}

TEST(DriverOfACourse, MistakesAreRefused) {
  const auto course = [](const std::string& keys) { return withDriver("", "[driver.course]\n" + keys + "\n"); };
  expectRefused(course("radius = 3"), {"[driver.course]", "speed"});
  expectRefused(course("speed = 1\nradius = 0"), {"driver.course.radius = 0", "must not be 0"});
  expectRefused(course("speed = 1\nradius = 3\nx = [0, 1]\ny = [0, 1]"), {"radius", "remove one"});
  expectRefused(course("speed = 1\nx = [0, 1]\ny = [0]"), {"driver.course.y", "1 entries"});
  expectRefused(course("speed = 1\nx = [0]\ny = [0]"), {"only one corner"});
  expectRefused(course("speed = 1\nx = [0, 0]\ny = [1, 1]"), {"contain the same corner at entries 0 and 1"});
  expectRefused(course("speed = -1\nx = [0, 1]\ny = [1, 1]"), {"driver.course.speed = -1", "above 0 on a path"});
  expectRefused(withDriver("sprocket_speed = 1", "[driver.course]\nspeed = 1\n"), {"sprocket_speed", "remove one"});
  expectRefused(withDriver("drive = \"torque\"", "[driver.course]\nspeed = 1\n"), {"driver.drive", "course"});
  expectRefused(replaced(course("speed = 1"), "position = [1.5, 0]", "position = [1.5, 0]\nchassis = \"fixed\""),
                {"driver.course", "fixed"});
}

} // namespace
} // namespace grouser::setup
