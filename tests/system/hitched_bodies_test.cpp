// SPDX-License-Identifier: BSD-3-Clause
// Bodies beside a vehicle: joints to it, contacts with its ground and its parts, identical results.
#include "base/error.hpp"
#include "coupling/simulation.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/setup/simulation_setup.hpp"
#include "tests/message_of.hpp"
#include "tests/runs/shared_cache.hpp"
#include "tests/system/scene_simulation.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace grouser::coupling::hitched {
namespace {

using base::Vec3d;

constexpr double kGravity = 9.81, kCart = 200, kWheel = 20; // [m/s2], [kg]

/// A vehicle on rigid ground.
std::string vehicleAlone(const std::string& ground = "kind = \"rigid\"", const std::string& run = {}) {
  return "version = 1\n[run]\nduration = 3.0\n" + run +
         "\n[material.ground]\nfriction = 0.8\nrestitution = 0.3\n[material.rubber]\nfriction = 0.8\n"
         "restitution = 0.3\nfoundation_modulus = 2e8\n[terrain]\nmaterial = \"ground\"\nsize = [9, "
         "3]\nheightmap = \"heightmaps/flat.png\"\nheight_range = [-0.128, 0.127]\n" +
         ground +
         "\n[vehicle]\nspec = \"vehicles/light_tracked.toml\"\nposition = [3, 0]\nsphere_radius = 0.02\n"
         "[driver]\nsprocket_speed = 1.5\ndrive_start = 0.6\ndrive_ramp = 0.2\n";
}

/// The vehicle with a cart of two wheels on a ball joint behind its hull.
std::string tow(const std::string& more = {}, const std::string& ground = "kind = \"rigid\"",
                const std::string& run = {}) {
  std::string text = vehicleAlone(ground, run);
  text += fmt::format("[[body]]\nname = \"cart\"\nmass = {}\nbox = [1, 1, 0.3]\nposition = [1.4, 0, 0.5]\nmaterial = "
                      "\"rubber\"\n[[body.shape]]\nkind = \"box\"\nsize = [1, 1, 0.3]\n",
                      kCart);
  for (const auto& [name, y] : {std::pair("left", 0.6), std::pair("right", -0.6)})
    text += fmt::format("[[body]]\nname = \"{0}\"\nmass = {2}\ninertia = [0.4, 0.625, 0.4]\nposition = [1.3, {1}, "
                        "0.25]\nmaterial = \"rubber\"\n[[body.shape]]\nkind = \"cylinder\"\nradius = 0.25\nlength = "
                        "0.15\naxis = [0, 1, 0]\n[[joint]]\nname = \"{0}_axle\"\ntype = \"revolute\"\nbodies = "
                        "[\"cart\", \"{0}\"]\npoint = [1.3, {1}, 0.25]\naxis = [0, 1, 0]\n",
                        name, y, kWheel);
  return text +
         "[[joint]]\nname = \"hitch\"\ntype = \"spherical\"\nbodies = [\"vehicle\", \"cart\"]\npoint = [2.4, 0, "
         "0.45]\n" +
         more;
}

std::unique_ptr<Simulation> made(const std::string& text) {
  return std::make_unique<Simulation>(
      setup::simulationSetup(setup::parseScene(text, "tow.toml")), base::cpuExec(1), [](double, double) {},
      base::Comm{}, nullptr, sharedSpheres());
}
/// Poses of the bodies beside the vehicle: cart, left and right wheel.
const base::Pose& bodyOf(const Simulation& s, std::size_t k) {
  return s.vehicle()->state().pose[s.setup().mechanism->ofVehicle.bodies + k];
}

TEST(HitchedBodies, CartFollowsAndACrateIsPushed) {
  // A crate in front of the tracks.
  const std::string crate = "[[body]]\nname = \"crate\"\nmass = 300\nbox = [0.4, 2.4, 0.6]\nposition = [6.35, 0, 0.3]\n"
                            "material = \"rubber\"\n[[body.shape]]\nkind = \"box\"\nsize = [0.4, 2.4, 0.6]\n";
  const auto s = made(tow(crate));
  const auto hull = [&] { return s->vehicle()->state().pose[0].position.x; };
  advanceTo(*s, 0.7);
  s->restartMeans();
  const double cart = bodyOf(*s, 0).position.x, pushed = bodyOf(*s, 3).position.x, before = hull();
  advanceTo(*s, 1.7);
  const double way = hull() - before;
  EXPECT_GT(way, 0.15);
  EXPECT_NEAR(bodyOf(*s, 0).position.x - cart, way, 0.05) << "the hull pitches at the crate";
  EXPECT_GT(bodyOf(*s, 3).position.x - pushed, 0.03);
  // Wheels and hitch carry the cart's weight.
  const std::size_t first = s->setup().mechanism->ofVehicle.bodies;
  const auto force = s->vehicle()->contactForces();
  const double wheels = force[first + 1].z + force[first + 2].z;
  const double hitch = s->vehicle()->solver().reactions(s->vehicle()->state()).back().force.z;
  EXPECT_EQ(force[first], Vec3d{}) << "the cart has no contacts";
  EXPECT_NEAR(wheels + hitch, (kCart + 2 * kWheel) * kGravity, 0.2 * kCart * kGravity);
  // Contacts between vehicle and crate cancel: the total is the weight.
  double all = 0;
  for (const Vec3d& f : force) all += f.z;
  const double weight = (s->vehicle()->assembly().mass + kCart + 2 * kWheel + 300) * kGravity;
  EXPECT_NEAR(all, weight, 0.02 * weight);
}

TEST(HitchedBodies, HaveOneAnswerWhenResumed) {
  const std::string text = tow();
  const auto straight = made(text), first = made(text);
  advanceTo(*straight, 0.05), advanceTo(*first, 0.03);
  Simulation resumed(setup::simulationSetup(setup::parseScene(text, "tow.toml")), base::cpuExec(2), first->save(), {},
                     sharedSpheres());
  EXPECT_EQ(resumed.stateHash(), first->stateHash());
  advanceTo(resumed, 0.05);
  EXPECT_EQ(resumed.stateHash(), straight->stateHash());
}

TEST(HitchedBodies, AJointFromTheVehicleToTheWorldIsRefused) {
  const std::string joint =
      "[[joint]]\nname = \"tether\"\ntype = \"spherical\"\nbodies = [\"world\", \"cart\"]\npoint = "
      "[1, 0, 0.5]\n";
  EXPECT_NE(test::messageOf([&] {
              setup::parseScene(tow(joint), "tow.toml");
            }).find("connect the vehicle rigidly to the world"),
            std::string::npos);
  EXPECT_NE(test::messageOf([&] {
              setup::parseScene(
                  tow("[[joint]]\nname = \"pin\"\ntype = \"spherical\"\nbodies = [\"vehicel\", \"cart\"]\n"
                      "point = [1, 0, 0.5]\n"),
                  "tow.toml");
            }).find("did you mean \"vehicle\"?"),
            std::string::npos);
  for (const char* word : {"chassis", "hull"})
    EXPECT_NE(test::messageOf([&] {
                setup::parseScene(tow(fmt::format("[[spring]]\nname = \"s\"\nbodies = [\"{}\", \"cart\"]\n"
                                                  "stiffness = 100\nfree_position = 0.1\n",
                                                  word)),
                                  "tow.toml");
              }).find("did you mean \"vehicle\"?"),
              std::string::npos)
        << word;
}

// Momentum of the vehicle = impulses of its weight, of the ground, and of the spring, F = k (L - L0) along the spring.
TEST(HitchedBodies, ASpringTiesTheVehicleToTheWorldWithoutOtherBodies) {
  constexpr double kStiffness = 100, kFree = 0.1, kTime = 0.05; // [N/m], [m], [s]
  const auto s = made(vehicleAlone() + fmt::format("[[spring]]\nname = \"tether\"\nbodies = [\"world\", \"vehicle\"]\n"
                                                   "point_a = [0, 0, 0.2]\nstiffness = {}\nfree_position = {}\n",
                                                   kStiffness, kFree));
  ASSERT_EQ(s->setup().mechanism->model.pointSprings().size(), 1u);
  const auto pull = [&] {
    const Vec3d arm = Vec3d{0, 0, 0.2} - s->vehicle()->state().pose[0].position;
    return arm * (kStiffness * (norm(arm) - kFree) / norm(arm));
  };
  advanceTo(*s, 0.5);
  s->restartMeans();
  const Vec3d before = s->ledger().momentum, pullBefore = pull();
  const double start = s->time();
  advanceTo(*s, start + kTime); // before the drive starts
  Vec3d ground{};
  for (const Vec3d& f : s->vehicle()->contactForces()) ground += f;
  const Vec3d gained = (s->ledger().momentum - before) * (1 / (s->time() - start)),
              spring = (pullBefore + pull()) * 0.5;
  const double weight = s->vehicle()->assembly().mass * kGravity;
  EXPECT_LT(spring.x, -200);
  EXPECT_NEAR(gained.x, ground.x + spring.x, 0.01 * std::fabs(spring.x));
  EXPECT_NEAR(gained.z, ground.z + spring.z - weight, 0.001 * weight);
}

TEST(HitchedBodies, PartsWithoutAnyBodyAreRefused) {
  const auto refusal = [](const std::string& part) {
    return test::messageOf([&] { setup::parseScene(part, "tow.toml"); });
  };
  const std::string rigid = "[[joint]]\nname = \"pin\"\ntype = \"spherical\"\nbodies = [\"world\", \"vehicle\"]\n"
                            "point = [3, 0, 0.3]\n";
  EXPECT_NE(refusal(vehicleAlone() + rigid).find("connect the vehicle rigidly to the world"), std::string::npos);
  const std::string spring = "[[spring]]\nname = \"s\"\nbodies = [\"world\", \"hull\"]\nstiffness = 1\n";
  EXPECT_NE(refusal(vehicleAlone() + spring).find("did you mean \"vehicle\"?"), std::string::npos);
  EXPECT_NE(refusal("version = 1\n[run]\nduration = 1\n" + spring).find("unknown body \"hull\""), std::string::npos);
}

TEST(HitchedBodies, ABodyInsideTheVehicleIsRefused) {
  const std::string crate = "[[body]]\nname = \"crate\"\nmass = 50\nposition = [4, 0.9, 0.3]\nmaterial = \"rubber\"\n"
                            "[[body.shape]]\nkind = \"box\"\nsize = [0.3, 0.3, 0.5]\n";
  const std::string message = test::messageOf([&] { made(tow(crate)); });
  EXPECT_NE(message.find("body \"crate\" overlaps the "), std::string::npos) << message;
}

} // namespace
} // namespace grouser::coupling::hitched
