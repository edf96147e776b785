// SPDX-License-Identifier: BSD-3-Clause
// Courses, engines and torques in complete runs: bitwise identical on any number of threads and resumed.
#include "coupling/simulation.hpp"
#include "coupling/vehicle_rig.hpp"
#include "runs/scene/scene.hpp"
#include "runs/scene/scene_file.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/setup/simulation_setup.hpp"
#include "tests/runs/shared_cache.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace grouser::coupling {
namespace {

void quietly(double, double) {}

scene::Scene sceneOf(const std::string& file, std::vector<std::string> overrides) {
  const std::vector<std::string> ramps = {"driver.tension_ramp=0.01", "driver.weight_ramp=0.01",
                                          "driver.drive_ramp=0.02", "driver.drive_start=0.02",
                                          "vehicle.sphere_radius=0.02"};
  overrides.insert(overrides.end(), ramps.begin(), ramps.end());
  return setup::loadScene(std::string(GROUSER_SOURCE_DIR) + "/tests/scenes/" + file, overrides);
}

/// A scene without sprocket speeds, from a copy of the file.
scene::Scene freed(const std::string& file, const std::vector<std::string>& overrides) {
  scene::Scene scene = sceneOf(file, {});
  std::string resolved = scene::resolvedToml(scene);
  const std::size_t at = resolved.find("sprocket_speed = "), end = resolved.find('\n', at);
  resolved.erase(at, end + 1 - at);
  return setup::parseScene(resolved, scene.file, overrides);
}

const std::vector<std::string> kCourse = {"driver.course.speed=1.0", "driver.course.acceleration=10",
                                          "driver.course.x=[1.0, 2.5, 4.0]", "driver.course.y=[0.1, 0.1, 0.4]"};
const std::vector<std::string> kEngine = {
    "driver.drive=engine",   "spec.engine.speed=[0, 300]",     "spec.engine.torque=[400, 300]",
    "spec.engine.ratio=20",  "spec.engine.governed_speed=250", "spec.engine.droop=10",
    "spec.engine.inertia=40"};

std::vector<std::string> both() {
  std::vector<std::string> all = kCourse;
  all.insert(all.end(), kEngine.begin(), kEngine.end());
  return all;
}

TEST(DriverModes, CourseByEnginesOnABedIsOneAnswerOnAnyThreadsAndResumed) {
  const scene::Scene scene = freed("coupled.toml", both());
  Simulation one(setup::simulationSetup(scene), base::cpuExec(1), quietly, {}, sharedBeds(), sharedSpheres());
  Simulation two(setup::simulationSetup(scene), base::cpuExec(2), quietly, {}, sharedBeds(), sharedSpheres());
  while (one.steps() < 700) one.step(), two.step();
  EXPECT_EQ(one.stateHash(), two.stateHash());
  const auto saved = one.save();
  ASSERT_TRUE(saved.vehicle);
  ASSERT_EQ(saved.vehicle->driver.size(), 3u);
  for (const double value : saved.vehicle->driver) EXPECT_NE(value, 0) << "there is state to carry over";
  Simulation resumed(setup::simulationSetup(scene), base::cpuExec(1), saved, {}, sharedSpheres());
  while (resumed.steps() < 1000) resumed.step(), one.step();
  EXPECT_EQ(resumed.stateHash(), one.stateHash());
  EXPECT_GT(one.vehicle()->observe().velocity.x, 0.02);
}

TEST(DriverModes, TorquesBeginWithTheDriveAndAreThoseThatAreGiven) {
  std::vector<std::string> overrides = {"driver.drive=torque", "driver.left_torque=3000", "driver.right_torque=1000"};
  Simulation s(setup::simulationSetup(freed("rigid.toml", overrides)), base::cpuExec(1), quietly, {}, sharedBeds(),
               sharedSpheres());
  while (s.time() < 0.0195) s.step();
  EXPECT_NEAR(s.vehicle()->observe().tracks[0].sprocketSpeed, 0, 1e-9) << "locked until then";
  while (s.time() < 0.1) s.step();
  const vehicle::Observation o = s.vehicle()->observe();
  EXPECT_NEAR(o.tracks[0].driveTorque, 3000, 1e-6);
  EXPECT_NEAR(o.tracks[1].driveTorque, 1000, 1e-6);
  EXPECT_GT(o.tracks[0].sprocketSpeed, 0);
}

} // namespace
} // namespace grouser::coupling
