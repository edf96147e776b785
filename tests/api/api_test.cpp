// SPDX-License-Identifier: BSD-3-Clause
#include <grouser/grouser.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace grouser {
namespace {

namespace fs = std::filesystem;

const char* kFall = "version = 1\n[run]\nduration = 0.1\ntime_step = 1e-3\n[material.glass]\nstiffness = 1e3\n"
                    "[[plane]]\nmaterial = \"glass\"\n"
                    "[[grain]]\nposition = [0, 0, 1]\nradius = 0.01\nmaterial = \"glass\"\n"
                    "[[grain]]\nposition = [1, 0, 2]\nradius = 0.01\nmaterial = \"glass\"\n";

Scene vehicleScene() {
  Scene scene = Scene::fromFile(std::string(GROUSER_SOURCE_DIR) + "/tests/scenes/rigid.toml");
  scene.set("vehicle.sphere_radius", 0.03).set("driver.tension_ramp", 0.02).set("driver.weight_ramp", 0.02);
  return scene.set("driver.drive_start", 0.04).set("driver.drive_ramp", 0.01).set("output.plots", false);
}

class Api : public testing::Test {
protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("grouser_api_" + std::to_string(getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  fs::path folder_;
};

TEST_F(Api, GrainsFallAsFast) {
  Simulation simulation(Scene::fromText(kFall));
  EXPECT_EQ(simulation.grainCount(), 2u);
  simulation.step(100);
  EXPECT_NEAR(simulation.time(), 0.1, 1e-12);
  const Grains grains = simulation.grains();
  ASSERT_EQ(grains.position.size(), 2u);
  EXPECT_NEAR(grains.velocity[2], -0.981, 1e-6);
  EXPECT_NEAR(grains.position[1].z, 2 - 9.81 * 1e-6 * 100 * 101 / 2, 1e-9); // symplectic Euler
  EXPECT_EQ(grains.radius[0], 0.01f);
  std::vector<Vec3> places(simulation.ownGrainCount());
  simulation.readPositions(places);
  EXPECT_EQ(places[1].z, grains.position[1].z);
  EXPECT_THROW(simulation.readPositions({places.data(), 1}), InputError);
}

TEST_F(Api, AVehicleIsReadAndSteered) {
  Simulation simulation(vehicleScene());
  Vehicle vehicle = simulation.vehicle();
  EXPECT_EQ(vehicle.shoes(), 46);
  simulation.step(600);
  vehicle.setSprocketSpeed(2, 3);
  simulation.step(100);
  const VehicleState now = vehicle.state();
  EXPECT_NEAR(now.left.sprocketSpeed, 2, 1e-9);
  EXPECT_NEAR(now.right.sprocketSpeed, 3, 1e-9);
  EXPECT_EQ(now.left.tension.size(), 46u);
  EXPECT_NEAR(now.groundForce.z, 9.81 * vehicle.mass(), 0.3 * 9.81 * vehicle.mass());
  EXPECT_THROW(vehicle.setThrottle(1, 1), InputError);
  // Neither changes if one is invalid.
  const std::string before = simulation.hash();
  EXPECT_THROW(vehicle.setSprocketSpeed(1, 1e9), InputError);
  EXPECT_EQ(simulation.hash(), before);
}

TEST_F(Api, AStateIsSavedAndRestored) {
  Simulation simulation(vehicleScene());
  simulation.step(450);
  simulation.vehicle().setSprocketSpeed(2, 2);
  simulation.step(50);
  simulation.save(folder_ / "state.h5");
  simulation.step(100);
  const std::string straight = simulation.hash();
  simulation.restore(folder_ / "state.h5");
  EXPECT_EQ(simulation.steps(), 500);
  simulation.step(100);
  EXPECT_EQ(simulation.hash(), straight);
  Options two;
  two.threads = 2;
  Simulation resumed = Simulation::resumed(vehicleScene(), folder_ / "state.h5", two);
  resumed.step(100);
  EXPECT_EQ(resumed.hash(), straight);
  EXPECT_THROW(Simulation::resumed(vehicleScene().set("vehicle.clearance", 0.02), folder_ / "state.h5"), InputError);
}

TEST_F(Api, SeveralSimulationsRunAtOnceAndAlike) {
  std::vector<std::string> hashes(3);
  std::vector<std::thread> threads;
  for (std::string& hash : hashes)
    threads.emplace_back([&hash] {
      Options one;
      one.threads = 1;
      Simulation simulation(Scene::fromText(kFall), one);
      simulation.step(50);
      simulation.setGravity({0, 0, -1});
      simulation.step(50);
      hash = simulation.hash();
    });
  for (std::thread& t : threads) t.join();
  EXPECT_EQ(hashes[0], hashes[1]);
  EXPECT_EQ(hashes[0], hashes[2]);
}

TEST_F(Api, AFolderHoldsWhatARunLeavesAndTheInputs) {
  Options options;
  options.folder = folder_ / "out";
  std::string hash;
  {
    Simulation simulation(vehicleScene(), options);
    simulation.step(500);
    simulation.vehicle().setSprocketSpeed(2, 1);
    simulation.step(100);
    hash = simulation.hash();
    simulation.finish();
    EXPECT_THROW(simulation.step(), InputError);
  }
  for (const char* name : {"results.h5", "timeseries.csv", "scene.toml", "manifest.json", "checkpoint.h5"})
    EXPECT_TRUE(fs::exists(options.folder / name)) << name;
  std::ifstream manifest(options.folder / "manifest.json");
  const std::string said{std::istreambuf_iterator<char>(manifest), {}};
  EXPECT_NE(said.find("ground_force_most_over_weight"), std::string::npos) << said;
  EXPECT_THROW(Simulation(vehicleScene(), options), InputError); // the folder is not empty
  Simulation again = Simulation::resumed(vehicleScene(), options.folder / "checkpoint.h5");
  EXPECT_EQ(again.hash(), hash);
}

TEST_F(Api, WhatIsWrongIsAnErrorOfItsType) {
  EXPECT_THROW(Scene::fromFile("nowhere.toml"), InputError);
  Scene scene = Scene::fromText(kFall);
  try {
    scene.set("run.duratoin", 2.0);
    FAIL() << "an unknown key was accepted";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("duration"), std::string::npos) << error.what();
  }
  EXPECT_EQ(scene.duration(), 0.1); // unchanged
  Simulation simulation(scene);
  EXPECT_FALSE(simulation.hasVehicle());
  EXPECT_THROW(simulation.vehicle(), InputError);
  EXPECT_THROW(simulation.step(0), InputError);
  EXPECT_THROW(simulation.setLoad("hull", {1, 0, 0}), InputError);
  // A grain falls 1 m onto so soft a plane that it penetrates: SimulationError, and the state remains readable.
  Simulation unsound(Scene::fromText(kFall));
  EXPECT_THROW(unsound.step(2000), SimulationError);
  EXPECT_EQ(unsound.grains().position.size(), 2u);
  EXPECT_THROW(unsound.step(), InputError) << "the simulation has failed";
  unsound.finish(); // nothing to do
  EXPECT_THROW(simulation.stepFor(std::nan("")), InputError);
  EXPECT_THROW(simulation.step(std::numeric_limits<std::int64_t>::max()), InputError);
}

TEST_F(Api, AskedOnTheWayAStepMayEndEarly) {
  Simulation simulation(Scene::fromText(kFall).set("run.time_step", 1e-5));
  int asked = 0;
  simulation.step(1'000'000, [&] { return ++asked < 2; });
  EXPECT_EQ(asked, 2);
  EXPECT_LT(simulation.steps(), 1'000'000);
}

TEST_F(Api, SeveralThreadsWriteFoldersAtOnce) {
  std::vector<std::string> hashes(4);
  std::vector<std::thread> threads;
  for (std::size_t i = 0; i < hashes.size(); ++i)
    threads.emplace_back([&, i] {
      Options one;
      one.threads = 1, one.folder = folder_ / std::to_string(i);
      Simulation simulation(Scene::fromText(kFall).set("run.output_interval", 1e-3).set("output.plots", false), one);
      simulation.step(100);
      hashes[i] = simulation.hash();
      simulation.finish();
    });
  for (std::thread& t : threads) t.join();
  for (std::size_t i = 1; i < hashes.size(); ++i) EXPECT_EQ(hashes[i], hashes[0]);
}

TEST_F(Api, ARunGoesOnInItsFolderOrInAnotherOne) {
  Options options;
  options.folder = folder_ / "first";
  const fs::path checkpoint = options.folder / "checkpoint.h5";
  {
    Simulation first(vehicleScene(), options);
    first.step(500);
    first.finish();
  }
  Options elsewhere;
  elsewhere.folder = folder_ / "second";
  std::string hash;
  {
    Simulation second = Simulation::resumed(vehicleScene(), checkpoint, elsewhere);
    second.step(50);
    hash = second.hash();
    second.finish();
  }
  Simulation again = Simulation::resumed(vehicleScene(), checkpoint, options);
  EXPECT_THROW(Simulation::resumed(vehicleScene(), checkpoint, options), InputError) << "two simulations in one folder";
  again.step(50);
  EXPECT_EQ(again.hash(), hash);
  again.finish();
  // A branch with another drive.
  Simulation branch = Simulation::resumed(vehicleScene().set("driver.sprocket_speed", 3), checkpoint);
  branch.step(100);
  EXPECT_NE(branch.hash(), hash);
}

TEST_F(Api, ARestoreThatIsRefusedChangesNothing) {
  Simulation simulation(vehicleScene());
  simulation.step(10);
  Simulation other(vehicleScene().set("vehicle.clearance", 0.02));
  other.save(folder_ / "other.h5");
  const std::string before = simulation.hash();
  EXPECT_THROW(simulation.restore(folder_ / "other.h5"), InputError);
  EXPECT_THROW(simulation.restore(folder_ / "none.h5"), InputError);
  EXPECT_EQ(simulation.hash(), before);
  simulation.step(1);
}

TEST_F(Api, AFolderIsRefusedBeforeTheBedSettles) {
  Options options;
  options.folder = folder_;
  std::ofstream(folder_ / "mine.txt") << "kept";
  options.settling = [](double, double) { FAIL() << "unexpected settling"; };
  EXPECT_THROW(Simulation(Scene::fromFile(std::string(GROUSER_SOURCE_DIR) + "/tests/scenes/coupled.toml"), options),
               InputError);
  EXPECT_TRUE(fs::exists(folder_ / "mine.txt"));
}

TEST_F(Api, OfThrottleAndSpeedTheLastOneCounts) {
  Scene scene = vehicleScene();
  scene.set("driver.drive", "engine").set("spec.engine.speed", std::vector<double>{0, 300});
  scene.set("spec.engine.torque", std::vector<double>{400, 300}).set("spec.engine.ratio", 20);
  scene.set("spec.engine.governed_speed", 250).set("spec.engine.droop", 10).set("spec.engine.inertia", 40);
  Simulation simulation(scene);
  simulation.step(600);
  Vehicle vehicle = simulation.vehicle();
  vehicle.setSprocketSpeed(2, 2);
  const std::string speed = simulation.hash();
  vehicle.setThrottle(0.5, 0.5);
  EXPECT_NE(simulation.hash(), speed);
  vehicle.setSprocketSpeed(2, 2);
  EXPECT_EQ(simulation.hash(), speed);
}

TEST_F(Api, SeveralKeysAreSetTogether) {
  Scene scene = Scene::fromText(kFall);
  EXPECT_THROW(scene.set("source.low", std::vector<double>{0, 0, 3}), InputError) << "the source lacks other keys";
  scene.set({"run.duration=0.2", "run.time_step=2e-4"});
  EXPECT_EQ(scene.duration(), 0.2);
  EXPECT_THROW(scene.set({"run.duration=0.3", "run.time_stp=1e-4"}), InputError);
  EXPECT_EQ(scene.duration(), 0.2) << "all or none";
  EXPECT_EQ(Simulation(scene).timeStep(), 2e-4);
}

TEST_F(Api, SaysWhatMaySurprise) {
  Options one;
  one.threads = 1;
  Scene scene = vehicleScene();
  scene.set("vehicle.gear_contact_model", "samples"); // its shoes are cut into spheres
  const std::vector<std::string> warnings = warningsOf(Simulation(scene, one));
  const auto has = [&](const char* words) {
    return std::any_of(warnings.begin(), warnings.end(),
                       [&](const std::string& w) { return w.find(words) != std::string::npos; });
  };
  EXPECT_TRUE(has("spheres of shoe.obj protrude"));
}

TEST_F(Api, AStepWithinAStepIsRefusedAndHarmsNothing) {
  Simulation simulation(Scene::fromText(kFall));
  bool refused = false;
  simulation.step(10, [&] {
    try {
      simulation.step();
    } catch (const InputError&) {
      refused = true;
    }
    return true;
  });
  EXPECT_TRUE(refused);
  simulation.step();
  EXPECT_EQ(simulation.steps(), 11);
}

TEST_F(Api, KeepGoingMaySetAndSaveAndWhatItThrowsHarmsNothing) {
  Options options;
  options.folder = folder_ / "kept";
  Simulation simulation(vehicleScene(), options);
  const auto thrower = [&]() -> bool {
    simulation.setGravity({0, 0, -9});
    simulation.save(folder_ / "within.h5");
    throw std::logic_error("the caller's own");
  };
  EXPECT_THROW(simulation.step(100, thrower), std::logic_error);
  EXPECT_TRUE(fs::exists(folder_ / "within.h5"));
  simulation.step(10);
  std::ifstream manifest(options.folder / "manifest.json");
  const std::string said{std::istreambuf_iterator<char>(manifest), {}};
  EXPECT_NE(said.find("\"status\": \"running\""), std::string::npos) << said;
}

TEST_F(Api, WhatHasFailedOrEndedSaysSo) {
  Simulation unsound(Scene::fromText(kFall));
  std::string cause;
  try {
    unsound.step(2000);
  } catch (const SimulationError& error) {
    cause = error.what();
  }
  for (const auto& call :
       std::vector<std::function<void()>>{[&] { unsound.step(); }, [&] { unsound.save(folder_ / "x.h5"); },
                                          [&] {
                                            unsound.setGravity({0, 0, -1});
                                          }})
    try {
      call();
      FAIL();
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(cause), std::string::npos) << error.what();
    }
  Simulation ended(Scene::fromText(kFall));
  ended.finish();
  EXPECT_THROW(ended.setGravity({0, 0, -1}), InputError);
  EXPECT_THROW(ended.save(folder_ / "no/such.h5"), InputError);
}

TEST_F(Api, ARunThatIsLeftIsStoppedAndSaysHowFarItCame) {
  Options options;
  options.folder = folder_ / "left";
  {
    Simulation simulation(vehicleScene(), options);
    simulation.step(50);
  }
  std::ifstream manifest(options.folder / "manifest.json");
  const std::string said{std::istreambuf_iterator<char>(manifest), {}};
  EXPECT_NE(said.find("\"status\": \"stopped\""), std::string::npos) << said;
  EXPECT_NE(said.find("\"steps_taken\": \"50\""), std::string::npos) << said;
}

} // namespace
} // namespace grouser
