// SPDX-License-Identifier: BSD-3-Clause
// Micro-slip: the ledger contains the energy that Hertz springs lose as their stiffness changes with the load.
#include "tests/system/ledger_fixture.hpp"

#include <gtest/gtest.h>

namespace grouser::coupling::ledgers {
namespace {

std::string hertzBall(double friction, double young, const std::string& more = {}) {
  return fmt::format("[material.soil]\nlaw = \"hertz\"\ndensity = {}\nyoung = {}\npoisson = 0.3\nrestitution = 1\n"
                     "friction = {}\ntangential_damping_ratio = 0\n{}\n",
                     kDensity, young, friction, more);
}

const std::string kStill = "gravity = [0, 0, 0]\nprecision = ";

TEST(MicroSlip, ElasticBounceThatSticksLosesATenthByItAndNothingElse) {
  const double energy = ballMass(); // at 1 m/s along and across
  for (const char* precision : {"\"double\"", "\"single\""}) {
    double error[2];
    for (int k = 0; k < 2; ++k) {
      const Ledger l = after(hertzBall(10, 1e8) + oneBall(0.01005, "velocity = [1, 0, -1]"), 0.012, k ? 2.5e-6 : 1e-5,
                             kStill + precision);
      EXPECT_EQ(l.dissipated.damping + l.dissipated.rolling, 0);
      EXPECT_GE(l.dissipated.friction, 0);
      EXPECT_LT(l.dissipated.friction, 0.02 * energy) << "at the end of the contact";
      EXPECT_GT(l.dissipated.microSlip, 0.08 * energy);
      EXPECT_LT(l.dissipated.microSlip, 0.16 * energy);
      error[k] = std::fabs(l.integrationError) / l.dissipated.total();
    }
    EXPECT_LT(error[1], 0.02) << "400 steps per contact";
    EXPECT_LT(error[1], 0.5 * error[0] + 1e-3) << "it decreases with the step";
  }
}

TEST(MicroSlip, LinearSpringsHaveNone) {
  const Ledger l = after(material(1, 10) + oneBall(0.01005, "velocity = [1, 0, -1]"), 0.012, 1e-5);
  EXPECT_EQ(l.dissipated.microSlip, 0);
}

TEST(MicroSlip, BallShakenUnderAVaryingLoadGivesNoWork) {
  // A table shakes it at 20 Hz, a lid presses it at 40 Hz: at any phase, losses in friction and springs are not
  // negative, and the drives supply the dissipated energy, to the error of the step.
  for (const double friction : {0.3, 10.0})
    for (int phase = 0; phase < 360; phase += 45) {
      const std::string table =
          planeThrough("[0, 0, 0]", "[0, 0, 1]", "name = \"table\"\namplitude = [1e-4, 0, 0]\nfrequency = 20");
      const std::string lid =
          planeThrough("[0, 0, 0.01992]", "[0, 0, -1]",
                       fmt::format("name = \"lid\"\namplitude = [0, 0, 3e-5]\nfrequency = 40\nphase = {}", phase));
      const Ledger l =
          after(hertzBall(friction, 1e7, "rolling_friction = 0.05") + table + lid + ballAt("[0, 0, 0.00996]"), 0.1,
                5e-6, kStill + "\"double\"\nmax_overlap = 0.5");
      const double taken = l.dissipated.total();
      EXPECT_GE(l.dissipated.friction, 0) << phase;
      EXPECT_GT(l.dissipated.microSlip, 0) << phase;
      EXPECT_GE(l.dissipated.rolling, 0) << phase;
      EXPECT_LT(std::fabs(l.integrationError), 0.05 * taken + 1e-9 * l.turnover) << phase;
      EXPECT_LT(std::fabs(l.residual), 1e-8 * l.turnover) << phase << ": rounding";
    }
}

} // namespace
} // namespace grouser::coupling::ledgers
