// SPDX-License-Identifier: BSD-3-Clause
// The longest stable step of each contact mode against its closed form; and the reported cause.
#include "runs/setup/step_limit.hpp"

#include "base/error.hpp"
#include "base/math.hpp"
#include "contact/restitution.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/load_scene.hpp"
#include "tests/vehicle/spec_variant.hpp"
#include "vehicle/spec_file.hpp"

#include <gtest/gtest.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace grouser::setup {
namespace {

/// Steps the mode x'' + c x' + k x = 0 from x = v = 1 and returns the largest displacement, or speed.
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

constexpr double kGrainRadius = 0.02, kStiffness = 3e5;
const double kMass = 2000 * 4.0 / 3 * base::kPi * kGrainRadius * kGrainRadius * kGrainRadius;

/// Two grains of 'soil', and optionally a plane of 'hard'.
struct Bed {
  std::string soil = "density = 2000\nstiffness = 3e5\nrestitution = 1\nfriction = 0\n", hard, pair, more;
  bool plane = false, alone = false;

  scene::Scene scene() const {
    return parseScene("version = 1\n[run]\nduration = 1\nimpact_speed = 1.5\n[material.soil]\n" + soil +
                          "[material.hard]\n" + (hard.empty() ? soil : hard) + pair +
                          "[[grain]]\nposition = [0, 0, 1]\nradius = 0.02\nmaterial = \"soil\"\n" +
                          (alone ? "" : "[[grain]]\nposition = [2, 0, 1]\nradius = 0.02\nmaterial = \"soil\"\n") +
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
  EXPECT_NEAR(limit.calm / limit.step, 1, 1e-9);
  EXPECT_EQ(limit.what, "grain on grain of 'soil'");
  EXPECT_EQ(limit.remedy, "lower its stiffness");
}

TEST(StepLimit, OfDashpotsThatOnlyPushIsFourAndAHalfOfThem) {
  Bed bed;
  bed.soil = "density = 2000\nstiffness = 3e5\ndamping = 9000\nfriction = 0\n";
  // c = gamma m / 2 of a pair; modes of a bed at rest have eight of them on m.
  EXPECT_NEAR(bed.limit().step / damped(8 * kStiffness / kMass, 4.5 * 9000.0 / 2), 1, 1e-9);
  EXPECT_NEAR(bed.limit().calm / damped(8 * kStiffness / kMass, 8 * 9000.0 / 2), 1, 1e-9);
  bed.soil += "attraction = true\n";
  EXPECT_NEAR(bed.limit().step / damped(8 * kStiffness / kMass, 6.5 * 9000.0 / 2), 1, 1e-9) << "random beds";
  EXPECT_NEAR(bed.limit().calm / damped(8 * kStiffness / kMass, 8 * 9000.0 / 2), 1, 1e-9) << "crystals";
}

TEST(StepLimit, OfAGrainOnAPlaneIsHalfOfItsImpacts) {
  Bed bed;
  bed.plane = true, bed.pair = "[contact.\"soil|hard\"]\nstiffness = 6e6\n";
  const StepLimit limit = bed.limit();
  EXPECT_NEAR(limit.step / (0.5 * undamped(6e6 / kMass)), 1, 1e-9);
  EXPECT_NEAR(limit.calm / undamped(2 * 6e6 / kMass), 1, 1e-9) << "between two planes";
  EXPECT_EQ(limit.what, "grain on a plane of 'hard'");
  bed.pair += "damping = 9000\n"; // refers to the whole mass now
  EXPECT_NEAR(bed.limit().step / (0.5 * damped(6e6 / kMass, 9000)), 1, 1e-9);
  EXPECT_NEAR(bed.limit().calm / damped(2 * 6e6 / kMass, 2 * 9000.0), 1, 1e-9);
}

TEST(StepLimit, OfAGrainAloneKnowsNoOthers) {
  Bed bed;
  bed.plane = bed.alone = true;
  EXPECT_NEAR(bed.limit().step / undamped(4 * kStiffness / kMass), 1, 1e-9);
  bed.alone = false;
  EXPECT_NEAR(bed.limit().step / undamped(8 * kStiffness / kMass), 1, 1e-9);
}

TEST(StepLimit, OfSlipIsHalfOfAnImpactsAndFrictionBoundsItsDashpot) {
  Bed bed;
  bed.soil = "density = 2000\nstiffness = 3e5\ndamping = 4000\nfriction = 0.5\ntangential_stiffness_ratio = 0.9\n"
             "tangential_damping_ratio = 0.8\n";
  // 30 k_t / m; 4.5 c / m, and 10 / m of the smaller of mu^2 c and c_t.
  const double c = 4000.0 / 2;
  EXPECT_NEAR(bed.limit().step / damped(30 * 0.9 * kStiffness / kMass, 4.5 * c + 10 * 0.25 * c), 1, 1e-9);
  bed.soil.replace(bed.soil.find("damping_ratio = 0.8"), 19, "damping_ratio = 0.1");
  EXPECT_NEAR(bed.limit().step / damped(30 * 0.9 * kStiffness / kMass, 4.5 * c + 10 * 0.1 * c), 1, 1e-9);
  bed.plane = true, bed.pair = "[contact.\"soil|hard\"]\nstiffness = 6e6\ndamping = 4000\n";
  EXPECT_NEAR(bed.limit().step / damped(15 * 0.9 * 6e6 / kMass, 2 * 4000.0 + 5 * 0.1 * 4000), 1, 1e-9);
}

TEST(StepLimit, CalmsWhereGrainsThatStickAndTurnAlikeDo) {
  Bed bed;
  bed.soil = "density = 2000\nstiffness = 3e5\ndamping = 4000\nfriction = 0.5\ntangential_stiffness_ratio = 0.9\n"
             "tangential_damping_ratio = 0.8\n";
  const double turning = 8 * 10.0 / 3;
  EXPECT_NEAR(bed.limit().calm / damped(turning * 0.9 * kStiffness / kMass, turning * 0.8 * 4000.0 / 2), 1, 1e-9);
  bed.soil = "density = 2000\nstiffness = 3e5\ndamping = 4000\nfriction = 0\ntangential_stiffness_ratio = 0.9\n";
  EXPECT_NEAR(bed.limit().calm / damped(8 * kStiffness / kMass, 4 * 4000.0), 1, 1e-9) << "no effect without friction";
  bed.plane = true;
  bed.soil = "density = 2000\nstiffness = 3e5\nrestitution = 1\nfriction = 0.5\ntangential_stiffness_ratio = 0.8\n";
  bed.pair = "[contact.\"soil|hard\"]\nstiffness = 6e6\n";
  EXPECT_NEAR(bed.limit().calm / undamped(5 * 0.8 * 6e6 / kMass), 1, 1e-9) << "between two planes";
}

TEST(StepLimit, OfRollingIsTheSpringOfAnglesOnTheMomentOfInertia) {
  Bed bed;
  bed.soil = "density = 2000\nstiffness = 3e5\nrestitution = 1\nfriction = 0.5\nrolling_friction = 2\n"
             "tangential_stiffness_ratio = 0.1\nrolling_damping_ratio = 0\n";
  // k_r = 2.25 k (mu_r R / 2)^2; at rest eight of them on 0.4 m R^2. The torque is
  // too large for Coulomb's limit to bound its energy, so the same limit holds for "step".
  const double inertia = 0.4 * kMass * kGrainRadius * kGrainRadius, arm = 2 * kGrainRadius / 2;
  const double spring = 2.25 * kStiffness * arm * arm;
  ASSERT_GT(2 * spring / inertia, 8 * kStiffness / kMass);
  EXPECT_NEAR(bed.limit().step / undamped(8 * spring / inertia), 1, 1e-9);
  EXPECT_NEAR(bed.limit().calm / undamped(8 * spring / inertia), 1, 1e-9);
  bed.soil.replace(bed.soil.find("ratio = 0\n"), 10, "ratio = 0.3\n");
  // Critical damping of the pair: 2 sqrt(I_r k_r), I_r = 1.4 (m / 2) R^2; elastic grains impose no bound.
  const double dashpot = 2 * 0.3 * std::sqrt(1.4 * kMass / 2 * kGrainRadius * kGrainRadius * spring);
  EXPECT_NEAR(bed.limit().calm / damped(8 * spring / inertia, 8 * dashpot / inertia), 1, 1e-9);
  EXPECT_NEAR(bed.limit().step / damped(8 * spring / inertia, 8 * dashpot / inertia), 1, 1e-9);
  EXPECT_EQ(bed.limit().remedy, "lower its rolling_friction or rolling_damping_ratio");
  bed.soil = "density = 2000\nstiffness = 3e5\ndamping = 4000\nfriction = 0\nrolling_friction = 0.2\n"
             "rolling_damping_ratio = 1\n";
  const double push = 0.1 * kGrainRadius * 0.1 * kGrainRadius * 2000; // (mu_r R / 2)^2 c
  EXPECT_NEAR(bed.limit().step / damped(8 * kStiffness / kMass, 4.5 * 2000 + 10 * push * kMass / inertia), 1, 1e-9)
      << "small torques: bounded by Coulomb's limit";
}

TEST(StepLimit, OfStrongRollingIsLongerThanTheAutomaticStep) {
  for (const double friction : {0.25, 0.5, 1.0, 2.0})
    for (const double damping : {0.0, 0.3, 1.0}) {
      Bed bed;
      bed.plane = true;
      bed.soil = fmt::format("density = 2000\nstiffness = 3e5\nrestitution = 0.5\nfriction = 0.5\nrolling_friction = "
                             "{}\nrolling_damping_ratio = {}\n",
                             friction, damping);
      EXPECT_LT(chooseTimeStep(bed.scene()), bed.limit().step) << friction << " " << damping;
    }
}

TEST(StepLimit, OfHertzGrainsIsThatOfAnImpactAtTheGivenSpeed) {
  Bed bed;
  bed.soil = "law = \"hertz\"\nyoung = 5e7\npoisson = 0.25\ndensity = 2000\nrestitution = 1\nfriction = 0\n";
  const double modulus = 5e7 / (1 - 0.0625) / 2, m = kMass / 2, R = kGrainRadius / 2;
  // Energy: m v^2 / 2 = (8/15) E sqrt(R) d^(5/2).
  const double deepest = std::pow(15 * m * 1.5 * 1.5 / (16 * modulus * std::sqrt(R)), 0.4), a = std::sqrt(R * deepest);
  EXPECT_NEAR(bed.limit().step / undamped(8 * 2 * modulus * a / kMass), 1, 1e-9);
  EXPECT_NEAR(bed.limit().calm / bed.limit().step, 1, 1e-9);
  bed.soil.replace(bed.soil.find("friction = 0"), 12, "friction = 0.5");
  // G = E / (2 (1 + nu)), 1 / G_eff = 2 (2 - nu) / G, k_t = 8 G_eff a; four simultaneous contacts rotate the grain.
  const double shear = 5e7 / 2.5, tangential = 8 * shear / (2 * 1.75) * a;
  EXPECT_NEAR(bed.limit().step / undamped(25 * tangential / kMass), 1, 1e-9);
  EXPECT_NEAR(bed.limit().calm /
                  std::min(undamped(8 * 2 * modulus * a / kMass), undamped(4 * 10.0 / 3 * tangential / kMass)),
              1, 1e-9);
}

TEST(StepLimit, OfADampedHertzImpactIsTakenAtItsOwnDepth) {
  Bed bed;
  bed.soil = "law = \"hertz\"\nyoung = 5e7\npoisson = 0.25\ndensity = 2000\nrestitution = 0.2\nfriction = 0\n";
  const double modulus = 5e7 / (1 - 0.0625) / 2, m = kMass / 2, R = kGrainRadius / 2;
  const double beta = contact::hertzDampingRatioFor(0.2, false);
  // Its own motion, in small steps.
  const double K = 4.0 / 3 * modulus * std::sqrt(R), C = 2 * beta * std::sqrt(2 * modulus * std::sqrt(R) * m);
  double x = 0, v = 1.5;
  for (const double h = 1e-8; v > 0; x += h * v) v -= h * (K * x * std::sqrt(x) + C * std::pow(x, 0.25) * v) / m;
  const double k = 1.5 * K * std::sqrt(x), c = C * std::pow(x, 0.25);
  // Small steps of order one: 1e-8 of 1e-3 s; the overlap enters by its root.
  EXPECT_NEAR(bed.limit().step / damped(8 * k / kMass, 4.5 * c / kMass), 1, 1e-4);
  // At low speed the weight of a heap as high as wide counts: for eight grains twice two of them.
  scene::Scene scene = bed.scene();
  scene.run.impactSpeed = 1e-9;
  for (int i = 0; i < 6; ++i) scene.grains.push_back(scene.grains.back());
  x = std::pow(4 * 9.81 * kMass / K, 2.0 / 3);
  EXPECT_NEAR(stepLimit(scene).step / damped(8 * 1.5 * K * std::sqrt(x) / kMass, 4.5 * C * std::pow(x, 0.25) / kMass),
              1, 1e-9);
}

TEST(AutomaticStep, HasAsManyStepsAContactAsAreAskedFor) {
  Bed bed;
  for (const double steps : {6.0, 10.0, 20.0, 200.0}) {
    scene::Scene scene = bed.scene();
    scene.run.stepsPerContact = steps;
    EXPECT_NEAR(chooseTimeStep(scene) / (shortestContact(scene) / steps), 1, 1e-9) << steps;
  }
  EXPECT_EQ(bed.scene().run.stepsPerContact, 20);
  EXPECT_THROW(parseScene("version = 1\n[run]\nduration = 1\nsteps_per_contact = 5.9\n[material.soil]\n" + bed.soil +
                              "[[grain]]\nposition = [0, 0, 1]\nradius = 0.02\nmaterial = \"soil\"\n",
                          "bed.toml"),
               base::InputError);
}

TEST(AutomaticStep, OfStrongDashpotsIsHalfOfWhatIsCalmOrAllOfItWhereStepsMayBeFew) {
  Bed bed;
  bed.soil = "density = 2000\nstiffness = 3e5\nrestitution = 0.05\nfriction = 0.5\n";
  scene::Scene scene = bed.scene();
  const StepLimit limit = stepLimit(scene);
  ASSERT_LT(limit.calm, limit.step);
  ASSERT_LT(limit.calm, shortestContact(scene) / 20);
  EXPECT_NEAR(chooseTimeStep(scene) / (0.5 * limit.calm), 1, 1e-9);
  scene.run.stepsPerContact = 40;
  EXPECT_NEAR(chooseTimeStep(scene) / (0.25 * limit.calm), 1, 1e-9);
  for (const double steps : {10.0, 6.0}) {
    scene.run.stepsPerContact = steps;
    EXPECT_NEAR(chooseTimeStep(scene) / limit.calm, 1, 1e-9);
  }
}

TEST(AutomaticStep, OfHertzGrainsKeepsItsShareOfTheRayleighTime) {
  Bed bed;
  bed.soil = "law = \"hertz\"\nyoung = 5e7\npoisson = 0.25\ndensity = 2000\nrestitution = 0.9\nfriction = 0\n";
  scene::Scene scene = bed.scene();
  scene.run.impactSpeed = 1e-3; // slow impacts last long
  const double rayleigh = contact::rayleighTime(kGrainRadius, 2000, 5e7 / 2.5, 0.25);
  EXPECT_NEAR(chooseTimeStep(scene) / (0.2 * rayleigh), 1, 1e-9);
  scene.run.stepsPerContact = 10;
  EXPECT_NEAR(chooseTimeStep(scene) / (0.4 * rayleigh), 1, 1e-9);
}

TEST(StepLimit, OfAFreeSurfaceCountsTheGrainsThatMayLieOnIt) {
  Bed bed;
  bed.more =
      "[[grains]]\nform = \"lattice\"\nlow = [0, 0, 2]\nhigh = [0.5, 0.5, 2.5]\nradius = 0.02\nmaterial = \"soil\"\n"
      "[[box]]\nname = \"lid\"\nposition = [0, 0, 5]\nsize = [0.3, 0.2, 0.01]\nfree = \"z\"\nmass = 1e-3\n"
      "material = \"soil\"\n";
  const StepLimit limit = bed.limit();
  // A dense layer on its largest face: 2 sqrt(3) R^2 a grain.
  const double grains = 0.3 * 0.2 / (2 * std::sqrt(3.0) * kGrainRadius * kGrainRadius);
  EXPECT_NEAR(limit.step / undamped(kStiffness * (1 / kMass + grains / 1e-3)), 1, 1e-9);
  EXPECT_EQ(limit.remedy, "raise box.0.mass");
  bed.more.replace(bed.more.find("[[box]]"), std::string::npos,
                   "[[box]]\nname = \"lid\"\nposition = [0, 0, 5]\nsize = [0.01, 0.02, 0.01]\nfree = \"z\"\n"
                   "mass = 1e-4\nmaterial = \"soil\"\n");
  EXPECT_NEAR(bed.limit().step / undamped(kStiffness * (1 / kMass + 1 / 1e-4)), 1, 1e-9) << "at least one";
}

/// The vehicle on a stand or on rigid ground.
scene::Scene standing(const std::string& change = "run.duration=1") {
  return loadScene(std::string(GROUSER_SOURCE_DIR) + "/tests/scenes/rigid.toml", {change});
}

TEST(StepLimit, OfAShoeUnderAWheelIsBothSpringsOnItsMassAndItsEnd) {
  const vehicle::VehicleSpec spec = vehicle::readVehicleSpec(GROUSER_SOURCE_DIR "/assets/vehicles/light_tracked.toml");
  const double modulus = spec.contact.foundationModulus, tau = spec.contact.relaxationTime;
  // Pads of 136 x 280 mm, shoes of 8.5 kg; wheels of 25 kg and 0.19 m under a tenth of 5018 kg; 0.02 kg m2 about the
  // pin's direction. The depth solves 4/3 modulus width sqrt(2 R) depth^1.5 = load.
  const double pad = modulus * 0.136 * 0.28 / 8.5, arm = 1 / 25.0 + 1 / 8.5 + 0.068 * 0.068 / 0.02;
  for (const double g : {9.81, 98.1}) {
    const StepLimit limit = stepLimit(standing(fmt::format("run.gravity=[0,0,-{}]", g)));
    double low = 0, high = 0.01; // bisection, for the limit uses the closed form
    for (int i = 0; i < 100; ++i) {
      const double depth = 0.5 * (low + high);
      (4.0 / 3 * modulus * 0.28 * std::sqrt(0.38) * std::pow(depth, 1.5) < 501.8 * g ? low : high) = depth;
    }
    const double springs = pad + modulus * 0.28 * 2 * std::sqrt(0.38 * low) * arm;
    EXPECT_NEAR(limit.step / damped(springs, springs * tau), 1, 1e-6) << g;
    EXPECT_EQ(limit.what, "shoe on rigid ground under a road wheel");
    EXPECT_NEAR(limit.calm / damped(pad, pad * tau), 1, 1e-9) << "the criterion of the automatic step";
  }
  EXPECT_GT(stepLimit(standing("run.gravity=[0,0,-9.81]")).step, 1e-4) << "the step of the shipped scenes";
  EXPECT_NEAR(stepLimit(standing("run.gravity=[0,0,0]")).step / damped(pad, pad * tau), 1, 1e-9) << "the pad alone";
}

TEST(StepLimit, OfAPadUnderAWheelUsesItsOwnModulus) {
  const vehicle::VehicleSpec spec = vehicle::readVehicleSpec(GROUSER_SOURCE_DIR "/assets/vehicles/light_tracked.toml");
  const double modulus = spec.contact.foundationModulus, tau = spec.contact.relaxationTime;
  // As above; the wheel sinks into the plate by the depth of the hard foundation.
  const double arm = 1 / 25.0 + 1 / 8.5 + 0.068 * 0.068 / 0.02;
  const double depth = std::pow(501.8 * 9.81 / (4.0 / 3 * modulus * 0.28 * std::sqrt(0.38)), 2.0 / 3);
  for (const double pads : {1e8, 1e9, 1e10, 1e11}) {
    scene::Scene scene =
        loadScene(std::string(GROUSER_SOURCE_DIR) + "/tests/scenes/rigid.toml",
                  {"run.duration=1", "run.gravity=[0,0,-9.81]", fmt::format("spec.contact.pad_modulus={}", pads)});
    // Never longer than for a shoe on a whole pad of the harder foundation.
    const double springs = pads * 0.136 * 0.28 / 8.5 + modulus * 0.28 * 2 * std::sqrt(0.38 * depth) * arm;
    const double hardest = std::max(springs, std::max(pads, modulus) * 0.136 * 0.28 / 8.5);
    EXPECT_NEAR(stepLimit(scene).step / damped(hardest, hardest * tau), 1, 1e-6) << pads;
  }
}

TEST(StepLimit, OfAShoeThatTurnsMoreEasilyThanItShiftsIsShorter) {
  const test::SpecVariant light({{"shoe", "inertia", "[0.0064, 0.0020, 0.0080]"}});
  const StepLimit limit = stepLimit(standing("vehicle.spec=" + light.path()));
  // A tenth of the moments: about y 136 x 280 mm of pad rotate 0.0020 kg m2, about x 0.0064 kg m2, the faster mode.
  const double turns = 1e10 * 0.136 * 0.28 * 0.14 * 0.14 / 3 / 0.0064;
  EXPECT_LT(limit.step, damped(turns, turns * 2e-4));
  EXPECT_GT(limit.step, 0.5 * damped(turns, turns * 2e-4));
}

TEST(StepLimit, OfAnIdlerCountsAllShoesThatRubOnIt) {
  // Heavy shoes are slow on the ground and under wheels; the idler that they hold is still light.
  const std::vector<test::KeyChange> heavy = {{"shoe", "mass", "57"}, {"shoe", "inertia", "[0.429, 0.134, 0.537]"}};
  const auto limit = [&](const std::string& key, const std::string& value) {
    std::vector<test::KeyChange> changes = heavy;
    if (!key.empty()) changes.push_back({key == "preload" ? "idler" : "contact", key, value});
    const test::SpecVariant variant(changes);
    return stepLimit(standing("vehicle.spec=" + variant.path()));
  };
  // Pins on a circle with chords of 0.154 m; plates of 20 mm lie on a radius of 0.217 m.
  const double around = std::hypot(0.077, 0.237);
  EXPECT_EQ(std::ceil(base::kPi * around / 0.154), 6);
  const auto expected = [&](double preload) {
    const double load = 0.5 * preload * 0.154 / around;
    double low = 0, high = 0.01; // bisection, for the limit uses the closed form
    for (int i = 0; i < 100; ++i) {
      const double depth = 0.5 * (low + high);
      (4.0 / 3 * 1e10 * 0.28 * std::sqrt(0.434) * std::pow(depth, 1.5) < load ? low : high) = depth;
    }
    const double spring = 0.8 * 1e10 * 0.28 * 2 * std::sqrt(0.434 * low);
    const double rate = spring * (6 * (0.217 * 0.217 / 0.55 + 0.5 / 20) + 1 / 57.0 + 0.02 * 0.02 / 0.134);
    return damped(rate, rate * 2e-4);
  };
  EXPECT_NEAR(limit("", "").step / expected(9200), 1, 1e-6);
  EXPECT_EQ(limit("", "").what, "idler in contact with 6 shoes");
  EXPECT_NEAR(limit("preload", "20000").step / expected(20000), 1, 1e-6);
  EXPECT_GT(limit("friction_inside", "0").step, 1.1 * expected(9200)) << "friction does not hold it";
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
  const double modulus = 5e7 / (1 - 0.0625) / 2, m = kMass / 2, R = kGrainRadius / 2;
  const double deepest = std::pow(15 * m * 1.5 * 1.5 / (16 * modulus * std::sqrt(R)), 0.4);
  // 4 sqrt(pi) Gamma(2/5) / (5 Gamma(9/10)) deepest / v
  const double factor = 4 * std::sqrt(base::kPi) * std::tgamma(0.4) / (5 * std::tgamma(0.9));
  EXPECT_NEAR(shortestContact(bed.scene()) / (factor * deepest / 1.5), 1, 1e-9);
}

} // namespace
} // namespace grouser::setup
