// SPDX-License-Identifier: BSD-3-Clause
// The ledger of grain scenes: it closes to rounding at every step, contains the true losses, and its integration
// error falls with the time step.
#include "tests/system/ledger_fixture.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <vector>

namespace grouser::coupling::ledgers {
namespace {

/// 250 grains that fall into a box.
std::string boxOfGrains() {
  std::string text = "[[grains]]\nform = \"random\"\nlow = [-0.04, -0.04, 0]\nhigh = [0.04, 0.04, 0.25]\nnumber = 250\n"
                     "radius = 0.005\nmaterial = \"soil\"\n";
  for (const char* plane : {"point = [0, 0, 0]\nnormal = [0, 0, 1]", "point = [-0.04, 0, 0]\nnormal = [1, 0, 0]",
                            "point = [0.04, 0, 0]\nnormal = [-1, 0, 0]", "point = [0, -0.04, 0]\nnormal = [0, 1, 0]",
                            "point = [0, 0.04, 0]\nnormal = [0, -1, 0]"})
    text += fmt::format("[[plane]]\n{}\nmaterial = \"soil\"\n", plane);
  return text;
}

/// Order p with which |error| = C step^p fits three halvings.
double orderOf(const std::vector<double>& errors) {
  return std::log2(std::fabs(errors.front() / errors.back())) / static_cast<double>(errors.size() - 1);
}

TEST(LedgerOfGrains, ElasticBounceThatSticksDissipatesNothing) {
  // Only springs act: no dashpot, and sliding only as the contact ends.
  for (const double step : {4e-5, 2e-5, 1e-5}) {
    const Ledger l = after(material(1, 0) + oneBall(0.06, "velocity = [0.5, 0, -1]\nspin = [0, 3, 1]"), 0.2, step);
    EXPECT_EQ(l.dissipated.total(), 0) << step;
    EXPECT_LT(std::fabs(l.residual), 1e-9 * l.turnover) << "rounding, at a step of " << step;
  }
  const Ledger sticks = after(material(1, 10) + oneBall(0.06, "velocity = [0.5, 0, -1]\nspin = [0, 3, 1]"), 0.2, 1e-5);
  EXPECT_EQ(sticks.dissipated.damping, 0);
  EXPECT_LT(sticks.dissipated.friction, 1e-4 * sticks.turnover);
}

TEST(LedgerOfGrains, IntegrationErrorOfBouncesFallsWithTheStep) {
  // The phase of the first touch within a step is effectively random: root mean square over 24 heights.
  std::vector<double> errors;
  for (const double step : {4e-5, 2e-5, 1e-5}) {
    double sum = 0;
    for (int k = 0; k < 24; ++k) {
      const Ledger l = after(material(1, 0) + oneBall(0.02 + 1e-5 * k, "velocity = [0, 0, -1]"), 0.03, step);
      sum += l.integrationError * l.integrationError / 24;
    }
    errors.push_back(std::sqrt(sum));
  }
  EXPECT_GT(orderOf(errors), 0.9);
  EXPECT_LT(errors[2], 1e-3 * 0.5 * ballMass()) << "for a ball at 1 m/s, 100 steps per contact";
}

TEST(LedgerOfGrains, DampedBounceLosesWhatItsRestitutionSays) {
  const double restitution = 0.6, true_loss = 0.5 * ballMass() * (1 - restitution * restitution); // at 1 m/s
  std::vector<double> errors;
  for (const double step : {4e-5, 2e-5, 1e-5, 5e-6}) {
    double sum = 0;
    for (int k = 0; k < 16; ++k) {
      const Ledger l = after(material(restitution, 0) + oneBall(0.012 + 3e-6 * k, "velocity = [0, 0, -1]"), 0.006, step,
                             "gravity = [0, 0, 0]\nprecision = \"double\"");
      EXPECT_EQ(l.dissipated.friction + l.dissipated.rolling, 0);
      sum += std::pow(l.dissipated.damping / true_loss - 1, 2) / 16;
    }
    errors.push_back(std::sqrt(sum));
  }
  EXPECT_GT(orderOf(errors), 0.9) << errors.front() << " to " << errors.back();
  EXPECT_LT(errors.back(), 2e-3) << "200 steps a contact";
}

TEST(LedgerOfGrains, SlidingBallLosesTwoSeventhsOfItsEnergyToFriction) {
  // A ball put down with v rolls once friction has slowed it to 5/7 v: after 2 v / (7 mu g) = 0.097 s.
  const double speed = 1, loss = 0.5 * ballMass() * speed * speed * 2 / 7;
  const std::string ball = oneBall(kRadius - ballMass() * kGravity / 1e5, "velocity = [1, 0, 0]");
  for (const double step : {4e-5, 1e-5}) {
    const Ledger l = after(material(0.5, 0.3) + ball, 0.15, step);
    // Step error: the first and the last of its 2400 steps of sliding; model error: the lever arm is shorter by the
    // overlap.
    EXPECT_NEAR(l.dissipated.friction / loss, 1, 2 * step / 0.097 + 1e-3);
    EXPECT_LT(l.dissipated.damping, 1e-3 * loss);
    EXPECT_LT(std::fabs(l.integrationError), 2e-3 * loss);
  }
}

TEST(LedgerOfGrains, RollingBallLosesAllOfItsEnergyToRollingResistance) {
  const double speed = 0.3, energy = 0.7 * ballMass() * speed * speed; // with the spin of rolling
  const std::string ball = oneBall(kRadius - ballMass() * kGravity / 1e5, "velocity = [0.3, 0, 0]\nspin = [0, 30, 0]");
  const Ledger l = after(material(0.5, 0.8, "rolling_friction = 0.1") + ball, 0.8, 2e-5);
  EXPECT_LT(l.kinetic, -0.999 * energy) << "it is at rest";
  EXPECT_NEAR(l.dissipated.rolling / energy, 1, 0.03) << "some energy is lost to friction and damping as it stops";
  EXPECT_NEAR(l.dissipated.total() / energy, 1, 2e-3);
}

TEST(LedgerOfGrains, BoxOfGrainsClosesAtEveryStep) {
  // The limit is 1.7e-5 s. Potential energy lost equals dissipation; the error is a share that falls with the step.
  std::vector<double> errors;
  for (const double step : {1.6e-5, 8e-6, 4e-6}) {
    const Ledger l = after(material(0.5, 0.5) + boxOfGrains(), 0.25, step);
    EXPECT_LT(std::fabs(l.residual), 1e-9 * l.turnover) << step;
    EXPECT_NEAR(l.kinetic + l.potential + l.elastic + l.dissipated.total() + l.integrationError, l.residual,
                1e-12 * l.turnover)
        << "by definition";
    for (const double part : {l.dissipated.damping, l.dissipated.friction}) EXPECT_GT(part, 0.1 * l.dissipated.total());
    EXPECT_EQ(l.dissipated.rolling + l.dissipated.parts + l.dissipated.joints, 0);
    EXPECT_LT(norm(l.momentumResidual), 1e-8 * 250 * ballMass() / 8 * kGravity * 0.25) << "of the weight's impulse";
    EXPECT_LT(norm(l.angularResidual), 1e-8 * 250 * ballMass() / 8 * kGravity * 0.25 * 0.1) << "at 0.1 m";
    errors.push_back(l.integrationError / l.dissipated.total());
    // The table of docs/steps.md#energy-ledger.
    std::printf("step %.1e s: dissipated %.4e J (damping %.1f %%, friction %.1f %%), integration error %.2e J, %.2f %% "
                "of it, left over %.0e of the turnover\n",
                step, l.dissipated.total(), 100 * l.dissipated.damping / l.dissipated.total(),
                100 * l.dissipated.friction / l.dissipated.total(), l.integrationError, 100 * errors.back(),
                std::fabs(l.residual) / l.turnover);
  }
  std::printf("order of the integration error %.2f\n", orderOf(errors));
  EXPECT_GT(orderOf(errors), 0.7) << errors.front() << " to " << errors.back();
  EXPECT_LT(errors.back(), 0.01);
  const Ledger single = after(material(0.5, 0.5) + boxOfGrains(), 0.25, 8e-6, "precision = \"single\"");
  EXPECT_LT(std::fabs(single.residual), 1e-6 * single.turnover);
}

TEST(LedgerOfGrains, MomentaBalanceWithGravityAndWalls) {
  // A ball thrown at a wall reverses its momentum; gravity and the wall also change its moment about the origin.
  const Ledger l = after(material(0.8, 0.4) + "[[grain]]\nposition = [0.2, 0.1, 0.3]\nvelocity = [1, 0.3, 0.5]\n"
                                              "spin = [3, -5, 40]\nradius = 0.01\nmaterial = \"soil\"\n[[plane]]\n"
                                              "point = [0.25, 0, 0]\nnormal = [-1, 0, 0]\nmaterial = \"soil\"\n",
                         0.2, 1e-5);
  EXPECT_LT(l.momentum.x, -0.7 * ballMass()) << "it has bounced";
  // Velocities up to 2 m/s have 40 bits: all of 20,000 steps may round in the same direction.
  EXPECT_LT(norm(l.momentumResidual), 20000 * ballMass() * 2 * 0x1p-40);
  EXPECT_LT(norm(l.angularResidual), 20000 * ballMass() * 2 * 0x1p-40);
}

TEST(LedgerOfGrains, GrainsThatEnterBringTheirEnergyWithThem) {
  const std::string source = "[[source]]\nlow = [-0.03, -0.03, 0.2]\nhigh = [0.03, 0.03, 0.22]\nvelocity = [0, 0, -2]\n"
                             "radius = 0.005\nmaterial = \"soil\"\nnumber = 3\nevery = 0.02\ntotal = 30\n[[plane]]\n"
                             "point = [0, 0, 0]\nmaterial = \"soil\"\n";
  const Ledger l = after(material(0.5, 0.5) + source, 0.25, 1e-5);
  EXPECT_LT(std::fabs(l.residual), 1e-9 * l.turnover);
  EXPECT_LT(std::fabs(l.integrationError), 0.02 * l.dissipated.total());
  EXPECT_LT(norm(l.momentumResidual), 1e-8 * l.turnover);
}

TEST(LedgerOfGrains, LiftThatCarriesAGrainPutsInItsWeight) {
  // A plane that rises at 0.1 m/s under a ball at rest on it.
  const std::string lift = "[[grain]]\nposition = [0, 0, 0.01]\nvelocity = [0, 0, 0.1]\nradius = 0.01\nmaterial = "
                           "\"soil\"\n[[plane]]\npoint = [0, 0, 0]\nvelocity = [0, 0, 0.1]\nmaterial = \"soil\"\n";
  const Ledger l = after(material(0.3, 0.5) + lift, 0.5, 2e-5);
  const double lifted = ballMass() * kGravity * 0.05;
  EXPECT_NEAR(l.driveWork / lifted, 1, 1e-3) << "small initial oscillation";
  EXPECT_NEAR(l.potential / lifted, 1, 1e-3);
  EXPECT_LT(std::fabs(l.integrationError), 1e-3 * lifted);
  EXPECT_LT(norm(l.momentumResidual), 1e-9 * ballMass() * kGravity * 0.5);
}

} // namespace
} // namespace grouser::coupling::ledgers
