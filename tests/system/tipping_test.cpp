// SPDX-License-Identifier: BSD-3-Clause
// A vehicle on a side slope with enough friction to tip rather than slide: the critical slope follows from its
// geometry.
#include "coupling/simulation.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/setup/simulation_setup.hpp"
#include "tests/device_under_test.hpp"
#include "tests/runs/shared_cache.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace grouser::coupling {
namespace {

using base::Vec3d;

constexpr double kEarth = 9.81; // [m/s2]

/// On rigid arms, sprockets locked, left side uphill: gravity is inclined to the right by `angle` [rad]. Shoes have
/// friction on ground and wheels: at the friction of a shipped vehicle's wheels, 0.35, the hull slides to the shoes'
/// horns first, and the impact tips it degrees below its limit.
scene::Scene leaning(double angle) {
  return setup::parseScene(
      fmt::format(
          "version = 1\n[run]\nduration = 6\ntime_step = 1e-4\ngravity = [0, {}, {}]\n[material.steel]\n"
          "stiffness = 1e8\nfriction = 3.0\n[terrain]\nkind = \"rigid\"\nheightmap = \"heightmaps/flat.png\"\n"
          "size = [12, 12]\nheight_range = [0, 0]\nmaterial = \"steel\"\n[vehicle]\n"
          "spec = \"vehicles/light_tracked.toml\"\nsphere_radius = 0.03\nhull_touches = false\n"
          "position = [4, 0]\nclearance = 0\n[driver]\nsprocket_speed = 0\ntension_ramp = 0.05\nweight_ramp = 0.5\n"
          "rest_time_limit = 100\n[spec.contact]\nfriction_ground = 3.0\nfriction_inside = 2.0\n[spec.arm]\n"
          "suspension = \"rigid\"\n",
          -kEarth * std::sin(angle), -kEarth * std::cos(angle)),
      GROUSER_SOURCE_DIR "/tests/scenes/rigid.toml");
}

Simulation standingOn(double angle) {
  return Simulation(
      setup::simulationSetup(leaning(angle)), testExec(), [](double, double) {}, {}, nullptr, sharedSpheres());
}

/// Slope [rad] at which it tips over the right track's pads, from the drawing. Wheels lift off the left track, whose
/// shoes stay on the ground until the track is taut: they do not hold it down.
double tippingAngle(const Simulation& simulation) {
  const vehicle::Assembly& assembly = simulation.vehicle()->assembly();
  const std::vector<base::Pose>& poses = simulation.vehicle()->state().pose;
  const vehicle::Track& left = assembly.tracks.front();
  double low = 1e9, mass = 0;
  const auto at = [&](int body) { return poses[static_cast<std::size_t>(body)].position; };
  for (const int shoe : left.shoes) low = std::min(low, at(shoe).z);
  Vec3d centre;
  const auto add = [&](int body, double share) {
    const double m = share * assembly.model.bodies()[static_cast<std::size_t>(body)].mass;
    centre += at(body) * m, mass += m;
  };
  for (std::size_t b = 0; b < poses.size(); ++b) add(static_cast<int>(b), 1);
  int loose = 0;
  for (const int shoe : left.shoes)
    if (at(shoe).z < low + 1e-3) add(shoe, -1), ++loose;
  centre = centre * (1 / mass);
  const double edge = assembly.spec.trackOffset + assembly.spec.shoe.padHalfWidth;
  std::printf("%d shoes loose, edge at %.4f m, middle of the mass %.4f m beside the middle and %.4f m high\n", loose,
              edge, centre.y, centre.z);
  return std::atan((edge + centre.y) / centre.z);
}

/// Roll of the hull [rad] at 2.5 s.
double rollAt(double angle) {
  Simulation simulation = standingOn(angle);
  const auto end = std::llround(2.5 / simulation.timeStep());
  while (simulation.steps() < end) simulation.step();
  return std::fabs(simulation.vehicle()->observe().rollAngle);
}

TEST(Tipping, IsWithinADegreeOfGeometry) {
  constexpr double kDegree = base::kPi / 180;
  const double limit = tippingAngle(standingOn(0));
  const double below = rollAt(limit - kDegree), above = rollAt(limit + kDegree);
  std::printf("tips at %.2f degrees by geometry: rolls by %.4f rad one below, %.4f one above\n", limit / kDegree, below,
              above);
  EXPECT_LT(below, 0.01);
  EXPECT_GT(above, 0.2);
}

} // namespace
} // namespace grouser::coupling
