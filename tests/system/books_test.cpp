// SPDX-License-Identifier: BSD-3-Clause
// Energy accounting of runs with closed forms for losses, works and momenta, or with balances that must close.
#include "coupling/vehicle_rig.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/simulation_setup.hpp"
#include "tests/system/ledger_fixture.hpp"

#include <gtest/gtest.h>

namespace grouser::coupling::ledgers {
namespace {

// If a spring has the same length at the end as at the start, its work under symplectic Euler is zero at any step:
// sum of k x_n (v_n + v_n+1) / 2 dt = sum of k x_n (x_n+1 - x_n-1) / 2. The dashpot then dissipates all of the lost
// energy, provided that it uses the speed in the middle of the step.
const char* const kCritical = "attraction = true\ntangential_damping_ratio = 1";

TEST(LedgerOfOneGrain, BallCaughtByACriticalDashpotLosesAllOfItsEnergyAtAnyStep) {
  const double energy = 0.5 * ballMass();
  for (const double step : {5e-5, 2e-5, 5e-6}) {
    const Ledger l = after(material(0, 0, kCritical) + oneBall(kRadius, "velocity = [0, 0, -1]"), 0.02, step,
                           "gravity = [0, 0, 0]\nprecision = \"double\"");
    EXPECT_NEAR(l.dissipated.damping / energy, 1, 1e-6) << step << ": positions are whole units";
    EXPECT_EQ(l.dissipated.friction + l.dissipated.rolling, 0);
    EXPECT_NEAR(l.kinetic / energy, -1, 1e-9);
    EXPECT_NEAR(l.integrationError / energy, 0, 1e-6);
  }
}

TEST(LedgerOfOneGrain, BallCaughtInACornerLosesAtBothWalls) {
  // Two planes at right angles: the contacts are independent.
  const std::string corner = planeThrough("[0, 0, 0]", "[1, 0, 1]") + planeThrough("[0, 0, 0]", "[-1, 0, 1]");
  const Ledger l = after(material(0, 0, kCritical) + corner +
                             ballAt(fmt::format("[0, 0, {:.17g}]", kRadius * std::sqrt(2.0)), "velocity = [0, 0, -1]"),
                         0.02, 2e-5, "gravity = [0, 0, 0]\nprecision = \"double\"");
  EXPECT_NEAR(l.dissipated.damping / (0.5 * ballMass()), 1, 1e-5) << "each begins within a unit of the other";
  EXPECT_NEAR(l.integrationError / (0.5 * ballMass()), 0, 1e-5);
}

/// A ball on a plane, its weight supported, with an initial velocity.
Ledger pushed(const std::string& motion, const std::string& more, double duration, double step, double stiffness) {
  return after(material(0.2, 1, more, stiffness) + oneBall(kRadius - ballMass() * kGravity / stiffness, motion),
               duration, step);
}

TEST(LedgerOfOneGrain, BallThatSticksAndRollsOnLosesTheEnergyOfItsSlip) {
  // The slip v of the contact point oscillates with the mass 1 / (1/m + a^2 / I), lever arm a, and decays.
  const double k = 1e4, arm = (1 - ballMass() * kGravity / k / kRadius), share = 1 / (1 + 2.5 * arm * arm);
  const double energy = 0.5 * share * ballMass() * 0.004 * 0.004;
  for (const double step : {5e-5, 1e-5}) {
    const Ledger l = pushed("velocity = [0.004, 0, 0]", "tangential_damping_ratio = 1", 0.1, step, k);
    EXPECT_NEAR(l.dissipated.damping / energy, 1, 2e-3) << step << ": an arm shorter by a thousandth";
    EXPECT_EQ(l.dissipated.friction + l.dissipated.rolling, 0) << "it sticks";
    EXPECT_NEAR(l.kinetic / energy, -1, 2e-3);
    EXPECT_LT(std::fabs(l.integrationError), 2e-3 * energy);
  }
}

TEST(LedgerOfOneGrain, BallThatSwingsOnItsRollingSpringLosesAllOfItsEnergy) {
  // Rolling so slowly that its resistance stays below the limit: it swings to rest, with its springs as at the start.
  const double k = 1e4, arm = kRadius - ballMass() * kGravity / k,
               rate = std::sqrt(2.25 * k * 0.25 / (1.4 * ballMass()));
  const double spin = 0.3 * rate * ballMass() * kGravity / (2.25 * k * 0.5 * kRadius);
  const double energy = 0.5 * ballMass() * spin * spin * (arm * arm + 0.4 * kRadius * kRadius);
  const Ledger l = pushed(fmt::format("velocity = [{:.17g}, 0, 0]\nspin = [0, {:.17g}, 0]", spin * arm, spin),
                          "rolling_friction = 0.5\nrolling_damping_ratio = 0.5", 0.3, 1e-5, k);
  EXPECT_NEAR(l.kinetic / energy, -1, 1e-4) << "it is at rest";
  EXPECT_GT(l.dissipated.rolling, 0.3 * energy);
  EXPECT_GT(l.dissipated.damping, 0.3 * energy);
  EXPECT_EQ(l.dissipated.friction, 0);
  EXPECT_NEAR(l.dissipated.total() / energy, 1, 0.02) << "each assumes that it alone rotates the ball in the step";
  EXPECT_LT(std::fabs(l.integrationError), 0.02 * energy);
}

TEST(LedgerOfOneGrain, BallThatFliesUpAndDownHasExchangedItsEnergyTwice) {
  // Thrown up at 1 m/s until it returns: m v^2 / 2 there and back, while the total work is 0.
  const double energy = 0.5 * ballMass();
  const Ledger l = after(material(0.5, 0) + ballAt("[0, 0, 1]", "velocity = [0, 0, 1]"), 2 / kGravity, 1e-5);
  EXPECT_NEAR(l.turnover / energy, 2, 1e-4) << "20,000 steps; the speed reverses in one";
  EXPECT_NEAR(l.work / energy, 0, 2e-4);
  EXPECT_NEAR(l.potential / energy, 0, 2e-4);
}

TEST(LedgerOfOneGrain, FallLeavesOverNoMoreThanTheQuantaOfItsBooks) {
  // From one speed to the next, the same gain is rounded the same way: 40 bits of 1 to 2 m/s, 20,000 times, are
  // 2e-10 J. The ledger stores a step's work in whole quanta, 2^-50 of k R^2 or so.
  const double k = 100;
  const Ledger l = after(material(0.5, 0, "", k) + ballAt("[0, 0, 1]", "velocity = [0, 0, -1]"), 0.1, 5e-6);
  EXPECT_LT(std::fabs(l.residual), 1e-13);
  EXPECT_GT(l.turnover, 1e-2);
}

/// 120 grains of two sizes and materials fall into a box far from the origin, onto a sloping floor.
std::string mixedBox() {
  std::string text = material(0.5, 0.5, "rolling_friction = 0.1") +
                     "[material.stone]\ndensity = 4000\nstiffness = 2e5\nrestitution = 0.3\nfriction = 0.3\n"
                     "rolling_friction = 0.2\n";
  for (const char* kind : {"number = 80\nradius = 0.004\nmaterial = \"soil\"\nlow = [0.3, -0.5, 0.2]\n"
                           "high = [0.36, -0.44, 0.32]\nvelocity = [0.5, -0.3, -1]",
                           "number = 40\nradius = 0.006\nmaterial = \"stone\"\nlow = [0.3, -0.5, 0.33]\n"
                           "high = [0.36, -0.44, 0.45]\nvelocity = [-0.4, 0.2, -2]"})
    text += std::string("[[grains]]\nform = \"random\"\n") + kind + "\n";
  return text + planeThrough("[0.3, 0, 0]", "[1, 0, 0]") + planeThrough("[0.36, 0, 0]", "[-1, 0, 0]") +
         planeThrough("[0, -0.5, 0]", "[0, 1, 0]") + planeThrough("[0, -0.44, 0]", "[0, -1, 0]") +
         planeThrough("[0.33, -0.47, 0.18]", "[0, 0.1, 1]");
}

TEST(LedgerOfGrains, OfManySizesBalancesInEnergyAndMomenta) {
  const auto simulation = made(sceneOf(mixedBox(), 0.15, 1e-5));
  while (simulation->steps() < 15000) simulation->step();
  const Ledger l = simulation->ledger();
  const double mass = 80 * 2500 * 4.0 / 3 * base::kPi * 6.4e-8 + 40 * 4000 * 4.0 / 3 * base::kPi * 2.16e-7;
  EXPECT_LT(std::fabs(l.residual), 1e-9 * l.turnover);
  EXPECT_LT(std::fabs(l.integrationError), 0.05 * l.dissipated.total());
  EXPECT_GT(l.dissipated.rolling, 0.001 * l.dissipated.total());
  // Relative to the impulse of the weight; the ledger stores masses as 30 bits of the largest.
  EXPECT_LT(norm(l.momentumResidual), 1e-8 * mass * kGravity * 0.15);
  EXPECT_LT(norm(l.angularResidual), 1e-8 * mass * kGravity * 0.15 * 0.6) << "at 0.6 m";
}

/// Two balls slide and bounce on a block that moves and turns, far from the origin; `head`: kind of surface.
std::string onABlock(const std::string& head) {
  return material(0.3, 0.6, "rolling_friction = 0.1") + head +
         "position = [0.5, -0.3, 0.15]\naxis = [0, 0, 1]\nangle = 20\nmaterial = \"soil\"\nname = \"block\"\n"
         "velocity = [0.05, 0, 0.02]\nspin = [0, 0, 2]\n" +
         ballAt("[0.51, -0.3, 0.2101]") + ballAt("[0.48, -0.29, 0.23]", "velocity = [0.1, 0.05, 0]");
}

TEST(LedgerOfSurfaces, MomentaBalanceWithWhatMoves) {
  const std::string box = "[[box]]\nsize = [0.1, 0.1, 0.1]\n",
                    plane = planeThrough("[0.5, 0, 0.19]", "[0, 0, 1]", "velocity = [0.02, 0, 0.01]");
  for (const std::string& things : {onABlock(box), onABlock(box) + plane}) {
    const Ledger l = after(things, 0.2, 2e-5);
    const double impulse = 2 * ballMass() * kGravity * 0.2;
    EXPECT_GT(l.dissipated.friction, 0) << "the block drags the balls";
    EXPECT_NE(l.driveWork, 0);
    EXPECT_LT(norm(l.momentumResidual), 1e-9 * impulse);
    EXPECT_LT(norm(l.angularResidual), 1e-8 * impulse * 0.6) << "at 0.6 m; torques are whole quanta of surfaces";
    EXPECT_LT(std::fabs(l.residual), 1e-8 * l.turnover) << "kinetic energies have whole quanta of 1e-12 J";
  }
}

const std::string kLid = "[[box]]\nname = \"lid\"\nposition = [0, 0, 1]\nsize = [0.1, 0.1, 0.02]\nmaterial = \"soil\"\n"
                         "free = \"z\"\nmass = 2\nload = -50\n";

TEST(LedgerOfSurfaces, LidThatFallsUnderItsLoadGainsWhatWeightAndLoadGive) {
  // In 0.3 s it reaches 34.81 m/s2 0.3 s; load and weight contribute their shares of that energy.
  const double speed = (25 + kGravity) * 0.3, energy = 0.5 * 2 * speed * speed;
  for (const double step : {1e-4, 2e-5}) {
    const Ledger l = after(material(0.5, 0.5) + kLid + ballAt("[1, 0, 0]"), 0.3, step, "gravity = [0, 0, -9.81]");
    const double ball = 0.5 * ballMass() * kGravity * kGravity * 0.09;
    EXPECT_NEAR(l.driveWork / energy, 25 / (25 + kGravity), 1e-9) << step;
    EXPECT_NEAR((l.kinetic - ball) / energy, 1, 1e-9);
    EXPECT_NEAR((l.turnover - ball) / energy, 1, 1e-9) << "all work is positive";
    EXPECT_NEAR(l.integrationError / energy, 0, 2 * step / 0.3) << "error of the positions alone";
  }
}

TEST(RestoredBooks, GoOnWithTheSameNumbers) {
  bool negative = false;
  const std::string box = "[[box]]\nsize = [0.1, 0.1, 0.1]\n";
  for (const std::string& things : {mixedBox(), onABlock(box), material(0.5, 0.5) + oneBall(0.02, "")}) {
    const scene::Scene scene = sceneOf(things, 0.2, 1e-5);
    const auto straight = made(scene), first = made(scene);
    while (straight->steps() < 12000) straight->step();
    while (first->steps() < 7400) first->step();
    Simulation second(setup::simulationSetup(scene), base::cpuExec(1), first->save());
    EXPECT_EQ(second.ledger().counted(), first->ledger().counted());
    while (second.steps() < 12000) second.step();
    const Ledger a = straight->ledger(), b = second.ledger();
    EXPECT_EQ(a.counted(), b.counted());
    EXPECT_EQ(a.residual, b.residual);
    EXPECT_EQ(a.integrationError, b.integrationError);
    negative = negative || a.work < 0;
  }
  EXPECT_TRUE(negative) << "the ledger holds negative sums for grains that come to rest";
}

std::unique_ptr<Simulation> vehicleOf(const std::string& scene, const std::vector<std::string>& overrides, double end) {
  auto s = made(setup::loadScene(std::string(GROUSER_SOURCE_DIR) + "/tests/scenes/" + scene, overrides));
  while (s->time() < end - 0.5 * s->timeStep()) s->step();
  return s;
}

TEST(LedgerOfAVehicle, OnItsBedBalancesInMomenta) {
  const auto s = vehicleOf("coupled.toml", {"vehicle.sphere_radius=0.03"}, 0.08);
  const Ledger l = s->ledger();
  const double impulse = s->vehicle()->assembly().mass * kGravity * 0.08;
  EXPECT_GT(norm(s->vehicle()->contacts().ledger().impulseOnParts), 0.01 * impulse) << "the bed supports it";
  EXPECT_LT(norm(l.momentumResidual), 1e-8 * impulse);
  EXPECT_LT(norm(l.angularResidual), 1e-8 * impulse * 3) << "at 3 m";
  EXPECT_LT(std::fabs(l.residual), 1e-8 * l.turnover);
}

TEST(LedgerOfAVehicle, OnRigidGroundCountsWhatItsPartsHoldAndLose) {
  const std::vector<std::string> coarse = {"vehicle.sphere_radius=0.02"};
  // Its shoes press on its wheels from the start: the first step does not create that energy.
  const auto begun = vehicleOf("rigid.toml", coarse, 1e-4);
  EXPECT_GT(begun->vehicle()->contacts().ledger().elastic(), 0.05);
  EXPECT_LT(std::fabs(begun->ledger().elastic), 1e-3);
  // After 0.2 s the track is taut and the weight is applied.
  const auto s = vehicleOf("rigid.toml", coarse, 0.2);
  const Ledger l = s->ledger();
  const double held = s->vehicle()->contacts().ledger().elastic();
  EXPECT_GT(held, 1);
  EXPECT_GT(l.dissipated.parts, 0.5);
  EXPECT_LT(std::fabs(l.integrationError), 0.02 * (held + l.dissipated.parts)) << "at 1e-4 s";
  EXPECT_LT(std::fabs(l.residual), 1e-9 * l.turnover);
  const multibody::Balance b = s->vehicle()->bodiesBalance();
  EXPECT_NEAR(l.elastic, b.elasticGain + held, 0.3) << "except for the energy stored at the start";
}

} // namespace
} // namespace grouser::coupling::ledgers
