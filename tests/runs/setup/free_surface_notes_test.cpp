// SPDX-License-Identifier: BSD-3-Clause
// Light free surfaces lower the restitution: the note states the amount, and the minimum mass.
#include "runs/setup/free_surface_notes.hpp"

#include "base/rounded.hpp"
#include "base/sphere.hpp"
#include "contact/restitution.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/load_scene.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace grouser::setup {
namespace {

constexpr double kRadius = 0.01, kDensity = 2500;

scene::Scene plateOf(double mass, const std::string& material) {
  return parseScene(
      fmt::format("version = 1\n[run]\nduration = 1\n[material.m]\ndensity = {}\n{}\n[[grain]]\nposition = [0, 0, "
                  "1]\nradius = {}\nmaterial = \"m\"\n[[box]]\nname = \"plate\"\nposition = [0, 0, 0]\nsize = [1, 1, "
                  "0.1]\nmaterial = \"m\"\nfree = \"z\"\nmass = {}\n",
                  kDensity, material, kRadius, mass),
      "scene.toml");
}
std::vector<std::string> notesOf(double mass, const std::string& material) {
  return freeSurfaceNotes(plateOf(mass, material));
}

/// Rebound over impact speed of a grain and a free surface of masses 1 and `surface`, with the dashpot for 0.5
/// on a wall; steps of 1e-5 contact times.
double reboundFrom(double surface) {
  const double zeta = contact::dampingRatioFor(0.5, false), inverseMass = 1 + 1 / surface, step = 3e-5;
  double overlap = 0, speed = 1, force = 0;
  do {
    force = std::max(0.0, overlap + 2 * zeta * speed);
    speed -= step * inverseMass * force, overlap += step * speed;
  } while (force > 0);
  return -speed;
}

TEST(FreeSurfaceNotes, LightSurfaceIsNotedWithTheRestitutionThatItGives) {
  const double grain = base::sphereMass(kDensity, kRadius);
  for (const double shareOfGrain : {5.0, 1.0, 0.2}) {
    const std::vector<std::string> notes = notesOf(shareOfGrain * grain, "stiffness = 1e5\nrestitution = 0.5");
    ASSERT_EQ(notes.size(), 1u);
    for (const std::string& part :
         {std::string("box \"plate\""), fmt::format("{:.3f} instead of 0.500", reboundFrom(shareOfGrain)),
          "at least " + base::roundedUp(20 * grain, 3) + " kg"})
      EXPECT_NE(notes.front().find(part), std::string::npos) << part << " in " << notes.front();
  }
}

TEST(FreeSurfaceNotes, DampingOfHertzFollowsTheSameRatioOfMasses) {
  const double grain = base::sphereMass(kDensity, kRadius), beta = contact::hertzDampingRatioFor(0.5, false);
  const std::vector<std::string> notes =
      notesOf(grain, "law = \"hertz\"\nyoung = 1e7\npoisson = 0.3\nrestitution = 0.5");
  ASSERT_EQ(notes.size(), 1u);
  const std::string made =
      fmt::format("{:.3f} instead of 0.500", contact::hertzRestitutionOf(beta * std::sqrt(2.0), false));
  EXPECT_NE(notes.front().find(made), std::string::npos) << notes.front();
}

TEST(FreeSurfaceNotes, HeavyAndElasticSurfacesAreNotNoted) {
  const double grain = base::sphereMass(kDensity, kRadius);
  EXPECT_TRUE(notesOf(20 * grain, "stiffness = 1e5\nrestitution = 0.5").empty());
  EXPECT_TRUE(notesOf(grain, "stiffness = 1e5\nrestitution = 1").empty());
}

} // namespace
} // namespace grouser::setup
