// SPDX-License-Identifier: BSD-3-Clause
// Elastic-plastic contacts in scenes: rebound, losses, and their entries in the ledger.
#include "base/error.hpp"
#include "runs/setup/simulation_setup.hpp"
#include "tests/system/ledger_fixture.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace grouser::coupling::ledgers {
namespace {

const std::string kStill = "gravity = [0, 0, 0]\nprecision = \"double\"";

/// A material without friction, dashpot or weight.
std::string yielding(const std::string& law, const std::string& more) {
  const std::string elastic = law == "eepa" ? "young = 2e8\npoisson = 0.25" : "stiffness = 1e5";
  return fmt::format("[material.soil]\ndensity = {}\nlaw = \"{}\"\n{}\nrestitution = 1\nfriction = 0\n{}\n", kDensity,
                     law, elastic, more);
}

const std::string kHeadOn =
    ballAt("[-0.0101, 0, 0]", "velocity = [1, 0, 0]") + ballAt("[0.0101, 0, 0]", "velocity = [-1, 0, 0]");

/// Relative error of the energy lost in a head-on collision, by the ledger's yielding and by its kinetic energy.
void expectLoss(const std::string& law, const std::string& more, double share, const std::string& balls, double mass) {
  const double energy = 0.5 * mass;
  std::vector<double> errors;
  for (const double step : {2e-6, 5e-7}) {
    const Ledger l = after(yielding(law, more) + balls, 0.004, step, kStill);
    EXPECT_EQ(l.dissipated.friction + l.dissipated.rolling, 0);
    EXPECT_NEAR(l.dissipated.damping, 0, 1e-6 * energy);
    EXPECT_NEAR(-l.kinetic / energy, l.dissipated.yielding / energy, 20 * step / 5e-4) << law << ": they have parted";
    EXPECT_NEAR(l.elastic / energy, 0, 1e-12);
    EXPECT_LT(std::fabs(l.residual), 1e-9 * l.turnover);
    errors.push_back(std::fabs(l.dissipated.yielding / energy - share));
  }
  EXPECT_LT(errors.back(), 2e-3) << law;
  EXPECT_LT(errors.back(), 0.6 * errors.front() + 1e-4) << law << " " << errors.front();
}

TEST(Yielding, HeadOnTheEnergyThatIsLostIsThatOfTheClosedForm) {
  expectLoss("eepa_linear", "plasticity = 0.64", 0.64, kHeadOn, 2 * ballMass()); // e^2 = k1 / k2
  const double depth = std::cbrt(0.64 * 0.64);
  expectLoss("eepa", "plasticity = 0.64", 0.64 / 0.36 * (1 - depth) * 1.5, kHeadOn, 2 * ballMass());
  // k2 reaches its maximum at once if phi_f is small.
  expectLoss("luding", "plasticity = 0.64\nplastic_depth = 1e-6", 0.64, kHeadOn, 2 * ballMass());
}

TEST(Yielding, BallOnAPlaneYieldsToo) {
  expectLoss("eepa_linear", "plasticity = 0.64", 0.64, oneBall(0.0101, "velocity = [0, 0, -1]"), ballMass());
}

TEST(Yielding, StickyBallsStayTogether) {
  // Slow enough for the pull-off work to exceed the released energy.
  const std::string slow =
      ballAt("[-0.0101, 0, 0]", "velocity = [0.02, 0, 0]") + ballAt("[0.0101, 0, 0]", "velocity = [-0.02, 0, 0]");
  const auto contacts = [&](const std::string& energy) {
    return after(yielding("eepa", "plasticity = 0.6\nsurface_energy = " + energy) + slow, 0.05, 2e-6, kStill)
        .grainContacts;
  };
  EXPECT_EQ(contacts("0"), 0);
  EXPECT_EQ(contacts("2000"), 1);
}

TEST(Yielding, BoxOfSoilClosesAtEveryStep) {
  const std::string soil = yielding("eepa", "plasticity = 0.6\nsurface_energy = 2\nrolling_friction = 0.1");
  std::string rubbing = soil;
  rubbing.replace(rubbing.find("friction = 0\n"), 13, "friction = 0.5\n");
  std::vector<double> errors;
  for (const double step : {8e-6, 2e-6}) {
    const Ledger l =
        after(rubbing + planeThrough("[0, 0, 0]", "[0, 0, 1]") + planeThrough("[-0.05, 0, 0]", "[1, 0, 0.1]") +
                  "[[grains]]\nform = \"lattice\"\nlow = [-0.05, -0.04, 0.01]\nhigh = [0.05, 0.04, 0.09]\n"
                  "radius = 0.008\njitter = 0.5\nspacing = 2.2\nvelocity = [0, 0, -1]\nmaterial = \"soil\"\n",
              0.1, step);
    EXPECT_LT(std::fabs(l.residual), 1e-9 * l.turnover) << step;
    EXPECT_GT(l.dissipated.yielding, 0.2 * l.dissipated.total());
    errors.push_back(std::fabs(l.integrationError / l.dissipated.total()));
  }
  EXPECT_LT(errors.back(), 0.02);
  EXPECT_LT(errors.back(), 0.7 * errors.front()) << errors.front();
}

TEST(Yielding, StepLimitIsThatOfTheSteeperLine) {
  const auto stepOf = [&](const std::string& law, const std::string& more) {
    const std::string elastic = law == "hertz" || law == "eepa" ? "young = 2e8" : "stiffness = 1e5";
    const std::string text =
        fmt::format("version = 1\n[run]\nduration = 1\ntime_step = \"auto\"\n[material.soil]\nlaw = \"{}\"\n{}\n"
                    "restitution = 1\nfriction = 0\n{}\n{}",
                    law, elastic, more, kHeadOn);
    return setup::simulationSetup(setup::parseScene(text, "step.toml")).timeStep;
  };
  EXPECT_NEAR(stepOf("eepa_linear", "plasticity = 0.75") / stepOf("linear", ""), 0.5, 0.02);
  EXPECT_NEAR(stepOf("luding", "plasticity = 0.75") / stepOf("linear", ""), 0.5, 0.02);
  EXPECT_NEAR(stepOf("eepa", "plasticity = 0.75") / stepOf("hertz", ""), 0.5, 0.02);
}

void expectRefused(const std::string& material, const std::string& message) {
  try {
    setup::parseScene("version = 1\n[run]\nduration = 1\n" + material + kHeadOn, "bad.toml");
    FAIL() << "accepted: " << material;
  } catch (const base::InputError& e) {
    EXPECT_NE(std::string(e.what()).find(message), std::string::npos) << e.what();
  }
}

TEST(Yielding, KeysOfOtherLawsAreRefused) {
  const std::string begin = "[material.soil]\n";
  expectRefused(begin + "law = \"linear\"\nplasticity = 0.5\n", "plasticity = 0.5 requires law");
  expectRefused(begin + "law = \"luding\"\nsurface_energy = 1\n", "surface_energy = 1 requires law");
  expectRefused(begin + "law = \"eepa\"\nyoung = 1e8\nplastic_depth = 0.1\n", "plastic_depth = 0.1 requires law");
  expectRefused(begin + "law = \"eepa\"\n", "young");
  expectRefused(begin + "law = \"eepa\"\nyoung = 1e8\nstiffness = 1e5\n", "stiffness");
  expectRefused(begin + "law = \"eepa\"\nyoung = 1e8\nadhesion_exponent = 1.7\n", "multiple of 0.5");
  expectRefused(begin + "law = \"eepa\"\nyoung = 1e8\nplasticity = 1\n", "[0, 0.99]");
}

TEST(Yielding, MaterialsThatMeetAreBothHertzianOrBothLinear) {
  const auto made = [&](const std::string& other) {
    const std::string text = "version = 1\n[run]\nduration = 1\n[material.soil]\nlaw = \"eepa_linear\"\n" +
                             std::string("[material.other]\n") + other + kHeadOn +
                             "[[plane]]\nmaterial = \"other\"\npoint = [0, 0, -0.1]\n";
    setup::simulationSetup(setup::parseScene(text, "pair.toml"));
  };
  EXPECT_NO_THROW(made("law = \"linear\"\n"));
  EXPECT_THROW(made("law = \"luding\"\n"), base::InputError);
  EXPECT_THROW(made("law = \"hertz\"\nyoung = 1e8\n"), base::InputError);
}

} // namespace
} // namespace grouser::coupling::ledgers
