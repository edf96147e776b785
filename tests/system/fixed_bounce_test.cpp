// SPDX-License-Identifier: BSD-3-Clause
// Specified restitution of grains on fixed surfaces and fixed grains.
#include "tests/system/ledger_fixture.hpp"

#include <gtest/gtest.h>

namespace grouser::coupling::ledgers {
namespace {

/// Rebound over impact speed of a ball that falls at 1 m/s onto `ground`, which lies below z = 0.
double reboundOn(const std::string& ground, const std::string& law, const std::string& run) {
  const std::string text = fmt::format("[material.soil]\ndensity = {}\nfriction = 0\n{}\n", kDensity, law) + ground +
                           ballAt("[0, 0, 0.01001]", "velocity = [0, 0, -1]");
  const auto simulation = made(setup::parseScene(
      fmt::format("version = 1\n[run]\nduration = 0.01\ngravity = [0, 0, 0]\nsteps_per_contact = 800\n{}\n{}", run,
                  text),
      "bounce.toml"));
  while (simulation->time() < 0.004) simulation->step(); // contacts last 1 ms
  return simulation->ground().grains->snapshot().velocity.back().z;
}

const char* const kFixed = "[[grain]]\nposition = [0, 0, -0.01]\nradius = 0.01\nfixed = true\nmaterial = \"soil\"\n";
const char* const kSmallFixed = "[[grain]]\nposition = [0, 0, -0.005]\nradius = 0.005\nfixed = true\n"
                                "material = \"soil\"\n";
const char* const kPlane = "[[plane]]\npoint = [0, 0, 0]\nmaterial = \"soil\"\n";

TEST(FixedGrainOfAScene, GivesTheRestitutionAskedFor) {
  // First order at the ends of a contact: C / 800 steps.
  for (const char* precision : {"single", "double"})
    for (const char* attraction : {"false", "true"})
      for (const char* stiffness : {"law = \"linear\"\nstiffness = 1e5", "law = \"hertz\"\nyoung = 1e8"})
        for (const char* ground : {kFixed, kSmallFixed, kPlane})
          for (const double e : {0.5, 0.8}) {
            const std::string law = fmt::format("{}\nrestitution = {}\nattraction = {}", stiffness, e, attraction);
            EXPECT_NEAR(reboundOn(ground, law, fmt::format("precision = \"{}\"", precision)), e, 4e-3)
                << law << "\n"
                << ground << precision;
          }
}

TEST(FixedGrainOfAScene, ThatYieldsReturnsABallAsAWallDoes) {
  const std::string law = "law = \"eepa_linear\"\nstiffness = 1e5\nplasticity = 0.4\nsurface_energy = 0\n"
                          "restitution = 0.7";
  const double wall = reboundOn(kPlane, law, "precision = \"double\"");
  EXPECT_NEAR(reboundOn(kFixed, law, "precision = \"double\""), wall, 1e-3);
  EXPECT_LT(wall, 0.65) << "plastic work in addition";
}

TEST(FixedGrainOfAScene, TakesADampingThatIsGivenAsItIs) {
  // gamma = 2 zeta omega with the omega of the full mass, for damped contacts with attraction.
  const double omega = std::sqrt(1e5 / ballMass()), zeta = 0.2;
  const std::string law = fmt::format("stiffness = 1e5\ndamping = {}\nattraction = true", 2 * zeta * omega);
  EXPECT_NEAR(reboundOn(kFixed, law, "precision = \"double\""),
              base::exp(-base::kPi * zeta / std::sqrt(1 - zeta * zeta)), 4e-3);
}

} // namespace
} // namespace grouser::coupling::ledgers
