// SPDX-License-Identifier: BSD-3-Clause
// A grain that crushes on a part: the force plateau, dissipation, elastic rebound, order of
// convergence.
#include "contact/crushing.hpp"

#include "contact/grain_part_contacts.hpp"
#include "part_fixture.hpp"
#include "tests/device_under_test.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

namespace grouser::contact::testing {
namespace {

using base::Vec3d;

constexpr double kRadius = 0.01, kMass = 0.01, kStiffness = 1e5;
constexpr double kYield = 1e-3;                              // elastic overlap at the cap [m]
constexpr double kCap = kStiffness * kYield;                 // 100 N
constexpr double kStrength = kCap / (4 * kRadius * kRadius); // 2.5e5 Pa
constexpr double kFloat = 1e-6;                              // forces and overlaps are float
constexpr double kPlace = 2e-5;                              // overlaps of 1 mm are differences of 10 mm

/// One grain under a plate; the test sets the motion of the plate.
struct Press {
  base::SphereSet set = plate(0.05, 0.004, 0.004);
  GrainPartModel model;
  base::Exec exec = testExec();
  std::unique_ptr<GrainPartContacts> contacts;
  base::Array<PartLoad> loads;

  explicit Press(double strength = kStrength, double damping = 0, double timeStep = 1e-5) {
    model.radius = kRadius, model.mass = kMass, model.timeStep = timeStep, model.margin = 0.02;
    model.law.stiffness = kStiffness, model.law.damping = damping;
    model.scale = base::positionScale(2 * kRadius);
    model.force = model.torque = base::fixedPointFor(kStiffness * kRadius, 36);
    model.energy = base::fixedPointFor(kStiffness * kRadius * kRadius, 40);
    contacts = std::make_unique<GrainPartContacts>(
        exec, model, std::vector<const base::SphereSet*>{&set}, std::vector<GrainPart>{{0, {}, {}}}, base::Comm{},
        GrainPartMaterials{{model.law}, {kMass / (kRadius * kRadius * kRadius)}, {strength}});
    loads = base::Array<PartLoad>(exec, 1);
  }

  /// Force on the grain with its centre at height z above the plate, moving at `speed` along z.
  double force(double z, double speed = 0) {
    const base::Array<base::Position> position(exec, std::vector{model.scale.fromMetres({0, 0, z})});
    const base::Array<Motion> flight(exec, std::vector{Motion{{0, 0, static_cast<float>(speed), 0}, {}}});
    const base::Array<std::uint32_t> id(exec, 1);
    const GrainsView grains{position.data(), flight.data(), id.data(), 1};
    const base::Array<PartMotion> motion(exec, std::vector{atRest({})});
    contacts->refresh(grains, motion);
    loads.zero();
    contacts->compute(grains, motion, loads.data());
    return -model.force.value(loads.at(0).force.z);
  }
  /// The same at this depth, reached in one step.
  double pressTo(double depth) {
    const double speed = (depth - depth_) / model.timeStep;
    depth_ = depth;
    return force(kRadius - depth, -speed);
  }

private:
  double depth_ = 0;
};

TEST(Crushing, ForceOverDepthHasItsPlateauAtSigmaTimesDiameterSquaredAndUnloadsAlongTheSpring) {
  Press press;
  for (double depth = 1e-4; depth < 5e-3; depth += 1e-4)
    EXPECT_NEAR(press.force(kRadius - depth), std::min(kStiffness * depth, kCap), kPlace * kCap) << depth;
  // At an overlap of 4.9 mm its dent is 3.9 mm.
  for (double depth = 4.9e-3; depth > 0; depth -= 1e-4)
    EXPECT_NEAR(press.force(kRadius - depth), std::max(0.0, kStiffness * (depth - 3.9e-3)), kPlace * kCap) << depth;
}

TEST(Crushing, WorkIsWhatIsHeldAndWhatIsDissipated) {
  Press press;
  // Spring and plateau are straight lines: their work is exact at any step.
  const double depth = 4.3e-3;
  for (const double d : {0.4e-3, 1.7e-3, 2.1e-3, depth}) press.pressTo(d);
  GrainPartContacts::Ledger l = press.contacts->ledger();
  EXPECT_NEAR(l.elastic, 0.5 * kCap * kYield, kPlace * kCap * kYield);
  EXPECT_NEAR(l.crushed, kCap * (depth - kYield), kPlace * kCap * kYield);
  EXPECT_EQ(l.capped, 1);
  // Back to half of the elastic overlap: a quarter is stored, no further loss.
  const double lost = l.crushed;
  press.pressTo(depth - 0.5 * kYield);
  l = press.contacts->ledger();
  EXPECT_NEAR(l.elastic, 0.125 * kCap * kYield, kPlace * kCap * kYield);
  EXPECT_EQ(l.crushed, lost);
  EXPECT_EQ(l.capped, 0);
  // Reloaded to the same overlap: the same point on the plateau.
  press.pressTo(depth);
  l = press.contacts->ledger();
  EXPECT_NEAR(l.elastic, 0.5 * kCap * kYield, kPlace * kCap * kYield);
  EXPECT_NEAR(l.crushed, lost, kPlace * kCap * kYield);
}

TEST(Crushing, CountsTheImpulseThatTheSpringWouldHaveGivenMore) {
  Press press;
  press.force(kRadius - 0.9e-3);
  EXPECT_EQ(press.contacts->ledger().cutImpulse, 0);
  press.force(kRadius - 3e-3), press.force(kRadius - 4e-3);
  const double cut = (kStiffness * 3e-3 - kCap) + (kStiffness * 4e-3 - kCap);
  EXPECT_NEAR(press.contacts->ledger().cutImpulse, cut * press.model.timeStep, kPlace * kCap * press.model.timeStep);
}

TEST(Crushing, TheDashpotAddsToTheSpringUpToTheCapAndNotBeyond) {
  const double damping = 2000; // times 0.01 kg: 20 N s/m
  for (const double speed : {0.0, -0.5, -1.0, -3.0, -30.0}) {
    Press press(kStrength, damping);
    const double depth = 0.7e-3, wanted = kStiffness * depth + damping * kMass * -speed;
    EXPECT_NEAR(press.force(kRadius - depth, speed), std::min(wanted, kCap), kPlace * kCap) << speed;
  }
}

TEST(Crushing, ABlowBeyondTheCapConvergesToItsRestitution) {
  // A hundredth of the strength: F_c = 25 N, y = 0.25 mm; 3.125 mJ of 20 mJ are stored.
  const double strength = kStrength / 4, cap = kCap / 4, wanted = 0.5 * cap * cap / kStiffness / (0.5 * kMass * 4);
  const auto error = [&](double timeStep) {
    double worst = 0; // over several phases of first touch
    for (const double start : {0.11, 0.37, 0.58, 0.83}) {
      Press press(strength, 0, timeStep);
      double z = kRadius + start * 2 * timeStep, v = -2;
      do {
        v += press.force(z, v) * timeStep / kMass;
        z += v * timeStep;
      } while (v < 0 || press.contacts->ledger().elastic > 0);
      worst = std::max(worst, std::fabs(v * v / 4 - wanted));
    }
    return worst;
  };
  const double coarse = error(8e-6), fine = error(2e-6);
  EXPECT_LT(coarse, 0.02);
  EXPECT_GT(coarse / fine, 3) << "first order: a quarter of the step, a quarter of the error";
  EXPECT_LT(fine, 0.25 * 0.02);
}

TEST(Crushing, HertzYieldsAtTheSameForceAndHoldsTwoFifthsOfItsWork) {
  ContactLaw law;
  law.hertz = true, law.stiffness = 1e7; // 4/3 E_eff
  const Crushing crushing = crushingOf(kStrength, law);
  const BasicLaw<float> single = law.as<float>();
  const float r = static_cast<float>(kRadius);
  float dent = 0;
  const Yielded y = yieldContact<kGeneral>(crushing, single, 4e-3f, 400, 1e-5f, 1, r, dent);
  EXPECT_TRUE(y.capped);
  const auto c = coefficientsOf<kGeneral>(single, y.overlap, 1.0f, r);
  EXPECT_NEAR(static_cast<double>(c.elastic), kCap, 10 * kFloat * kCap);
  EXPECT_NEAR(static_cast<double>(dent + y.overlap), 4e-3, 1e-9);
  EXPECT_NEAR(static_cast<double>(y.dissipated), kCap * static_cast<double>(dent), 10 * kFloat * kCap * 4e-3);
  EXPECT_NEAR(storedEnergy(single, static_cast<double>(y.overlap), kRadius, {}),
              0.4 * kCap * static_cast<double>(y.overlap), 10 * kFloat * kCap * 4e-3);
}

TEST(Crushing, WhatPullsIsTakenOffWhatTheGrowingDentDissipates) {
  ContactLaw law;
  law.stiffness = kStiffness, law.pullPerRadius = 1000; // 10 N
  float dent = 0;
  const Yielded y = yieldContact<kGeneral>(crushingOf(kStrength, law), law.as<float>(), 3e-3f, 300, 1e-5f, 1,
                                           static_cast<float>(kRadius), dent);
  EXPECT_NEAR(static_cast<double>(y.dissipated), (kCap - 10) * 2e-3, 10 * kFloat * kCap * 3e-3);
}

TEST(Crushing, AContactThatIsDeeperAtOnceThanItHasComeDissipatesNothingForIt) {
  Press press;
  EXPECT_NEAR(press.force(kRadius - 3e-3), kCap, kPlace * kCap);
  EXPECT_EQ(press.contacts->ledger().crushed, 0) << "at rest";
  press.force(kRadius - 4e-3, -0.1);
  EXPECT_NEAR(press.contacts->ledger().crushed, kCap * 0.1 * press.model.timeStep, kPlace * kCap * kYield);
}

TEST(Crushing, DentsAreSavedHashedAndRestored) {
  Press press, other;
  press.force(kRadius - 3e-3);
  const SavedGrainPatches saved = press.contacts->save();
  ASSERT_EQ(saved.dents.size(), 1u);
  EXPECT_NEAR(static_cast<double>(saved.dents[0]), 2e-3, 1e-8);
  SavedGrainPatches changed = saved;
  changed.dents[0] = 0;
  EXPECT_NE(changed.words(), saved.words());
  other.contacts->restore(saved);
  EXPECT_EQ(other.force(kRadius - 2.5e-3), press.force(kRadius - 2.5e-3));
  EXPECT_NEAR(other.force(kRadius - 2.5e-3), kStiffness * 0.5e-3, kPlace * kCap);
  EXPECT_TRUE(Press(0).contacts->save().dents.empty());
}

TEST(Crushing, AStrengthThatIsNeverReachedChangesNoBit) {
  Press with(1e9), without(0);
  for (double depth = 1e-4; depth < 5e-3; depth += 1.7e-4)
    EXPECT_EQ(with.force(kRadius - depth, -0.1), without.force(kRadius - depth, -0.1));
}

} // namespace
} // namespace grouser::contact::testing
