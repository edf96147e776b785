// SPDX-License-Identifier: BSD-3-Clause
// Grains from 1 um to 10 m: with equal E / (rho v^2) and v^2 / (g R), the motion in radii is the same.
#include "tests/system/ledger_fixture.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace grouser::coupling::ledgers {
namespace {

/// Moduli scale with the radius, stiffnesses and surface energies with its square.
std::string lawOf(const std::string& name, double radius) {
  const double modulus = 1e9 * radius, stiffness = 2e9 * radius * radius, energy = 8e3 * radius * radius;
  const std::string linear = fmt::format("stiffness = {}\n", stiffness), hertz = fmt::format("young = {}\n", modulus);
  if (name == "linear") return "law = \"linear\"\n" + linear;
  if (name == "hertz") return "law = \"hertz\"\n" + hertz;
  if (name == "cohesion") return "law = \"hertz\"\n" + hertz + fmt::format("cohesion = {}\n", energy);
  if (name == "eepa")
    return "law = \"eepa\"\n" + hertz + fmt::format("plasticity = 0.5\nsurface_energy = {}\n", energy);
  if (name == "eepa_linear")
    return "law = \"eepa_linear\"\n" + linear + fmt::format("plasticity = 0.5\nsurface_energy = {}\n", energy);
  return "law = \"luding\"\n" + linear +
         fmt::format("plasticity = 0.5\nplastic_depth = 0.01\nadhesion_stiffness = {}\n", 0.2 * stiffness);
}

struct Motion {
  std::vector<base::Vec3d> place, velocity, spin; ///< in radii, root(g R) and root(g / R)
};

/// A ball that falls onto a floor, rolls on it and hits another one, `others` radii large, from the side.
Motion motionOf(const std::string& law, double radius, const std::string& precision, double other) {
  const double g = kGravity, speed = std::sqrt(g * radius), time = std::sqrt(radius / g);
  const auto at = [&](double x, double y, double z) {
    return fmt::format("[{}, {}, {}]", x * radius, y * radius, z * radius);
  };
  // A fiftieth of a radius from it.
  const double ahead = std::sqrt((1.02 + other) * (1.02 + other) - 0.04 - (1 - other) * (1 - other));
  const char* const floor = "[[plane]]\npoint = [0, 0, 0]\nmaterial = \"soil\"\n";
  const auto simulation = made(setup::parseScene(
      fmt::format("version = 1\n[run]\nduration = {}\nprecision = \"{}\"\nimpact_speed = {}\nsteps_per_contact = 60\n"
                  "[material.soil]\ndensity = {}\nrestitution = 0.6\nfriction = 0.4\nrolling_friction = 0.05\n{}"
                  "{}[[grain]]\nposition = {}\nvelocity = [{}, 0, {}]\nspin = [{}, 0, 0]\nradius = {}\n"
                  "material = \"soil\"\n[[grain]]\nposition = {}\nradius = {}\nmaterial = \"soil\"\n",
                  time, precision, 2 * speed, kDensity, lawOf(law, radius), floor, at(0, 0, 1.001), speed, -0.3 * speed,
                  0.5 / time, radius, at(ahead, 0.2, other + 0.0005), other * radius),
      "scale.toml"));
  const int steps = 600;
  for (int k = 0; k < steps; ++k) simulation->step();
  const auto s = simulation->ground().grains->snapshot();
  Motion motion;
  for (std::size_t i = 0; i < s.position.size(); ++i) {
    motion.place.push_back(s.position[i] * (1 / radius));
    motion.velocity.push_back(s.velocity[i].template as<double>() * (1 / speed));
    motion.spin.push_back(s.spin[i].template as<double>() * time);
  }
  return motion;
}

double apart(const std::vector<base::Vec3d>& a, const std::vector<base::Vec3d>& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, norm(a[i] - b[i]));
  return most;
}

class Scale : public ::testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Laws, Scale, ::testing::Values("linear", "hertz", "cohesion", "eepa", "eepa_linear", "luding"),
                         [](const auto& law) { return std::string(law.param); });

TEST_P(Scale, MotionInRadiiIsTheSameFromAMicrometreToTenMetres) {
  for (const double other : {1.0, 0.7}) { // grains of equal mass, and of mixed masses
    const Motion reference = motionOf(GetParam(), 0.01, "double", other);
    EXPECT_GT(norm(reference.velocity[1]), 0.1) << "it was hit";
    for (const char* precision : {"single", "double"})
      for (const double radius : {1e-6, 3e-6, 1e-5, 1e-3, 1.0, 10.0}) {
        const Motion m = motionOf(GetParam(), radius, precision, other);
        EXPECT_LT(apart(m.place, reference.place), 1e-5) << radius << " m, " << precision << ", " << other;
        EXPECT_LT(apart(m.velocity, reference.velocity), 1e-4) << radius << " m, " << precision << ", " << other;
        EXPECT_LT(apart(m.spin, reference.spin), 1e-4) << radius << " m, " << precision << ", " << other;
      }
  }
}

} // namespace
} // namespace grouser::coupling::ledgers
