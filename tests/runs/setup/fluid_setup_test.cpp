// SPDX-License-Identifier: BSD-3-Clause
// Setup of [fluid]: particles, markers, sound speed and step; errors, with place and
// remedy.
#include "base/error.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/fluid_bodies.hpp"
#include "runs/setup/fluid_setup.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/setup/simulation_setup.hpp"
#include "runs/setup/step_limit.hpp"
#include "tests/message_of.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace grouser::setup {
namespace {

using base::Vec3d;

std::string head(const std::string& run = {}) { return "version = 1\n[run]\nduration = 1.0\n" + run; }

std::string fluid(const std::string& more = "level = 0.5\n",
                  const std::string& tank = "tank_high = [1.0, 0.8, 1.0]\n") {
  return "[fluid]\nspacing = 0.1\ntank_low = [0.0, 0.0, 0.0]\n" + tank + more;
}

const char* const kWall =
    "[material.wall]\ndensity = 1000\nfoundation_modulus = 1e7\nrestitution = 0.3\nfriction = 0.3\n";

coupling::FluidDomainSetup made(const std::string& text) {
  const scene::Scene scene = parseScene(text, "fluid.toml");
  return *fluidSetup(scene, chooseTimeStep(scene));
}

TEST(FluidSetup, FillsTheTankBelowTheLevelAndBoxesOnce) {
  EXPECT_EQ(made(head() + fluid()).fluid.particles.size(), 10U * 8 * 5);
  const std::string box = "[[fluid.box]]\nlow = [0, 0, 0]\nhigh = [0.5, 0.8, 0.7]\nvelocity = [0.1, 0, 0]\n";
  const auto both = made(head() + fluid() + box);
  EXPECT_EQ(both.fluid.particles.size(), 10U * 8 * 5 + 5 * 8 * 2);
  EXPECT_EQ(both.fluid.particles.back().velocity.x, 0.1);
  EXPECT_EQ(made(head() + fluid("") + box + box).fluid.particles.size(), 5U * 8 * 7);
  const auto plane = made(head() + fluid("level = 0.5\ndimensions = 2\n"));
  EXPECT_EQ(plane.fluid.particles.size(), 50U);
  for (const fluid::FluidParticle& p : plane.fluid.particles) EXPECT_EQ(p.position.y, 0);
}

/// Markers are the places of the lattice within three spacings of the tank's inner faces.
TEST(FluidSetup, WallsAreThreeLayersThick) {
  const auto count = [](bool lid) {
    std::size_t all = 0;
    for (int i = -3; i < 13; ++i)
      for (int j = -3; j < 11; ++j)
        for (int k = -3; k < 13; ++k) {
          const auto beyond = [](int n, int places) { return std::max({0.0, -n - 0.5, n + 0.5 - places}); };
          const double x = beyond(i, 10), y = beyond(j, 8), z = lid || k < 0 ? beyond(k, 10) : 0;
          const double out = std::sqrt(x * x + y * y + z * z);
          all += out > 0 && out < 3;
        }
    return all;
  };
  EXPECT_EQ(made(head() + fluid()).fluid.markers.size(), count(false));
  EXPECT_EQ(made(head() + fluid("level = 0.5\nlid = true\n")).fluid.markers.size(), count(true));
}

/// A box in the tank replaces fluid and has markers; so does a plane.
TEST(FluidSetup, SurfacesOfTheSceneAreWalls) {
  const std::string box = std::string(kWall) +
                          "[[box]]\nposition = [0.5, 0.4, 0.15]\nsize = [0.2, 0.2, 0.3]\nmaterial = "
                          "\"wall\"\n";
  const auto with = made(head() + box + fluid());
  EXPECT_EQ(with.fluid.particles.size(), 400U - 2 * 2 * 3);
  EXPECT_EQ(with.fluid.markers.size(), made(head() + fluid()).fluid.markers.size() + 2 * 2 * 3);
  const std::string plane = std::string(kWall) + "[[plane]]\npoint = [0, 0, 0.2]\nmaterial = \"wall\"\n";
  EXPECT_EQ(made(head() + plane + fluid()).fluid.particles.size(), 400U - 10 * 8 * 2);
}

TEST(FluidSetup, SoundSpeedAndStepFollowFromTheDepth) {
  const scene::Scene scene = parseScene(head() + fluid(), "fluid.toml");
  const double speed = 10 * std::sqrt(2 * 9.81 * 0.5);
  EXPECT_NEAR(fluidModel(scene).soundSpeed, speed, 1e-9);
  EXPECT_NEAR(chooseTimeStep(scene), 0.25 * 0.13 / (1.1 * speed), 1e-9);
  EXPECT_NEAR(fluidModel(parseScene(head() + fluid("level = 0.5\nexpected_speed = 5\n"), "f.toml")).soundSpeed, 50,
              1e-9);
}

/// Each marker of a sphere, cylinder or box represents a cube of the spacing: as many as fit into the shape's layers.
TEST(FluidBodies, MarkersFillTheLayersOfAShape) {
  coupling::BodyShape s;
  const double dx = 0.02, depth = 3 * dx, r = 0.2;
  const auto count = [&] { return static_cast<double>(shapeMarkers(s, dx, depth).size()) * dx * dx * dx; };
  s.shape = {contact::SurfaceShape::capsule, {r, 0, 0}};
  const double in = r - depth, ball = 4.18879 * (r * r * r - in * in * in);
  EXPECT_NEAR(count() / ball, 1, 0.01);
  s.shape = {contact::SurfaceShape::cylinder, {r, 0, 0.3}};
  EXPECT_NEAR(count() / (3.14159 * (r * r * 0.6 - in * in * 0.48)), 1, 0.01);
  s.shape = {contact::SurfaceShape::box, {0.11, 0.2, 0.3}};
  EXPECT_NEAR(count() / (0.22 * 0.4 * 0.6 - 0.1 * 0.28 * 0.48), 1, 0.03);
  for (const Vec3d& p : shapeMarkers(s, dx, depth)) EXPECT_LT(distanceFrom(s, p), -0.4 * dx);
}

/// The number of particles beside a rotated box follows from the volume; none is nearer than half a spacing.
TEST(FluidBodies, ParticlesKeepOffTurnedBodies) {
  const std::string text =
      head() + kWall + fluid("level = 0.9\n", "tank_high = [2.0, 2.0, 1.0]\n") +
      "[[body]]\nname = \"b\"\nmass = 100\nmaterial = \"wall\"\nposition = [1, 1, 0.45]\naxis = [0, "
      "0, 1]\nangle = 30\n[[body.shape]]\nkind = \"box\"\nsize = [0.8, 0.8, 0.5]\n";
  const scene::Scene scene = parseScene(text, "fluid.toml");
  const auto setup = *fluidSetup(scene, 1e-4);
  const StartingBodies bodies(scene);
  EXPECT_NEAR(static_cast<double>(setup.fluid.particles.size()) * 1e-3, 2 * 2 * 0.9 - 0.8 * 0.8 * 0.5, 0.04);
  for (const fluid::FluidParticle& p : setup.fluid.particles) EXPECT_GT(bodies.fromBodies(p.position, 1), 0.0499);
}

const std::string kBench = "[vehicle]\nspec = \"" GROUSER_SOURCE_DIR
                           "/assets/vehicles/light_tracked.toml\"\nchassis = \"fixed\"\ntracks = \"single\"\n";
const std::string kBenchTank = "[fluid]\nspacing = 0.06\ntank_low = [-0.9, -1.5, -0.3]\ntank_high = [3.6, 1.5, 0.9]\n"
                               "level = 0.3\n";

/// Hull, 46 shoes, sprocket, wheels, rollers and idler have markers; no particle starts inside or in repulsion range.
TEST(FluidBodies, WaterStandsAroundAVehicle) {
  const scene::Scene scene = parseScene(head() + kBench + kBenchTank, "fluid.toml");
  const auto setup = *fluidSetup(scene, 1e-4);
  ASSERT_EQ(setup.bodies.size(), 1U + 46 + 1 + 5 + 3 + 1);
  const StartingBodies bodies(scene);
  EXPECT_EQ(setup.bodies.front().column, "vehicle/hull");
  EXPECT_EQ(setup.bodies.back().column, "vehicle/left_track");
  EXPECT_EQ(setup.bodies.back().about, 0U);
  std::vector<Vec3d> markers;
  for (const coupling::BodyInFluid& b : setup.bodies)
    for (const Vec3d& p : b.markers) markers.push_back(bodies.pose(b.body).toWorld(p));
  for (const Vec3d& p : markers) EXPECT_LT(bodies.fromVehicle(p, 1), 1e-9);
  const std::size_t alone = made(head() + kBenchTank).fluid.particles.size();
  EXPECT_LT(setup.fluid.particles.size(), alone - 1000);
  EXPECT_GT(setup.fluid.particles.size(), alone - 6000);
  for (const fluid::FluidParticle& p : setup.fluid.particles) {
    ASSERT_GT(bodies.fromVehicle(p.position, 1), 0.0299);
    for (const Vec3d& m : markers) ASSERT_GT(norm2(p.position - m), 0.05 * 0.05);
  }
}

/// The upper run of a track moves at twice its speed.
TEST(FluidSetup, SoundSpeedFollowsFromTheDriver) {
  const auto model = [](const std::string& driver) {
    return fluidModel(parseScene(head() + kBench + driver + kBenchTank, "fluid.toml"));
  };
  EXPECT_NEAR(model("").soundSpeed, 10 * std::sqrt(2 * 9.81 * 0.6), 1e-9);
  EXPECT_NEAR(model("[driver]\nsprocket_speed = 10\ndrive_start = 0.5\n").soundSpeed, 10 * 2 * 10 * 0.2451, 0.01);
}

/// A vehicle's contacts require shorter steps than the fluid, which then takes one step per several.
TEST(FluidSetup, TheFluidStepsOnceInSeveral) {
  const auto steps = [](double timeStep) {
    return *fluidSetup(parseScene(head() + kBench + kBenchTank, "fluid.toml"), timeStep);
  };
  const double longest = fluidStepLimits(parseScene(head() + kBench + kBenchTank, "fluid.toml")).least();
  EXPECT_EQ(steps(longest / 7).stepsPerStep, 7);
  EXPECT_NEAR(steps(longest / 7).fluid.model.timeStep, longest, 1e-12);
  EXPECT_EQ(steps(longest / 6.5).stepsPerStep, 6);
  EXPECT_EQ(steps(1.5 * longest).stepsPerStep, 1);
  EXPECT_EQ(steps(1.5 * longest).fluid.model.timeStep, 1.5 * longest);
}

std::string messageOf(const std::string& text) {
  return test::messageOf([&] { simulationSetup(parseScene(text, "fluid.toml")); });
}

TEST(FluidSetup, RefusesWhatIsNoFluid) {
  const std::string box = "[[fluid.box]]\nlow = [0, 0, 0]\nhigh = ";
  const std::string body = std::string(kWall) +
                           "[[body]]\nname = \"b\"\nmaterial = \"wall\"\nmass = 1\nposition = [0.5, 0.4, "
                           "0.8]\n";
  const std::string probe = "[[fluid.probe]]\nposition = [0, 0, 0]\nname = ";
  const std::vector<std::pair<std::string, std::string>> all = {
      {fluid(""), "fluid.level is missing and there is no [[fluid.box]]"},
      {"[fluid]\nlevel = 1\n", "lacks the required key spacing"},
      {"[fluid]\nspacing = 0.1\nlevel = 1\n", "has no tank; set tank_low and tank_high"},
      {"[fluid]\nspacing = 0.1\nlevel = 1\ntank_low = [0, 0, 0]\n", "requires tank_high"},
      {fluid("level = 0.5\n", "tank_high = [1, 0.3, 1]\n"), "above the lower corner along y (minimum 0.4 m)"},
      {fluid("level = 1.5\n"), "is outside the tank, z in [0, 1] m"},
      {fluid("level = 0.5\nspacing = 0\n"), "spacing"},
      {fluid("level = 0.5\ndensity = -1\n"), "density"},
      {fluid("level = 0.5\nviscosity = -1\n"), "viscosity"},
      {fluid("level = 0.5\ndimensions = 1\n"), "dimensions"},
      {fluid("level = 0.5\nsmoothing = 0.9\n"), "smoothing"},
      {fluid("level = 0.5\ndiffusion = 2\n"), "diffusion"},
      {fluid("level = 0.5\nsound_speed = 3\n"), "too low for this depth and flow speed; use at least"},
      {fluid("level = 0.5\nsound_speed = 30\nexpected_speed = 2\n"), "has no effect with sound_speed"},
      {fluid("level = 0.5\nsalt = 3\n"), "salt"},
      {fluid("level = \"high\"\n"), "level"},
      {fluid("") + box + "[0.5, 0.8, 0.05]\n", "is only 0.05 m above the lower corner along z"},
      {fluid("") + box + "[0.5, 0.9, 0.5]\n", "is outside the tank along y, [0, 0.8] m"},
      {fluid() + probe + "\"a/b\"\n", "use only letters, digits, _ and -"},
      {fluid() + probe + "\"p\"\n" + probe + "\"p\"\n", "is the name of another probe"},
      {fluid() + probe + "\"p\"\nkind = \"speed\"\n", "kind"},
      {fluid() + body, "no body has a shape"},
      {fluid() + body + "[[body.shape]]\nkind = \"sphere\"\nradius = 0.03\n", "less than fluid.spacing = 0.1 m"},
      {fluid("level = 0.5\ndimensions = 2\n") + body + "[[body.shape]]\nkind = \"sphere\"\nradius = 0.1\n",
       "must be a box aligned with the x-z plane"},
      {fluid() + kWall +
           "[[box]]\nposition = [0.5, 0.4, 0.2]\nsize = [0.2, 0.2, 0.2]\nmaterial = \"wall\"\nvelocity = [1, "
           "0, 0]\n",
       "use a [[body]] with a [[drive]]"},
      {fluid() + "[material.sand]\nstiffness = 1e4\nrestitution = 0.5\n[[grain]]\nposition = [0.5, 0.4, 0.9]\nradius = "
                 "0.01\nmaterial = \"sand\"\n",
       "is incompatible with grains, since their drag and buoyancy"},
      {fluid("level = 0.5\ndimensions = 2\n") + kBench, "= 2 is incompatible with vehicle; use 3"},
      {"[fluid]\nspacing = 0.3\nlevel = 0.3\ntank_low = [-3, -3, -3]\ntank_high = [6, 3, 3]\n" + kBench,
       "so it contains no markers"},
      {kBenchTank + kBench + kWall +
           "[[body]]\nname = \"b\"\nmaterial = \"wall\"\nmass = 10\nposition = [-1, 0, "
           "1.5]\n[[body.shape]]\nkind = \"sphere\"\nradius = 0.2\n[[spring]]\nname = "
           "\"s\"\nbodies = [\"vehicle\", \"b\"]\nstiffness = 1000\n",
       "is connected to the vehicle, which [fluid] does not support"},
  };
  for (const auto& [text, says] : all) {
    const std::string message = messageOf(head() + text);
    EXPECT_NE(message.find(says), std::string::npos) << text << "\n-> " << message;
    EXPECT_EQ(message.rfind("fluid.toml:", 0), 0U) << message;
  }
  EXPECT_NE(messageOf(head("time_step = 0.01\n") + fluid()).find("is above the stability limit"), std::string::npos);
}

} // namespace
} // namespace grouser::setup
