// SPDX-License-Identifier: BSD-3-Clause
// Deformable soil: constants of the soil file, published or measured, or of the scene; input errors.
#include "runs/setup/scm_setup.hpp"

#include "base/math.hpp"
#include "runs/scene/scene_file.hpp"
#include "runs/scene/soil.hpp"
#include "runs/setup/step_limit.hpp"
#include "runs/setup/vehicle_step_limit.hpp"
#include "tests/message_of.hpp"
#include "vehicle/spec_file.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace grouser::setup::scm {
namespace {

const std::string kScene = "version = 1\n[run]\nduration = 1\ntime_step = 1e-4\n[terrain]\nkind = \"scm\"\nmaterial = "
                           "\"lete_sand\"\nheightmap = \"heightmaps/flat.png\"\nsize = [8, 4]\nheight_range = [0, "
                           "0]\n[vehicle]\nspec = \"vehicles/light_tracked.toml\"\n";

coupling::ScmSetup read(const std::string& text) {
  return *scmSetup(scene::readSceneText(text, GROUSER_SOURCE_DIR "/runs/scenes/scm.toml"));
}

TEST(ScmSetup, TakesConstantsFromTheSoilOrTheScene) {
  const coupling::ScmSetup published = read(kScene);
  EXPECT_EQ(published.soil.exponent, 0.793);
  EXPECT_EQ(published.soil.kc, 102e3);
  EXPECT_EQ(published.soil.kphi, 5301e3);
  EXPECT_EQ(published.soil.cohesion, 1300);
  EXPECT_NEAR(published.soil.friction, std::tan(31.1 * base::kPi / 180), 1e-12);
  EXPECT_EQ(published.soil.shearDisplacement, 0.012);
  EXPECT_NEAR(published.spacing, 0.034, 1e-12) << "a quarter of the shoe length";
  const coupling::ScmSetup measured = read(kScene + "[scm]\nconstants = \"measured\"\nc = 500\nnode_spacing = 0.02\n");
  EXPECT_NE(measured.soil.exponent, published.soil.exponent);
  EXPECT_EQ(measured.soil.cohesion, 500) << "explicit values take precedence";
  EXPECT_EQ(measured.spacing, 0.02);
  EXPECT_FALSE(scmSetup(scene::readSceneText("version = 1\n[run]\nduration = 1\n[material.m]\nstiffness = 1e5\n"
                                             "[[grain]]\nmaterial = \"m\"\nradius = 0.1\nposition = [0, 0, 0]\n",
                                             "one.toml")));
}

TEST(ScmSetup, WarnsOfNodesFartherApartThanTheDefault) {
  const auto warning = [](const std::string& text) {
    return nodeSpacingWarning(scene::readSceneText(text, GROUSER_SOURCE_DIR "/runs/scenes/scm.toml"));
  };
  for (const char* spacing : {"", "[scm]\n", "[scm]\nnode_spacing = 0.034\n", "[scm]\nnode_spacing = 0.01\n"})
    EXPECT_EQ(warning(kScene + spacing), "") << spacing;
  EXPECT_NE(warning(kScene + "[scm]\nnode_spacing = 0.068\n").find("0.5 of the length of a shoe"), std::string::npos);
  const std::string box = kScene.substr(0, kScene.find("[vehicle]")) +
                          "[material.m]\n[[body]]\nname = \"b\"\nmass = 1\nmaterial = \"m\"\nposition = [4, 2, 1]\n"
                          "[[body.shape]]\nkind = \"box\"\nsize = [0.3, 0.2, 0.4]\n[scm]\nnode_spacing = ";
  EXPECT_EQ(warning(box + "0.025\n"), "") << "an eighth of the second smallest side";
  EXPECT_NE(warning(box + "0.04\n").find("exceeds the default, 0.025 m"), std::string::npos) << warning(box + "0.04\n");
}

/// A level plate of mass m and area A in soil with damping R stops with the rate R A / m. The heat of an explicit step
/// has a relative error of half of step times rate.
TEST(ScmSetup, AutomaticStepResolvesTheDampingUnderALightPlate) {
  const double rate = 3e4 * 0.4 * 0.4 / 1;
  const std::string text =
      "version = 1\n[run]\nduration = 1\n[terrain]\nkind = \"scm\"\nmaterial = \"s\"\nheightmap = "
      "\"heightmaps/flat.png\"\nsize = [8, 4]\nheight_range = [0, 0]\n[material.s]\n[scm]\nn = 1\nk_c = 0\nk_phi = "
      "1e6\nc = 1000\nphi = 30\nK = 0.01\n[[body]]\nname = \"b\"\nmass = 1\nmaterial = \"s\"\nposition = [4, 0, "
      "1]\n[[body.shape]]\nkind = \"box\"\nsize = [0.4, 0.4, 0.01]\n";
  const double step = chooseTimeStep(scene::readSceneText(text, GROUSER_SOURCE_DIR "/runs/scenes/scm.toml"));
  EXPECT_LT(0.5 * step * rate, 0.06);
  EXPECT_GT(0.5 * step * rate, 0.01) << "no shorter than required";
}

TEST(ScmSetup, DrawsTheConstantsThatTheSceneOmits) {
  const coupling::ScmSetup nominal = read(kScene), first = read(kScene + "[scm]\nconstants_draw = 1\n"),
                           again = read(kScene + "[scm]\nconstants_draw = 1\n"),
                           other = read(kScene + "[scm]\nconstants_draw = 2\n"),
                           some = read(kScene + "[scm]\nconstants_draw = 1\nc = 500\nK = 0.01\n");
  EXPECT_EQ(first.soil.exponent, again.soil.exponent);
  EXPECT_EQ(first.soil.friction, again.soil.friction);
  EXPECT_NE(first.soil.exponent, nominal.soil.exponent);
  EXPECT_NE(first.soil.kphi, other.soil.kphi);
  EXPECT_EQ(some.soil.cohesion, 500);
  EXPECT_EQ(some.soil.shearDisplacement, 0.01);
  EXPECT_EQ(some.soil.exponent, first.soil.exponent);
  EXPECT_EQ(read(kScene + "[scm]\nconstants_draw = 0\n").soil.kphi, nominal.soil.kphi);
}

/// Soils with measured plate and shear tests of their grains.
TEST(ScmSetup, EverySoilWithMeasuredConstantsCanBeUsed) {
  int soils = 0;
  for (const auto& [name, file] : scene::knownSoils(GROUSER_SOURCE_DIR "/assets/scene.toml")) {
    const scene::Soil soil = scene::readSoil(file);
    if (std::none_of(soil.reached.begin(), soil.reached.end(),
                     [](const scene::ReachedConstant& r) { return r.quantity == scene::SoilQuantity::exponent; }))
      continue;
    std::string text = kScene;
    text.replace(text.find("lete_sand"), 9, name);
    const ::grouser::scm::SoilConstants nominal = read(text + "[scm]\nconstants = \"measured\"\n").soil;
    EXPECT_GT(nominal.modulusAt(0.28), 0) << name;
    for (const int draw : {1, 2, 3, 4, 5, 6, 7, 8}) {
      const ::grouser::scm::SoilConstants c =
          read(text + "[scm]\nconstants = \"measured\"\nconstants_draw = " + std::to_string(draw) + "\n").soil;
      EXPECT_TRUE(c.exponent > 0 && c.modulusAt(0.28) > 0 && c.cohesion > 0 && c.shearDisplacement > 0) << name << draw;
    }
    ++soils;
  }
  EXPECT_GE(soils, 5);
}

TEST(ScmSetup, StifferUnloadingLowersTheStepLimitOfAShoe) {
  const auto limit = [](const char* keys) {
    const scene::Scene scene = scene::readSceneText(kScene + keys, GROUSER_SOURCE_DIR "/runs/scenes/scm.toml");
    StepLimit all;
    considerVehicle(all, scene, vehicle::readVehicleSpec(scene.vehicle->source()));
    for (const StepLimit::Bound& bound : all.vehicle)
      if (bound.what == "shoe on soil under a road wheel") return bound.step;
    return base::kNaN;
  };
  EXPECT_LT(limit("[scm]\nelastic_ratio = 1000\n"), 0.7 * limit("[scm]\nelastic_ratio = 10\n"));
}

TEST(ScmSetup, SoilAloneHasNoLimitOfAShoeOnRigidGround) {
  const auto hasLimit = [](const std::string& keys) {
    const scene::Scene scene = scene::readSceneText(kScene + keys, GROUSER_SOURCE_DIR "/runs/scenes/scm.toml");
    StepLimit all;
    considerVehicle(all, scene, vehicle::readVehicleSpec(scene.vehicle->source()));
    return std::any_of(all.vehicle.begin(), all.vehicle.end(),
                       [](const StepLimit::Bound& b) { return b.what == "shoe on rigid ground or wheel"; });
  };
  EXPECT_FALSE(hasLimit(""));
  EXPECT_TRUE(hasLimit("[[box]]\nmaterial = \"lete_sand\"\nsize = [1, 1, 1]\nposition = [6, 0, -0.4]\n"));
}

TEST(ScmSetup, NamesWhatIsMissingOrWrong) {
  std::string other = kScene;
  other.replace(other.find("lete_sand"), 9, "gravel");
  std::string noSoil = kScene;
  noSoil.replace(noSoil.find("lete_sand"), 9, "m");
  noSoil += "[material.m]\nstiffness = 1e6\n";
  std::string noVehicle = kScene.substr(0, kScene.find("[vehicle]"));
  std::string reposeOnly = kScene;
  reposeOnly.replace(reposeOnly.find("lete_sand"), 9, "cmu_sand");
  const std::pair<std::string, const char*> cases[] = {
      {reposeOnly + "[scm]\nconstants = \"measured\"\n", "the soil cmu_sand has no measured n, k_c, k_phi, "},
      {kScene + "[scm]\nconstants_draw = -1\n", "constants_draw = -1"},
      {kScene + "[scm]\nconstants_draw = 1.5\n", "constants_draw"},
      {kScene + "[scm]\nconstants_draw = 3\nn = 1\nk_c = 0\nk_phi = 5e6\nc = 1e3\nphi = 30\nK = 0.01\n",
       "constants_draw = 3 has no effect, since"},
      {other, "requires scm.n [-], scm.k_c [N/m^(n+1)], scm.k_phi [N/m^(n+2)], scm.K [m]: the soil gravel has no "
              "published n, k_c, k_phi, K; add them to [scm]"},
      {noSoil, "the soil file m does not exist; add them to [scm]"},
      {noVehicle, "has no effect without a [vehicle] or a [[body]]"},
      {kScene + "[scm]\nk_c = -5e6\n", "has no bearing capacity"},
      {kScene + "[scm]\nnode_spacing = 0.2\n", "exceeds the shoe length, 0.136 m"},
      {kScene + "[scm]\nn = 0\n", "n = 0"},
      {kScene + "[scm]\nelastic_ratio = 0.5\n", "elastic_ratio = 0.5"},
      {kScene + "[scm]\nphi = 90\n", "phi = 90"},
      {kScene + "[scm]\nconstants = \"guessed\"\n", "published"},
      {kScene + "[scm]\nslip_sinkage = -0.1\n", "slip_sinkage = -0.1"},
      {kScene + "[scm]\nslip_sinkage = 2\n", "slip_sinkage = 2"},
      {kScene + "[scm]\nmaximum_slip_sinkage = -1\n", "maximum_slip_sinkage = -1"},
      {kScene + "[scm]\ndisplaced_share = 1.2\n", "displaced_share = 1.2"},
      {kScene + "[scm]\nrepose_angle = 0\n", "repose_angle = 0"},
      {kScene + "[scm]\nbulk_density = -1\n", "bulk_density = -1"},
      {kScene + "[scm]\nnode_spacing = 0\n", "node_spacing = 0"},
      {kScene + "[scm]\nlargest_sinkage = 0\n", "largest_sinkage = 0"},
      {kScene + "[scm]\nn = 4\n", "n = 4"},
      {kScene + "[scm]\nK = 0\n", "K = 0"},
      {kScene + "[scm]\nc = -1\n", "c = -1"},
      {kScene + "[scm]\ndamping = -1\n", "damping = -1"},
      {kScene + "[scm]\nunloading_growth = -1\n", "unloading_growth = -1"},
      {kScene + "[scm]\nk_c = \"many\"\n", "k_c"},
      {kScene + "[scm]\nk_c = -4e6\nk_phi = 2e7\n", "for single shoes of width b = 0.136 m"},
      {kScene + "[scm]\nkc = 1\n", "k_c"}};
  for (const auto& [text, message] : cases) {
    const std::string found = test::messageOf([&, scene = text] { read(scene); });
    EXPECT_NE(found.find(message), std::string::npos) << message << "\n" << found;
  }
  std::string rigid = kScene;
  rigid.replace(rigid.find("\"scm\""), 5, "\"rigid\"");
  EXPECT_NE(
      test::messageOf([&] { scene::readSceneText(rigid + "[scm]\nn = 1\n", "s.toml"); }).find("terrain.kind = \"scm\""),
      std::string::npos);
}

} // namespace
} // namespace grouser::setup::scm
