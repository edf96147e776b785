// SPDX-License-Identifier: BSD-3-Clause
// Laws of two different materials, and the position of a vehicle, with unique values.
#include "runs/setup/laws.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/setup/placement.hpp"

#include "base/error.hpp"
#include "base/math.hpp"
#include "contact/mixing.hpp"
#include "runs/scene/scene.hpp"
#include "vehicle/spec_file.hpp"

#include <gtest/gtest.h>

namespace grouser::setup {
namespace {

scene::Scene twoMaterials(const std::string& more = "") {
  return parseScene("version = 1\n[run]\nduration = 1\n"
                    "[material.soft]\nstiffness = 1e5\nfriction = 0.3\ntangential_stiffness_ratio = 0.5\n"
                    "tangential_damping_ratio = 0.7\ndamping = 200\nrolling_friction = 0.02\ncohesion = 0.4\n"
                    "[material.hard]\nstiffness = 3e5\nfriction = 0.8\ntangential_stiffness_ratio = 0.4\n"
                    "tangential_damping_ratio = 0.9\ndamping = 500\nrolling_friction = 0.05\ncohesion = 0.9\n" +
                        more +
                        "[[grain]]\nposition = [0, 0, 0]\nradius = 0.01\nmaterial = \"soft\"\n"
                        "[[grain]]\nposition = [1, 0, 0]\nradius = 0.01\nmaterial = \"hard\"\n",
                    "two.toml");
}

TEST(PairLawValues, OfUnlikeMaterialsAreTwoSpringsInARowAndTheWeakerOfTheRest) {
  const scene::Scene scene = twoMaterials();
  const contact::ContactLaw law = pairLaw(scene, "soft", "hard", 0.1);
  EXPECT_NEAR(law.stiffness, 2 * 1e5 * 3e5 / 4e5, 1e-6);
  EXPECT_NEAR(law.tangentialStiffness, 0.4 * 1.5e5, 1e-6);
  EXPECT_EQ(law.damping, 500);
  EXPECT_NEAR(law.tangentialDamping, 0.7 * 500, 1e-9);
  EXPECT_EQ(law.friction, 0.3);
  EXPECT_EQ(law.rollingFriction, 0.02);
  EXPECT_NEAR(law.pullPerRadius, 2 * base::kPi * 0.6, 1e-12) << "the geometric mean of the energies";
  const contact::ContactLaw own = pairLaw(scene, "hard", "hard", 0.1);
  EXPECT_EQ(own.stiffness, 3e5);
  EXPECT_NEAR(own.pullPerRadius, 2 * base::kPi * 0.9, 1e-12);
}

TEST(PairLawValues, AreThoseOfTheSamePropertiesWithoutAScene) {
  const scene::Scene scene = twoMaterials("[contact.\"soft|hard\"]\nfriction = 0.1\n");
  contact::MaterialProperties soft, hard;
  soft.stiffness = 1e5, soft.friction = 0.3, soft.tangentialStiffnessRatio = 0.5, soft.tangentialDampingRatio = 0.7;
  soft.damping = 200, soft.rollingFriction = 0.02, soft.cohesion = 0.4;
  hard.stiffness = 3e5, hard.friction = 0.8, hard.tangentialStiffnessRatio = 0.4, hard.tangentialDampingRatio = 0.9;
  hard.damping = 500, hard.rollingFriction = 0.05, hard.cohesion = 0.9;
  contact::PairProperties pair;
  pair.friction = 0.1;
  for (const std::optional<double> mass : {std::optional<double>(), std::optional(0.1)}) {
    const contact::ContactLaw plain = contact::mixedLaw(soft, hard, pair, mass),
                              law = pairLaw(scene, "soft", "hard", mass);
    EXPECT_EQ(law.stiffness, plain.stiffness);
    EXPECT_EQ(law.tangentialStiffness, plain.tangentialStiffness);
    EXPECT_EQ(law.damping, plain.damping);
    EXPECT_EQ(law.tangentialDamping, plain.tangentialDamping);
    EXPECT_EQ(law.friction, plain.friction);
    EXPECT_EQ(law.rollingFriction, plain.rollingFriction);
    EXPECT_EQ(law.rollingDamping, plain.rollingDamping) << "a default value";
    EXPECT_EQ(law.pullPerRadius, plain.pullPerRadius);
    EXPECT_EQ(law.fixedShare, plain.fixedShare);
  }
}

TEST(PairLawValues, ErrorsStandAtTheKeyInTheScene) {
  const auto messageOf = [](const std::string& first, const std::string& second) {
    const scene::Scene scene =
        parseScene("version = 1\n[run]\nduration = 1\n[material.a]\n" + first + "[material.b]\n" + second +
                       "[[grain]]\nposition = [0, 0, 1]\nradius = 0.1\nmaterial = \"a\"\n",
                   "pair.toml");
    try {
      pairLaw(scene, "a", "b", {});
    } catch (const base::InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(messageOf("", "law = \"hertz\"\nyoung = 1e8\n"),
            "pair.toml:6: material.b.law = \"hertz\" is incompatible with law = \"linear\" of material.a, a contact "
            "partner; use hertz or eepa for both, or linear, eepa_linear or luding for both (eepa_linear and luding "
            "are incompatible)");
  EXPECT_EQ(messageOf("damping = 300\n", "restitution = 0.5\n"),
            "pair.toml:5: material.a.damping = 300 [1/s] cannot be combined with the restitution of material.b for "
            "grains of different masses; use damping or restitution in both materials, or set [contact.\"a|b\"]");
}

TEST(PairLawValues, OfAPairAreThoseOfItsSection) {
  const scene::Scene scene =
      twoMaterials("[contact.\"soft|hard\"]\nstiffness = 7e5\nfriction = 0.1\ndamping = 50\nrolling_friction = 0.3\n");
  const contact::ContactLaw law = pairLaw(scene, "hard", "soft", 0.1);
  EXPECT_EQ(law.stiffness, 7e5);
  EXPECT_NEAR(law.tangentialStiffness, 0.4 * 7e5, 1e-6);
  EXPECT_EQ(law.damping, 50);
  EXPECT_EQ(law.friction, 0.1);
  EXPECT_EQ(law.rollingFriction, 0.3);
  EXPECT_EQ(pairLaw(scene, "soft", "soft", 0.1).friction, 0.3) << "the value of the pair";
}

TEST(PairLawValues, EnergiesOfAdhesionGrowWithTheRadiusWhereAMaterialSaysSo) {
  const auto of = [](const std::string& first, const std::string& second) {
    return parseScene(
        "version = 1\n[run]\nduration = 1\n"
        "[material.fine]\nlaw = \"eepa\"\nyoung = 1e8\nsurface_energy = 3\ncohesion = 0.4\n" +
            first + "[material.coarse]\nlaw = \"eepa\"\nyoung = 1e8\nsurface_energy = 12\ncohesion = 0.9\n" + second +
            "[[grain]]\nposition = [0, 0, 0]\nradius = 0.01\nmaterial = \"fine\"\n"
            "[[grain]]\nposition = [1, 0, 0]\nradius = 0.01\nmaterial = \"coarse\"\n",
        "two.toml");
  };
  const scene::Scene one = of("adhesion_radius = 0.01\n", "");
  const contact::ContactLaw constant = pairLaw(one, "coarse", "coarse", {}), grown = pairLaw(one, "fine", "fine", {});
  EXPECT_NEAR(constant.pull(0.01), 2 * base::kPi * 0.9 * 0.01, 1e-14);
  EXPECT_NEAR(grown.pull(0.005), 2 * base::kPi * 0.4 * 0.005, 1e-14) << "two grains with this radius";
  EXPECT_NEAR(grown.pull(0.010), 4 * 2 * base::kPi * 0.4 * 0.005, 1e-14) << "proportional to the square";
  EXPECT_EQ(grown.plastic.pull, 0);
  EXPECT_NEAR(4 * 0.005 * grown.plastic.pullGrowth, constant.plastic.pull, 1e-12) << "3 J/m2 there, a quarter of 12";
  const contact::ContactLaw mixed = pairLaw(one, "fine", "coarse", {});
  EXPECT_NEAR(mixed.pull(0.005), 2 * base::kPi * 0.6 * 0.005, 1e-14) << "one says so: with its radius";
  EXPECT_NEAR(mixed.pull(0.01), 4 * 2 * base::kPi * 0.6 * 0.005, 1e-14);
  const contact::ContactLaw both =
      pairLaw(of("adhesion_radius = 0.01\n", "adhesion_radius = 0.04\n"), "fine", "coarse", {});
  EXPECT_NEAR(both.pull(0.01), 2 * base::kPi * 0.6 * 0.01, 1e-14) << "equal grains of 20 mm, the geometric mean";
  EXPECT_NEAR(both.pull(0.02), 8 * base::kPi * 0.6 * 0.01, 1e-14);
}

TEST(PlacementValues, HeadingIsInDegreesAndTheTerrainReachesToBothSides) {
  const scene::Scene scene = loadScene(std::string(GROUSER_SOURCE_DIR) + "/tests/scenes/rigid.toml",
                                       {"vehicle.heading=30", "vehicle.position=[4, -0.5]", "terrain.size=[9, 8]"});
  const coupling::Placement place = placeVehicle(scene, vehicle::readVehicleSpec(scene.vehicle->source()));
  EXPECT_NEAR(place.heading, base::kPi / 6, 1e-15);
  EXPECT_EQ(place.x, 4);
  EXPECT_EQ(place.y, -0.5);
  const terrain::Rectangle area = terrainArea(scene).value();
  EXPECT_EQ(area.xMin, 0);
  EXPECT_EQ(area.xMax, 9);
  EXPECT_EQ(area.yMin, -4);
  EXPECT_EQ(area.yMax, 4);
}

} // namespace
} // namespace grouser::setup
