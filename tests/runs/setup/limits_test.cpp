// SPDX-License-Identifier: BSD-3-Clause
// Values that errors advise are accepted as printed; limits of restitution; contact parameters by material pair.
#include "base/error.hpp"
#include "base/math.hpp"
#include "base/random.hpp"
#include "base/sphere.hpp"
#include "contact/restitution.hpp"
#include "coupling/simulation.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/ground_setup.hpp"
#include "runs/setup/laws.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/setup/material_pairs.hpp"
#include "runs/setup/simulation_setup.hpp"
#include "runs/setup/step_limit.hpp"
#include "tests/message_of.hpp"
#include "vehicle/spec_file.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <regex>

namespace grouser::setup {
namespace {

using test::messageOf;

scene::Scene parsed(const std::string& text, const std::vector<std::string>& overrides = {}) {
  return parseScene("version = 1\n" + text, "scene.toml", overrides);
}

/// The first number after `words`.
std::string numberBehind(const std::string& message, const std::string& words) {
  std::smatch match;
  return std::regex_search(message, match, std::regex(words + "([-+.e0-9]*[0-9])")) ? match.str(1) : "";
}

/// A ball on a plane; stiffness over 6 decades, radius and density over 2 each.
struct RandomScene {
  double stiffness, radius, density, restitution, friction, rolling;
  explicit RandomScene(std::uint64_t i) {
    std::uint64_t k = 0;
    const auto in = [&](double low, double high) { return low * std::pow(high / low, base::uniform(11, 5, i, k++)); };
    stiffness = in(1e3, 1e9), radius = in(1e-3, 1e-1), density = in(100, 1e4);
    restitution = in(0.05, 1), friction = i % 3 ? in(0.1, 2) : 0, rolling = i % 4 ? 0 : in(0.01, 1);
  }
  std::string text(const std::string& run, const std::string& grain = "") const {
    return fmt::format(
        "[run]\nduration = 1\n{}\n[material.m]\nstiffness = {}\ndensity = {}\nrestitution = {}\n"
        "friction = {}\nrolling_friction = {}\n[[plane]]\nmaterial = \"m\"\n[[grain]]\nposition = [0, 0, "
        "1]\nradius = {}\nmaterial = \"m\"\n{}\n",
        run, stiffness, density, restitution, friction, rolling, radius, grain);
  }
};

TEST(PrintedLimits, StepThatAnErrorAdvisesIsAccepted) {
  int closeCalls = 0;
  for (std::uint64_t i = 0; i < 500; ++i) {
    const RandomScene random(i);
    const std::string still = "gravity = [0, 0, 0]\noutput_interval = 1\nframe_interval = 1\n";
    const double limit = stepLimit(parsed(random.text(still))).step;
    if (limit >= 0.1) continue;
    const std::string message = messageOf([&] { chooseTimeStep(parsed(random.text(still + "time_step = 0.1"))); });
    for (const char* words : {"set ", "\"auto\": "}) {
      const std::string printed = numberBehind(message, words);
      ASSERT_NE(printed, "") << message;
      EXPECT_EQ(messageOf([&] { chooseTimeStep(parsed(random.text(still + "time_step = " + printed))); }), "");
    }
    closeCalls += std::stod(fmt::format("{:.3g}", limit)) > limit;
  }
  EXPECT_GT(closeCalls, 100) << "the nearest numbers would also pass: the test shows nothing";
}

TEST(PrintedLimits, StiffnessThatAnErrorAdvisesIsAccepted) {
  int refused = 0;
  for (std::uint64_t i = 0; i < 300; ++i) {
    RandomScene random(i);
    random.stiffness *= 1e-3; // most overlap too far
    const auto choose = [&] { chooseTimeStep(parsed(random.text(""))); };
    const std::string message = messageOf(choose);
    if (message.empty()) continue;
    const std::string printed = numberBehind(message, "raise it to ");
    ASSERT_NE(printed, "") << message;
    random.stiffness = std::stod(printed);
    EXPECT_EQ(messageOf(choose), "");
    ++refused;
  }
  EXPECT_GT(refused, 50);
}

TEST(PrintedLimits, SpeedThatAnErrorAdvisesIsAccepted) {
  int closeCalls = 0;
  for (std::uint64_t i = 0; i < 300; ++i) {
    const RandomScene random(i);
    const auto sceneAt = [&](const std::string& speed) {
      return parsed(random.text("gravity = [0, 0, 0]", "velocity = [0, 0, -" + speed + "]"));
    };
    const double step = chooseTimeStep(sceneAt("0"));
    const auto check = [&](const std::string& speed) {
      const scene::Scene scene = sceneAt(speed);
      checkSpeeds(scene, ContactPairs(scene), step);
    };
    const std::string message = messageOf([&] { check("999"); });
    if (message.empty()) continue;
    const std::string printed = numberBehind(message, "keep it below ");
    ASSERT_NE(printed, "") << message;
    EXPECT_EQ(messageOf([&] { check(printed); }), "");
    const scene::Scene scene = sceneAt("0");
    const double most = 0.5 * scene.run.skin * random.radius / step;
    closeCalls += std::stod(fmt::format("{:.4g}", most)) > most;
  }
  EXPECT_GT(closeCalls, 50);
}

/// A ball that approaches at 0.5 m/s, without gravity.
const char* const kBall = R"([run]
duration = 0.1
gravity = [0, 0, 0]
[material.soil]
stiffness = 1e5
friction = 0
restitution = 0.5
[[plane]]
material = "soil"
[[grain]]
position = [0, 0, 0.0201]
velocity = [0, 0, -0.5]
radius = 0.02
material = "soil"
)";

TEST(Restitution, ZeroWithAttractionIsCriticalDamping) {
  EXPECT_EQ(contact::dampingRatioFor(0, true), 1);
  EXPECT_EQ(contact::restitutionOf(contact::dampingRatioFor(0, true), true), 0);
  EXPECT_EQ(contact::hertzRestitutionOf(contact::hertzDampingRatioFor(0, true), true), 0);
  // The smallest sufficient value: slightly below it the ball rebounds.
  EXPECT_GT(contact::restitutionOf(0.9, true), 0);
  EXPECT_GT(contact::hertzRestitutionOf(0.99 * contact::hertzDampingRatioFor(0, true), true), 0);
}

TEST(Restitution, BallThatIsCriticallyDampedFollowsTheClosedForm) {
  // overlap = v t exp(-omega t), t from first touch; symplectic Euler is of first order in the step.
  const double mass = base::sphereMass(2500, 0.02), omega = std::sqrt(1e5 / mass), v = 0.5;
  double errors[2];
  for (int k = 0; k < 2; ++k) {
    const double dt = 1e-5 / (k + 1);
    coupling::Simulation ball(
        simulationSetup(parsed(kBall, {"material.soil.restitution=0", "material.soil.attraction=true",
                                       "run.precision=double", fmt::format("run.time_step={}", dt)})),
        base::cpuExec(1), [](double, double) {});
    double worst = 0;
    for (int i = 0; i < 2000 * (k + 1); ++i) {
      ball.step();
      const double t = ball.time() - 1e-4 / v;
      if (t < dt) continue;
      const double overlap = 0.02 - ball.ground().grains->snapshot().position[0].z;
      worst = std::max(worst, std::fabs(overlap - v * t * std::exp(-omega * t)));
    }
    errors[k] = worst / (v / omega * std::exp(-1)); // relative to the deepest
  }
  EXPECT_LT(errors[0], 3 * omega * 1e-5); // a few steps over the contact's own time
  EXPECT_NEAR(errors[0] / errors[1], 2, 0.5);
}

TEST(Restitution, ZeroWithComplementarityContactsLeavesNoRebound) {
  for (const std::string law : {"linear", "hertz"}) {
    std::vector<std::string> keys{"run.contact=complementarity", "material.soil.restitution=0", "run.time_step=1e-4",
                                  "run.residual=1e-7"};
    if (law == "hertz")
      keys.insert(keys.end(), {"material.soil.law=hertz", "material.soil.young=1e7", "~material.soil.stiffness"});
    coupling::Simulation ball(simulationSetup(parsed(kBall, keys)), base::cpuExec(1), [](double, double) {});
    for (int k = 0; k < 10; ++k) ball.step();
    EXPECT_NEAR(ball.ground().grains->snapshot().velocity[0].z, 0, 1e-6) << law;
  }
}

TEST(Restitution, ZeroWithoutAttractionIsRefusedWithTheLeastAndItsStep) {
  const auto refusal = [&](const std::vector<std::string>& overrides) {
    return messageOf([&] { simulationSetup(parsed(kBall, overrides)); });
  };
  const std::string message = refusal({"material.soil.restitution=0"});
  for (const char* part : {"material.soil.restitution", "is below 1e-06", "the minimum without attraction",
                           "attraction = true", "run.contact = \"complementarity\""})
    EXPECT_NE(message.find(part), std::string::npos) << message;
  // The suggested step is accepted as printed, and no larger one.
  const std::string step = numberBehind(message, "require time steps of ");
  EXPECT_EQ(refusal({"material.soil.restitution=1e-06", "run.time_step=" + step}), "");
  EXPECT_NE(refusal({"material.soil.restitution=1e-06", fmt::format("run.time_step={}", 1.02 * std::stod(step))}), "");
  // Attraction of one material is not enough; the pair is named in the scene.
  EXPECT_NE(refusal({"material.soil.restitution=1e-7"}), "");
  const std::string pair =
      "[material.hard]\nstiffness = 1e5\nattraction = true\n[contact.\"soil|hard\"]\nrestitution = 0\n" +
      std::string(kBall).replace(std::string(kBall).find("[[plane]]\nmaterial = \"soil\""), 27,
                                 "[[plane]]\nmaterial = \"hard\"");
  EXPECT_NE(messageOf([&] { simulationSetup(parsed(pair)); }).find("contact.\"soil|hard\".restitution"),
            std::string::npos)
      << messageOf([&] { simulationSetup(parsed(pair)); });
  EXPECT_EQ(messageOf([&] { simulationSetup(parsed(pair, {"material.soil.attraction=true"})); }), "");
  EXPECT_EQ(refusal({"material.soil.restitution=0", "material.soil.attraction=true"}), "");
}

TEST(Restitution, ZeroOfAFloorIsRefusedToo) {
  const std::string bed =
      "[run]\nduration = 1\n[material.soil]\nstiffness = 1e6\n[material.rock]\nstiffness = 1e7\n"
      "restitution = 0\n[terrain]\nheightmap = \"heightmaps/flat.png\"\nsize = [1, 1]\n"
      "height_range = [0, 0.1]\nmaterial = \"soil\"\nground_material = \"rock\"\n"
      "grain_radius = 0.05\nlayers = 1\narrangement = \"lattice\"\nfloor_grains = false\nwall_friction = 0.5\n";
  const auto refusal = [&](const std::vector<std::string>& overrides) {
    return messageOf([&] { simulationSetup(parsed(bed, overrides)); });
  };
  EXPECT_NE(refusal({}).find("material.rock.restitution"), std::string::npos) << refusal({});
  EXPECT_EQ(refusal({"material.rock.restitution=0.2"}), "");
}

const char* const kPairs = R"([run]
duration = 0.1
[material.soil]
stiffness = 1e5
restitution = 0.4
friction = 0.6
cohesion = 0.2
[material.rough]
stiffness = 3e5
restitution = 0.7
friction = 0.9
rolling_friction = 0.3
[material.ball]
stiffness = 2e5
damping = 50
friction = 0
[contact."ball|rough"]
friction = 0.35
rolling_friction = 0.05
[[plane]]
material = "rough"
[[box]]
name = "lid"
material = "ball"
position = [0, 0, 2]
size = [1, 1, 0.1]
[[grain]]
position = [0, 0, 0.5]
radius = 0.02
material = "soil"
)";

TEST(MeetingPairs, HaveTheValuesThatAct) {
  const std::vector<MaterialPair> pairs = materialPairs(parsed(kPairs));
  ASSERT_EQ(pairs.size(), 3u);
  const MaterialPair &soil = pairs[0], &lid = pairs[1], &plane = pairs[2];
  EXPECT_EQ(soil.what, "grain on grain");
  EXPECT_DOUBLE_EQ(soil.stiffness, 1e5);
  EXPECT_NEAR(soil.restitution, 0.4, 1e-12);
  EXPECT_DOUBLE_EQ(soil.law.friction, 0.6);
  EXPECT_NEAR(soil.cohesion, 0.2, 1e-15);
  EXPECT_EQ(plane.what, "grain on a plane");
  EXPECT_DOUBLE_EQ(plane.stiffness, 2 * 1e5 * 3e5 / 4e5);
  EXPECT_NEAR(plane.restitution, 0.4, 1e-12);
  EXPECT_DOUBLE_EQ(plane.law.friction, 0.6);
  EXPECT_EQ(plane.law.rollingFriction, 0);
  // The larger damping applies: the soil's restitution of 0.4, not the ball's 50 /s.
  EXPECT_EQ(lid.what.rfind("grain on ", 0), 0u);
  EXPECT_DOUBLE_EQ(lid.stiffness, 2 * 1e5 * 2e5 / 3e5);
  EXPECT_NEAR(lid.restitution, 0.4, 1e-12);
  EXPECT_EQ(lid.law.friction, 0);
}

TEST(MeetingPairs, OfTwoGrainsHaveThePairsMass) {
  // damping = 500 /s refers to the pair's mass, m / 2, or to m on a wall.
  const std::vector<MaterialPair> pairs = materialPairs(parsed(
      "[run]\nduration = 1\n[material.ball]\nstiffness = 2e5\ndamping = 500\nattraction = true\n"
      "[[plane]]\nmaterial = \"ball\"\n[[grain]]\nposition = [0, 0, 0.5]\nradius = 0.02\nmaterial = \"ball\"\n"));
  ASSERT_EQ(pairs.size(), 2u);
  const double m = base::sphereMass(2500, 0.02);
  for (const auto& [pair, mass] : {std::pair{pairs[0], m / 2}, std::pair{pairs[1], m}}) {
    const double c = 500 * mass, zeta = c / (2 * std::sqrt(2e5 * mass));
    EXPECT_NEAR(pair.restitution, std::exp(-base::kPi * zeta / std::sqrt(1 - zeta * zeta)), 1e-9) << pair.what;
  }
  EXPECT_GT(std::fabs(pairs[0].restitution - pairs[1].restitution), 0.01);
}

TEST(MeetingPairs, OfHertzGrainsHaveTheirEffectiveModulus) {
  const std::vector<MaterialPair> pairs =
      materialPairs(parsed("[run]\nduration = 1\n[material.glass]\nlaw = \"hertz\"\nyoung = 6e7\n"
                           "poisson = 0.25\nrestitution = 0.6\n[[grain]]\nposition = [0, 0, 0.5]\nradius = 0.02\n"
                           "material = \"glass\"\n"));
  ASSERT_EQ(pairs.size(), 1u);
  EXPECT_NEAR(pairs[0].stiffness, 6e7 / (2 * (1 - 0.0625)), 1) << "E / (2 (1 - nu^2)) of two equal materials";
  EXPECT_NEAR(pairs[0].restitution, 0.6, 1e-6);
}

TEST(MeetingPairs, OfTheVehicleHaveTheFrictionOfItsFile) {
  for (const MaterialPair& pair : materialPairs(loadScene(GROUSER_SOURCE_DIR "/tests/scenes/coupled.toml")))
    if (pair.touched == ContactPartner::Kind::vehicle) {
      const double given =
          vehicle::readVehicleSpec(GROUSER_SOURCE_DIR "/assets/vehicles/light_tracked.toml").contact.frictionGround;
      EXPECT_EQ(pair.law.friction, given);
      EXPECT_NE(given, 0.5) << "the soil's value";
      return;
    }
  FAIL() << "no contact of grains and vehicle";
}

/// Adhesion of cohesive grains to vehicle parts [J/m2], in `grouser plan` and in the
/// contacts: w = pull / (2 pi R) with a grain's own radius R on a part.
std::pair<double, double> stickingOf(const std::vector<std::string>& overrides) {
  std::vector<std::string> all{"material.soil.cohesion=8"};
  all.insert(all.end(), overrides.begin(), overrides.end());
  const scene::Scene scene = loadScene(GROUSER_SOURCE_DIR "/tests/scenes/coupled.toml", all);
  double printed = base::kNaN;
  for (const MaterialPair& pair : materialPairs(scene))
    if (pair.touched == ContactPartner::Kind::vehicle) printed = pair.cohesion;
  const double radius = *scene.terrain->grainRadius;
  return {printed, groundSetup(scene, 1e-4).grains->partLaws.laws.at(0).pull(radius) / (2 * base::kPi * radius)};
}

TEST(MeetingPairs, SoilSticksToAVehicleByTheShareThatIsGiven) {
  EXPECT_EQ(stickingOf({}), std::pair(0.0, 0.0)) << "no adhesion unless requested";
  const auto [printed, taken] = stickingOf({"vehicle.adhesion=0.25"});
  EXPECT_NEAR(printed, 2, 1e-12);
  EXPECT_NEAR(taken, 2, 1e-12);
  // Grains of 19 mm have a mutual adhesion of 8 J/m2: R_eff is 9.5 mm. R of 38 mm grains on a plane is 38 mm.
  const auto [toldOfLarge, takenOfLarge] = stickingOf({"vehicle.adhesion=0.25", "material.soil.adhesion_radius=0.019"});
  EXPECT_NEAR(toldOfLarge, 8, 1e-12);
  EXPECT_NEAR(takenOfLarge, 8, 1e-12);
}

TEST(MeetingPairs, AVehicleOfAMaterialSticksAsThatSays) {
  const std::string scene = GROUSER_SOURCE_DIR "/tests/scenes/coupled.toml";
  EXPECT_EQ(stickingOf({"vehicle.material=soil"}), std::pair(8.0, 8.0));
  EXPECT_NE(messageOf([&] {
              loadScene(scene, {"vehicle.material=soil", "vehicle.adhesion=0.5"});
            }).find("adhesion"),
            std::string::npos);
}

} // namespace
} // namespace grouser::setup
