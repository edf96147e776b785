// SPDX-License-Identifier: BSD-3-Clause
// Scenes with complementarity contacts: their time step, and rejected keys.
#include "base/error.hpp"
#include "runs/setup/complementarity_setup.hpp"
#include "runs/setup/ground_setup.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/setup/simulation_setup.hpp"
#include "runs/setup/step_limit.hpp"
#include "terrain/grain_constants.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace grouser::setup {
namespace {

const std::string kSand = "[material.sand]\nstiffness = 1e6\nrestitution = 0.5\nfriction = 0.5\n",
                  kGrains = "[[grain]]\nposition = [0, 0, 0.02]\nradius = 0.01\nmaterial = \"sand\"\n"
                            "[[plane]]\npoint = [0, 0, 0]\nnormal = [0, 0, 1]\nmaterial = \"sand\"\n";

std::string run(const std::string& more = "") {
  return "version = 1\n[run]\nduration = 1\ncontact = \"complementarity\"\n" + more;
}

scene::Scene parsed(const std::string& text) { return parseScene(text, "scene.toml"); }

TEST(ComplementarityScene, StepsFollowGravityAndImpactsNotStiffness) {
  const double falls = 0.03 * std::sqrt(0.02 / 9.81), meets = 0.08 * 0.02;
  ASSERT_LT(falls, meets);
  for (const std::string more : {"", "[contact.\"sand|sand\"]\nstiffness = 1e9\n"})
    EXPECT_NEAR(chooseTimeStep(parsed(run() + kSand + more + kGrains)), falls, 1e-12);
  EXPECT_NEAR(chooseTimeStep(parsed(run("impact_speed = 4\n") + kSand + kGrains)), 0.08 * 0.02 / 4, 1e-12);
  EXPECT_EQ(chooseTimeStep(parsed(run("time_step = 2e-3\n") + kSand + kGrains)), 2e-3);
}

TEST(ComplementarityScene, AVehicleKeepsItsOwnStepBesideStiffGrains) {
  const std::string text =
      "[material.sand]\nstiffness = 1e8\nrestitution = 0.5\nfriction = 0.5\n[terrain]\nheightmap = "
      "\"" GROUSER_SOURCE_DIR "/assets/heightmaps/flat.png\"\nsize = [4, 2.5]\nheight_range = [0, 0]\n"
      "material = \"sand\"\ngrain_radius = 0.04\ndepth = 0.2\n[vehicle]\nspec = \"" GROUSER_SOURCE_DIR
      "/assets/vehicles/light_tracked.toml\"\nsphere_radius = 0.02\n[driver]\n"
      "sprocket_speed = 2\n";
  const double chosen = chooseTimeStep(parsed(run() + text));
  EXPECT_LE(chosen, kVehicleTimeStep);
  EXPECT_GT(chosen, 0.5 * kVehicleTimeStep);
  EXPECT_EQ(
      chooseTimeStep(loadScene(GROUSER_SOURCE_DIR "/runs/scenes/m113_like.toml", {"run.contact=complementarity"})),
      kVehicleTimeStep);
  EXPECT_EQ(chooseTimeStep(parsed(run("time_step = 5e-5\n") + text)), 5e-5);
  const double springs = chooseTimeStep(parsed("version = 1\n[run]\nduration = 1\n" + text));
  EXPECT_LT(springs, 0.2 * kVehicleTimeStep);
  EXPECT_THROW(chooseTimeStep(parsed(run("time_step = 2e-3\n") + text)), base::InputError);
}

TEST(ComplementarityScene, KeysReachTheModel) {
  const std::string section = "[complementarity]\nfriction = \"associated\"\ncompliance = \"rigid\"\niterations = 7\n"
                              "recovery = 0.3\nstrict = true\n";
  const auto options = simulationSetup(parsed(run("residual = 1e-5\ntime_step = 1e-3\n") + section + kSand + kGrains))
                           .ground.grains->model.complementarity;
  contact::ComplementarityOptions expected;
  expected.friction = contact::ImpulseFriction::associated, expected.compliance = contact::Compliance::rigid;
  expected.iterations = 7, expected.recovery = 0.3, expected.strict = true, expected.residual = 1e-5;
  expected.impact = 5 * 9.81 * 1e-3, expected.reach = 2e-3;
  EXPECT_EQ(*options, expected);
  const auto usual =
      simulationSetup(parsed(run("time_step = 1e-3\n") + kSand + kGrains)).ground.grains->model.complementarity;
  EXPECT_NEAR(usual->residual, 0.01 * 9.81 * 1e-3, 1e-15);
  EXPECT_FALSE(simulationSetup(parsed("version = 1\n[run]\nduration = 1\n" + kSand + kGrains))
                   .ground.grains->model.complementarity);
}

TEST(ComplementarityScene, RefusesWhatItDoesNotHave) {
  const std::string body = "[[body]]\nname = \"b\"\nmaterial = \"sand\"\nmass = 1\nposition = [0, 0, 1]\n"
                           "[[body.shape]]\nkind = \"sphere\"\nradius = 0.1\n";
  const std::vector<std::pair<std::string, std::string>> all = {
      {run() + kSand + "[[plane]]\npoint = [0, 0, 0]\nnormal = [0, 0, 1]\nmaterial = \"sand\"\n" + body,
       "has no effect without grains"},
      {run() + kSand + "crushing_strength = 1e6\n" + kGrains, "[Pa] is not supported with complementarity contacts"},
      {run() + "[material.sand]\nlaw = \"luding\"\nstiffness = 1e6\n" + kGrains, "is elastic-plastic, which"},
      {run() + "[material.sand]\nlaw = \"eepa\"\nyoung = 1e8\n" + kGrains, "is elastic-plastic, which"},
      {run() + kSand + kGrains + "[output]\nfields_cell = 0.1\nfields_low = [-1, -1, 0]\nfields_high = [1, 1, 1]\n",
       "requires penalty contacts, since stresses are computed from contact springs"},
      {run() + "[complementarity]\ncompliance = \"rigid\"\n" + kSand + "cohesion = 0.1\n" + kGrains,
       "requires contact overlap, which rigid contacts do not have"},
      {run() + "[complementarity]\ncompliance = \"rigid\"\n" + kSand + kGrains +
           "[contact.\"sand|sand\"]\ncohesion = 0.1\n",
       "has cohesion, which requires contact overlap"},
      {run() + "[complementarity]\nrecovery = 0.2\n" + kSand + kGrains,
       "[m/s] has no effect with compliance = \"law\""},
      {run("steps_per_contact = 30\n") + kSand + kGrains,
       "has no effect with contact = \"complementarity\", whose steps"},
      {run() + kSand + "attraction = true\n" + kGrains,
       "has no effect with run.contact = \"complementarity\", whose dashpots"},
      {run("gravity = [0, 0, 0]\n") + kSand + kGrains, "cannot be \"auto\" with run.gravity = 0"},
      {run("residual = 0\n") + kSand + kGrains, "residual"},
      {run("residual = -1\n") + kSand + kGrains, "residual"},
      {run("residual = 11\n") + kSand + kGrains, "residual"},
      {run("residual = \"small\"\n") + kSand + kGrains, "residual"},
      {"version = 1\n[run]\nduration = 1\ncontact = \"springs\"\n" + kSand + kGrains, "contact"},
      {"version = 1\n[run]\nduration = 1\nresidual = 1e-4\n" + kSand + kGrains,
       "without contact = \"complementarity\""},
      {"version = 1\n[run]\nduration = 1\n[complementarity]\niterations = 9\n" + kSand + kGrains,
       "has no effect without run.contact = \"complementarity\""},
      {run() + "[complementarity]\niterations = 0\n" + kSand + kGrains, "iterations"},
      {run() + "[complementarity]\niterations = 2.5\n" + kSand + kGrains, "iterations"},
      {run() + "[complementarity]\niterations = 1e9\n" + kSand + kGrains, "iterations"},
      {run() + "[complementarity]\nfriction = \"dry\"\n" + kSand + kGrains, "friction"},
      {run() + "[complementarity]\ncompliance = \"soft\"\n" + kSand + kGrains, "compliance"},
      {run() + "[complementarity]\nrecovery = -0.1\n" + kSand + kGrains, "recovery"},
      {run() + "[complementarity]\nstrict = 1\n" + kSand + kGrains, "strict"},
      {run() + "[complementarity]\nomega = 1\n" + kSand + kGrains, "omega"},
      {run("time_step = 0.01\n") + kSand + kGrains +
           "[[grain]]\nposition = [0, 1, 0.02]\nvelocity = [2, 0, 0]\n"
           "radius = 0.01\nmaterial = \"sand\"\n",
       "moves a grain by more than 0.4 of the smallest radius per step"},
  };
  for (const auto& [text, said] : all) {
    try {
      static_cast<void>(simulationSetup(parsed(text)));
      ADD_FAILURE() << "taken: " << text;
    } catch (const base::InputError& fault) {
      EXPECT_NE(std::string(fault.what()).find(said), std::string::npos) << fault.what();
    }
  }
}

TEST(ComplementarityScene, TakesKeysOfPenaltyContactsWherePartsHaveThem) {
  const std::string body = "[[body]]\nname = \"b\"\nmaterial = \"sand\"\nmass = 1\nposition = [0, 0, 1]\n"
                           "[[body.shape]]\nkind = \"sphere\"\nradius = 0.1\n";
  EXPECT_NO_THROW(
      checkComplementarity(parsed(run("steps_per_contact = 30\n") + kSand + "attraction = true\n" + kGrains + body)));
  EXPECT_NO_THROW(checkComplementarity(
      parsed(run() + "[complementarity]\ncompliance = \"rigid\"\nrecovery = 0.2\n" + kSand + kGrains)));
}

TEST(ComplementarityScene, PeriodicSidesLeaveRoomForGaps) {
  // Three cells of a diameter of 20 mm, a skin of 3 mm and gaps of 2 h impact_speed and 8 h impact_speed: 99 mm.
  const auto scene = [](double width) {
    return parsed(run("time_step = 1e-3\nperiodic = [true, false]\ndomain_x = [0, " + std::to_string(width) + "]\n") +
                  kSand + "[[grain]]\nposition = [0.04, 0, 0.02]\nradius = 0.01\nmaterial = \"sand\"\n");
  };
  const coupling::SimulationSetup fits = simulationSetup(scene(0.0991));
  terrain::Boundaries boundaries = fits.ground.grains->boundaries;
  EXPECT_NO_THROW(terrain::GrainConstants(fits.ground.grains->model, boundaries, {}));
  (*boundaries.periodic[0])[1] = 0.0989;
  EXPECT_THROW(terrain::GrainConstants(fits.ground.grains->model, boundaries, {}), base::InputError);
  EXPECT_NO_THROW(checkGround(scene(0.0991), 1e-3));
  EXPECT_THROW(checkGround(scene(0.0989), 1e-3), base::InputError) << "as plan checks it";
  EXPECT_THROW(simulationSetup(scene(0.0989)), base::InputError);
}

} // namespace
} // namespace grouser::setup
