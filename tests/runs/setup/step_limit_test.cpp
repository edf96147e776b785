// SPDX-License-Identifier: BSD-3-Clause
// The longest stable step of each mode that contacts make, against its closed form; and what it is blamed on.
#include "runs/setup/step_limit.hpp"

#include "base/math.hpp"
#include "contact/restitution.hpp"
#include "runs/setup/load_scene.hpp"
#include "vehicle/spec_file.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace grouser::setup {
namespace {

/// Steps the mode x'' + c x' + k x = 0 from x = v = 1 and tells how far it comes, or how fast.
double farthest(double k, double c, double dt) {
  double x = 1, v = 1, most = 0;
  for (int i = 0; i < 20000; ++i) {
    v -= dt * (k * x + c * v), x += dt * v;
    if (i > 15000) most = std::max({most, std::fabs(x), std::fabs(v)});
    if (!(std::fabs(x) < 1e9)) return 1e9;
  }
  return most;
}

TEST(StepOfAMode, IsWhereTheRecurrenceBeginsToGrow) {
  for (const double k : {0.0, 1.0, 400.0})
    for (const double c : {0.0, 0.3, 5.0, 60.0}) {
      if (k == 0 && c == 0) continue;
      const double limit = contact::stableStepOfMode(k, c);
      EXPECT_LT(farthest(k, c, 0.999 * limit), 1e3) << k << " " << c;
      EXPECT_GT(farthest(k, c, 1.001 * limit), 1e6) << k << " " << c;
    }
  // k dt^2 + 2 c dt = 4.
  EXPECT_NEAR(contact::stableStepOfMode(400, 0), 0.1, 1e-15);
  EXPECT_NEAR(contact::stableStepOfMode(0, 5), 0.4, 1e-15);
  EXPECT_NEAR(400 * 0.05 * 0.05 + 2 * 30 * 0.05, 4, 1e-15);
  EXPECT_NEAR(contact::stableStepOfMode(400, 30), 0.05, 1e-15);
  EXPECT_NEAR(contact::stableStep(20, 0.75), 0.05, 1e-15) << "the same, by omega and zeta";
}

constexpr double kRadius = 0.02, kStiffness = 3e5;
const double kMass = 2000 * 4.0 / 3 * base::kPi * kRadius * kRadius * kRadius;

/// One grain of 'soil', and a plane of 'hard' where it is asked for.
struct Bed {
  std::string soil = "density = 2000\nstiffness = 3e5\nrestitution = 1\nfriction = 0\n", hard, pair, more;
  bool plane = false;

  scene::Scene scene() const {
    return parseScene("version = 1\n[run]\nduration = 1\nimpact_speed = 1.5\n[material.soil]\n" + soil +
                          "[material.hard]\n" + (hard.empty() ? soil : hard) + pair +
                          "[[grain]]\nposition = [0, 0, 1]\nradius = 0.02\nmaterial = \"soil\"\n" +
                          (plane ? "[[plane]]\nmaterial = \"hard\"\n" : "") + more,
                      "bed.toml");
  }
  StepLimit limit() const { return stepLimit(scene()); }
};

double undamped(double stiffness) { return 2 / std::sqrt(stiffness); }
double damped(double stiffness, double damping) {
  return (std::sqrt(damping * damping + 4 * stiffness) - damping) / stiffness;
}

TEST(StepLimit, OfAGrainAmongTwelveIsEightSpringsOnItsMass) {
  const StepLimit limit = Bed{}.limit();
  EXPECT_NEAR(limit.step / undamped(8 * kStiffness / kMass), 1, 1e-9);
  EXPECT_EQ(limit.what, "grain on grain of 'soil'");
  EXPECT_EQ(limit.remedy, "lower its stiffness");
}

TEST(StepLimit, OfDampedGrainsHasEightDashpotsOfThePairsMass) {
  Bed bed;
  bed.soil = "density = 2000\nstiffness = 3e5\ndamping = 9000\nfriction = 0\n";
  // c = gamma m / 2 of a pair, eight of them on m.
  EXPECT_NEAR(bed.limit().step / damped(8 * kStiffness / kMass, 8 * 9000.0 / 2), 1, 1e-9);
}

TEST(StepLimit, OfAGrainBetweenTwoPlanesIsTwoSprings) {
  Bed bed;
  bed.plane = true, bed.pair = "[contact.\"soil|hard\"]\nstiffness = 6e6\n";
  const StepLimit limit = bed.limit();
  EXPECT_NEAR(limit.step / undamped(2 * 6e6 / kMass), 1, 1e-9);
  EXPECT_EQ(limit.what, "grain on a plane of 'hard'");
  bed.pair += "damping = 9000\n"; // of the whole mass now
  EXPECT_NEAR(bed.limit().step / damped(2 * 6e6 / kMass, 2 * 9000.0), 1, 1e-9);
}

TEST(StepLimit, OfGrainsThatStickAndTurnAlikeIsEightTimesTenThirds) {
  Bed bed;
  bed.soil = "density = 2000\nstiffness = 3e5\ndamping = 4000\nfriction = 0.5\ntangential_stiffness_ratio = 0.9\n"
             "tangential_damping_ratio = 0.8\n";
  const double turning = 8 * 10.0 / 3;
  EXPECT_NEAR(bed.limit().step / damped(turning * 0.9 * kStiffness / kMass, turning * 0.8 * 4000.0 / 2), 1, 1e-9);
  bed.soil = "density = 2000\nstiffness = 3e5\ndamping = 4000\nfriction = 0\ntangential_stiffness_ratio = 0.9\n";
  EXPECT_NEAR(bed.limit().step / damped(8 * kStiffness / kMass, 4 * 4000.0), 1, 1e-9) << "without friction none of it";
}

TEST(StepLimit, OfAGrainThatTurnsBetweenTwoPlanesIsFiveTangentialSprings) {
  Bed bed;
  bed.plane = true;
  bed.soil = "density = 2000\nstiffness = 3e5\nrestitution = 1\nfriction = 0.5\ntangential_stiffness_ratio = 0.8\n";
  bed.pair = "[contact.\"soil|hard\"]\nstiffness = 6e6\n";
  EXPECT_NEAR(bed.limit().step / undamped(5 * 0.8 * 6e6 / kMass), 1, 1e-9);
}

TEST(StepLimit, OfRollingIsTheSpringOfAnglesOnTheMomentOfInertia) {
  Bed bed;
  bed.soil = "density = 2000\nstiffness = 3e5\nrestitution = 1\nfriction = 0.5\nrolling_friction = 0.9\n"
             "tangential_stiffness_ratio = 0.1\nrolling_damping_ratio = 0\n";
  // k_r = 2.25 k (mu_r R / 2)^2, eight of them on 0.4 m R^2.
  const double inertia = 0.4 * kMass * kRadius * kRadius, arm = 0.9 * kRadius / 2;
  const double spring = 2.25 * kStiffness * arm * arm;
  ASSERT_GT(8 * spring / inertia, 8 * kStiffness / kMass);
  EXPECT_NEAR(bed.limit().step / undamped(8 * spring / inertia), 1, 1e-9);
  bed.soil.replace(bed.soil.find("ratio = 0\n"), 10, "ratio = 0.3\n");
  // Critical damping of the pair: 2 sqrt(I_r k_r), I_r = 1.4 (m / 2) R^2.
  const double dashpot = 2 * 0.3 * std::sqrt(1.4 * kMass / 2 * kRadius * kRadius * spring);
  EXPECT_NEAR(bed.limit().step / damped(8 * spring / inertia, 8 * dashpot / inertia), 1, 1e-9);
}

TEST(StepLimit, OfHertzGrainsIsThatOfAnImpactAtTheGivenSpeed) {
  Bed bed;
  bed.soil = "law = \"hertz\"\nyoung = 5e7\npoisson = 0.25\ndensity = 2000\nrestitution = 1\nfriction = 0\n";
  const double modulus = 5e7 / (1 - 0.0625) / 2, m = kMass / 2, R = kRadius / 2;
  // Energy: m v^2 / 2 = (8/15) E sqrt(R) d^(5/2).
  const double deepest = std::pow(15 * m * 1.5 * 1.5 / (16 * modulus * std::sqrt(R)), 0.4), a = std::sqrt(R * deepest);
  EXPECT_NEAR(bed.limit().step / undamped(8 * 2 * modulus * a / kMass), 1, 1e-9);
  bed.soil.replace(bed.soil.find("friction = 0"), 12, "friction = 0.5");
  // G = E / (2 (1 + nu)), 1 / G_eff = 2 (2 - nu) / G, k_t = 8 G_eff a; four contacts at once turn it.
  const double shear = 5e7 / 2.5, tangential = 8 * shear / (2 * 1.75) * a;
  EXPECT_NEAR(bed.limit().step /
                  std::min(undamped(8 * 2 * modulus * a / kMass), undamped(4 * 10.0 / 3 * tangential / kMass)),
              1, 1e-9);
}

TEST(StepLimit, OfAFreeSurfaceCountsTheGrainsThatMayLieOnIt) {
  Bed bed;
  bed.more =
      "[[grains]]\nform = \"lattice\"\nlow = [0, 0, 2]\nhigh = [0.5, 0.5, 2.5]\nradius = 0.02\nmaterial = \"soil\"\n"
      "[[box]]\nname = \"lid\"\nposition = [0, 0, 5]\nsize = [0.3, 0.2, 0.01]\nfree = \"z\"\nmass = 1e-3\n"
      "material = \"soil\"\n";
  const StepLimit limit = bed.limit();
  // A dense layer on its largest face: 2 sqrt(3) R^2 a grain.
  const double grains = 0.3 * 0.2 / (2 * std::sqrt(3.0) * kRadius * kRadius);
  EXPECT_NEAR(limit.step / undamped(kStiffness * (1 / kMass + grains / 1e-3)), 1, 1e-9);
  EXPECT_EQ(limit.remedy, "raise box.0.mass");
  bed.more.replace(bed.more.find("[[box]]"), std::string::npos,
                   "[[box]]\nname = \"lid\"\nposition = [0, 0, 5]\nsize = [0.01, 0.02, 0.01]\nfree = \"z\"\n"
                   "mass = 1e-4\nmaterial = \"soil\"\n");
  EXPECT_NEAR(bed.limit().step / undamped(kStiffness * (1 / kMass + 1 / 1e-4)), 1, 1e-9) << "one at least";
}

TEST(StepLimit, OfAShoeIsItsWholePadOnItsMass) {
  const StepLimit limit = stepLimit(loadScene(std::string(GROUSER_SOURCE_DIR) + "/tests/scenes/rigid.toml"));
  const vehicle::VehicleSpec spec = vehicle::readVehicleSpec(GROUSER_SOURCE_DIR "/assets/vehicles/light_tracked.toml");
  // Pads of 136 x 280 mm, shoes of 8.5 kg.
  const double springs = spec.contact.foundationModulus * 0.136 * 0.28 / 8.5;
  EXPECT_NEAR(limit.step / damped(springs, springs * spec.contact.relaxationTime), 1, 1e-9);
  EXPECT_EQ(limit.what, "shoe on rigid ground or wheel");
}

TEST(StepLimit, IsThatOfTheSmallestGrainOfAMaterial) {
  Bed bed;
  bed.more = "[[grain]]\nposition = [1, 0, 1]\nradius = 0.005\nmaterial = \"soil\"\n";
  EXPECT_NEAR(bed.limit().step / undamped(8 * kStiffness / (kMass / 64)), 1, 1e-9);
}

TEST(ShortestContact, IsHalfASwingOfThePairsMassOrOfAWholeGrain) {
  Bed bed;
  EXPECT_NEAR(shortestContact(bed.scene()) / (base::kPi * std::sqrt(kMass / 2 / kStiffness)), 1, 1e-9);
  bed.plane = true, bed.pair = "[contact.\"soil|hard\"]\nstiffness = 6e6\n";
  EXPECT_NEAR(shortestContact(bed.scene()) / (base::kPi * std::sqrt(kMass / 6e6)), 1, 1e-9);
  bed.plane = false, bed.pair = "";
  bed.soil = "law = \"hertz\"\nyoung = 5e7\npoisson = 0.25\ndensity = 2000\nrestitution = 1\nfriction = 0\n";
  const double modulus = 5e7 / (1 - 0.0625) / 2, m = kMass / 2, R = kRadius / 2;
  const double deepest = std::pow(15 * m * 1.5 * 1.5 / (16 * modulus * std::sqrt(R)), 0.4);
  // 4 sqrt(pi) Gamma(2/5) / (5 Gamma(9/10)) deepest / v
  const double factor = 4 * std::sqrt(base::kPi) * std::tgamma(0.4) / (5 * std::tgamma(0.9));
  EXPECT_NEAR(shortestContact(bed.scene()) / (factor * deepest / 1.5), 1, 1e-9);
}

} // namespace
} // namespace grouser::setup
