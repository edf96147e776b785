// SPDX-License-Identifier: BSD-3-Clause
// Output of `grouser plan` for a scene: active features, material pairs, warnings.
#include "runs/commands/plan.hpp"

#include "coupling/simulation.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/contact_pairs.hpp"
#include "runs/setup/grain_memory.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/setup/simulation_setup.hpp"
#include "runs/setup/step_limit.hpp"
#include "terrain/kernel_choice.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace grouser::commands {
namespace {

scene::Scene parsed(const std::string& text, const std::vector<std::string>& overrides = {}) {
  return setup::parseScene("version = 1\n[run]\nduration = 0.1\n" + text, "scene.toml", overrides);
}

void expectSaid(const std::string& plan, const std::string& words) {
  EXPECT_NE(plan.find(words), std::string::npos) << words << " in\n" << plan;
}
void expectNotSaid(const std::string& plan, const std::string& words) {
  EXPECT_EQ(plan.find(words), std::string::npos) << words << " in\n" << plan;
}

const std::string kGrain = "[[grain]]\nposition = [0, 0, 1]\nradius = 0.02\nmaterial = \"soil\"\n";
const std::string kSoil = "[material.soil]\nstiffness = 1e5\nrestitution = 0.3\n";

TEST(PlanOfGrains, SaysWhatTheyHaveAndWhichKernelRuns) {
  const std::string mixed =
      planText(parsed("[material.glass]\nlaw = \"hertz\"\nyoung = 1e8\nfriction = 0.4\nrolling_friction = 0.02\n"
                      "[material.clay]\nlaw = \"hertz\"\nyoung = 2e7\nfriction = 0.6\nrolling_friction = 0.1\n"
                      "cohesion = 0.2\n[[plane]]\nmaterial = \"glass\"\n[[grain]]\nposition = [0, 0, 0.05]\n"
                      "radius = 0.02\nmaterial = \"glass\"\n[[grain]]\nposition = [0, 1, 0.05]\nradius = 0.01\n"
                      "material = \"clay\"\n"));
  expectSaid(mixed, "on   rolling history");
  expectSaid(mixed, "on   radius of each grain");
  expectSaid(mixed,
             "kernel of the grains       hertz, friction, rolling friction, cohesion, many radii, many materials, "
             "planes or floor, ledger; single precision: general kernel, same results but slower");
  const std::string plain = planText(parsed("[material.soil]\n[[plane]]\nmaterial = \"soil\"\n" + kGrain));
  expectSaid(plain, "off  rolling history");
  expectSaid(plain, "off  radius of each grain");
  expectSaid(
      plain,
      "kernel of the grains       linear, friction, planes or floor, ledger; single precision: specialised kernel");
}

TEST(PlanOfGrains, NamesPeriodicBoundaries) {
  expectSaid(planText(parsed("periodic = [true, false]\ndomain_x = [-0.5, 0.5]\n" + kSoil + kGrain)),
             "on   periodic boundaries        x");
}

TEST(PlanOfGrains, WarnsWhereTheyTrembleAtRest) {
  scene::Scene scene = parsed("[material.soil]\ndensity = 2000\nstiffness = 3e5\nrestitution = 0.05\nfriction = 0.5\n" +
                              kGrain + "[[grain]]\nposition = [0, 1, 1]\nradius = 0.02\nmaterial = \"soil\"\n");
  const setup::StepLimit limit = setup::stepLimit(scene);
  ASSERT_LT(limit.calm, limit.step);
  scene.run.timeStep = 0.5 * (limit.calm + limit.step);
  expectSaid(planText(scene), "vibrate");
  scene.run.timeStep = 0.99 * limit.calm;
  expectNotSaid(planText(scene), "vibrate");
}

/// A bed of twelve grains across and six deep.
scene::Scene bed(const std::vector<std::string>& overrides = {}, const std::string& more = "") {
  return parsed(kSoil +
                    "[terrain]\nheightmap = \"heightmaps/flat.png\"\nsize = [0.6, 0.6]\nheight_range = [0, 0]\n"
                    "material = \"soil\"\ngrain_radius = 0.025\ndepth = 0.3\nsettle_kinetic_energy = 1e-3\n" +
                    more,
                overrides);
}

TEST(PlanOfABed, IsRandomUnlessALatticeIsAskedForAndPreparedToAPorosity) {
  expectSaid(planText(bed()), "on   random arrangement");
  expectSaid(planText(bed()), "off  preparation");
  expectSaid(planText(bed({"terrain.porosity=0.4"})), "on   preparation");
  expectSaid(planText(bed({}, "arrangement = \"lattice\"\n")), "off  random arrangement");
}

const std::string kPlate = "[[box]]\nname = \"plate\"\nmaterial = \"soil\"\nposition = [0.3, 0, 5]\n"
                           "size = [0.2, 0.2, 0.04]\n";

TEST(PlanOfABed, SaysWhatIsPutOnItLater) {
  const std::string rigs = kPlate +
                           "free = \"z\"\nmass = 4\nabove_bed = 0.002\n[[mesh]]\nfile = \"meshes/road_wheel.obj\"\n"
                           "scale = 0.2\nposition = [0.3, 0.22, 0]\nmaterial = \"soil\"\nabove_bed = 0.001\n"
                           "free = \"z\"\nmass = 2\n[[grain]]\nposition = [0.15, -0.2, 0]\nradius = 0.04\n"
                           "material = \"soil\"\nabove_bed = 0.001\n";
  expectSaid(planText(bed({}, rigs)), "plate, mesh0, 1 grain");
  expectSaid(planText(bed({}, kPlate)), "off  placed on settled bed");
}

TEST(PlanOfSurfaces, NamesThemAndCountsThoseThatMove) {
  const std::string plan = planText(parsed(
      kSoil + kGrain +
      "[[plane]]\npoint = [0, -0.05, 0]\nnormal = [0, 1, 0]\namplitude = [0, 0.002, 0]\nfrequency = 25\n"
      "material = \"soil\"\n[[box]]\nposition = [0.07, 0, 0]\nsize = [0.012, 0.1, 0.02]\nspin = [0, 8, 0]\n"
      "material = \"soil\"\n[[cylinder]]\nname = \"drum\"\nposition = [0, 0, 0]\naxis = [0, 1, 0]\nradius = 0.08\n"
      "length = 0.1\nhollow = true\nspin = [0, 8, 0]\nmaterial = \"soil\"\n[[cylinder]]\nposition = [0, 0.06, 0]\n"
      "axis = [0, 1, 0]\nradius = 0.08\nlength = 0.02\nfree = \"y\"\nmass = 0.5\nload = -0.2\nspin = [0, 8, 0]\n"
      "material = \"soil\"\n"));
  expectSaid(plan, "plane0, box0, drum, cylinder1; 3 moved, 1 free, 1 of these also driven");
  expectSaid(plan, "moving surfaces");
  expectSaid(planText(parsed(kSoil + kGrain)), "off  surfaces");
}

TEST(PlanOfSurfaces, NotesALightOneThatLowersTheRestitution) {
  expectSaid(planText(parsed("[material.soil]\ndensity = 2500\nstiffness = 1e5\nrestitution = 0.5\n" + kGrain +
                             "[[box]]\nname = \"plate\"\nposition = [0, 0, 0]\nsize = [1, 1, 0.1]\n"
                             "material = \"soil\"\nfree = \"z\"\nmass = 0.01\n")),
             "\nnote: box \"plate\" is free and has a mass of 0.01 kg");
}

TEST(PlanOfPairs, SaysWhatDoesNothing) {
  const std::string pairs = "[material.soil]\nstiffness = 1e5\nfriction = 0.6\n[material.rough]\nstiffness = 3e5\n"
                            "friction = 0.9\nrolling_friction = 0.3\n[[plane]]\nmaterial = \"rough\"\n" +
                            kGrain;
  const std::string plan = planText(parsed(pairs)), nothing = "rolling_friction = 0.3 of material.rough has no effect";
  expectSaid(plan, nothing + " in contact with soil, which has 0");
  expectSaid(plan, "[contact.\"soil|rough\"]");
  expectSaid(plan, "grain on a plane: soil, rough");
  expectNotSaid(planText(parsed(pairs + "[contact.\"soil|rough\"]\nrolling_friction = 0.2\n")), nothing);
}

TEST(PlanOfPairs, SaysWhyNothingSticksToAVehicle) {
  const auto line = [](const std::vector<std::string>& overrides, const std::string& scene = "coupled") {
    const std::string text =
        switchesText(setup::loadScene(GROUSER_SOURCE_DIR "/tests/scenes/" + scene + ".toml", overrides));
    const std::size_t at = text.find("soil adhesion to vehicle");
    return at == std::string::npos ? "" : text.substr(at - 5, text.find('\n', at) - at + 5);
  };
  const std::string coheres = "material.soil.cohesion=8", eepa = "material.soil.law=eepa_linear";
  EXPECT_EQ(line({}), "off  soil adhesion to vehicle   grains have no cohesion");
  EXPECT_EQ(line({coheres}), "off  soil adhesion to vehicle   vehicle.adhesion = 0");
  EXPECT_EQ(line({coheres, "vehicle.adhesion=0.5"}), "on   soil adhesion to vehicle   cohesion of 4 J/m2");
  EXPECT_EQ(line({eepa, "material.soil.plasticity=0.5", "material.soil.surface_energy=3", "vehicle.adhesion=1"}),
            "off  soil adhesion to vehicle   surface_energy and adhesion_stiffness act only between grains");
  EXPECT_EQ(line({"vehicle.adhesion=1"}, "rigid"),
            "off  soil adhesion to vehicle   no grains: vehicle.adhesion has no effect");
  EXPECT_EQ(line({}, "rigid"), "");
}

TEST(PlanOfGrains, NamesTheKernelsOfTheRun) {
  for (const std::string name : {"rain", "mixture", "moving"}) {
    const scene::Scene scene = setup::loadScene(std::string(GROUSER_SOURCE_DIR) + "/tests/scenes/" + name + ".toml");
    const setup::KernelTraits traits = setup::kernelTraits(scene, setup::ContactPairs(scene));
    const coupling::Simulation run(setup::simulationSetup(scene), base::cpuExec(1), [](double, double) {});
    const terrain::GrainConstants& c = run.ground().grains->system().constants;
    EXPECT_EQ(c.features, traits.features) << name;
    const std::string plan = switchesText(scene);
    EXPECT_NE(plan.find("kernel of the grains       " + terrain::stepKernelText(c.features, c.model) + "\n"),
              std::string::npos)
        << plan;
    EXPECT_NE(plan.find("kernel of walls and floor  " + terrain::boundaryKernelText(c.features, c.model) + "\n"),
              std::string::npos)
        << plan;
  }
}

} // namespace
} // namespace grouser::commands
