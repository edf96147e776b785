// SPDX-License-Identifier: BSD-3-Clause
// Random beds: prepared to a porosity, graded, on rough floors, the same on all threads, after a resume and in tiles.
#include "runs/simulation/bed_preparation.hpp"

#include "base/error.hpp"
#include "runs/commands/plan.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/setup/simulation_setup.hpp"
#include "runs/simulation/simulation.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace grouser::simulation {
namespace {

/// Twelve mean diameters wide and six deep, between periodic boundaries; quick to settle.
scene::Scene bed(const std::vector<std::string>& overrides = {}) {
  return setup::parseScene("version = 1\n[run]\nduration = 0.02\ntime_step = 2e-4\nperiodic = [true, true]\n"
                           "[material.soil]\nstiffness = 1e5\nrestitution = 0.3\n"
                           "[terrain]\nheightmap = \"heightmaps/flat.png\"\nsize = [0.6, 0.6]\n"
                           "height_range = [0, 0]\nmaterial = \"soil\"\ngrain_radius = 0.025\ndepth = 0.3\n"
                           "settle_kinetic_energy = 1e-3\ncache = false\n",
                           "bed.toml", overrides);
}

std::unique_ptr<Simulation> simulated(const scene::Scene& scene, int threads = 1) {
  return std::make_unique<Simulation>(setup::simulationSetup(scene), base::cpuExec(threads), [](double, double) {});
}

const terrain::BedStructure& structure(const Simulation& s) { return *s.ground().structure; }

TEST(BedPreparation, PorosityWantedIsReached) {
  // Single beds of 1500 grains scatter by 0.004 about what the small bed of the bisection has (12 seeds).
  double former = 0;
  for (const double wanted : {0.39, 0.41, 0.43}) {
    const auto s = simulated(bed({"terrain.porosity=" + std::to_string(wanted)}));
    EXPECT_NEAR(structure(*s).porosity, wanted, 0.015);
    EXPECT_GT(structure(*s).porosity, former);
    EXPECT_GT(s->settled().friction, 0);
    EXPECT_LT(structure(*s).order, 0.05);
    former = structure(*s).porosity;
    // The grains rub with their own friction again.
    EXPECT_EQ(s->ground().grains->model().law.friction, 0.5);
  }
}

TEST(BedPreparation, PorosityOutOfReachIsRefusedWithWhatCanBeReached) {
  try {
    simulated(bed({"terrain.porosity=0.25"}));
    FAIL() << "spheres of these radii do not pack so densely";
  } catch (const base::InputError& error) {
    for (const char* part : {"bed.toml", "terrain.porosity = 0.25", "cannot be reached", "choose a porosity between"})
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
  }
  EXPECT_THROW(setup::simulationSetup(bed({"terrain.porosity=0.4", "material.soil.friction=0"})), base::InputError);
}

TEST(BedPreparation, FindsTheSameFrictionForEverySeed) {
  const auto a = simulated(bed({"terrain.porosity=0.41", "run.seed=3"})),
             b = simulated(bed({"terrain.porosity=0.41", "run.seed=4"}));
  EXPECT_EQ(a->settled().friction, b->settled().friction);
  EXPECT_NE(a->stateHash(), b->stateHash());
}

TEST(RandomBeds, AreTheSameOnAllThreadsWithAllSkinsAndResumed) {
  const scene::Scene scene = bed();
  const auto straight = simulated(scene), parallel = simulated(scene, 2), wide = simulated(bed({"run.skin=0.5"}));
  const std::string settled = straight->stateHash();
  EXPECT_EQ(parallel->stateHash(), settled);
  EXPECT_EQ(wide->stateHash(), settled);
  Simulation resumed(setup::simulationSetup(scene), base::cpuExec(1), straight->save());
  for (int k = 0; k < 50; ++k) straight->step(), resumed.step();
  EXPECT_EQ(resumed.stateHash(), straight->stateHash());
  EXPECT_EQ(structure(resumed).porosity, structure(*straight).porosity);
  EXPECT_EQ(structure(resumed).radialDistribution, structure(*straight).radialDistribution);
}

TEST(RandomBeds, LieWhereTheHeightMapSays) {
  // Mean tops lie about half a mean radius above the height at which the bed would be full to the brim.
  const auto s = simulated(bed({"terrain.porosity=0.41"}));
  EXPECT_NEAR(structure(*s).settledHeight, 0, 0.025);
}

TEST(RandomBeds, FixedGrainsHoldTheFloor) {
  const auto rough = simulated(bed()), smooth = simulated(bed({"terrain.floor_grains=false"}));
  const terrain::GrainSnapshot grains = rough->ground().grains->snapshot();
  ASSERT_EQ(grains.fixed.size(), grains.position.size());
  const auto fixed = std::count_if(grains.fixed.begin(), grains.fixed.end(), [](auto f) { return f != 0; });
  EXPECT_EQ(fixed, 12 * 12);
  EXPECT_TRUE(smooth->ground().grains->snapshot().fixed.empty());
  // Pulled sideways by a fifth of its weight for 0.2 s, the bed on balls slides and that on fixed grains does not.
  const auto drift = [](const std::vector<std::string>& overrides) {
    scene::Scene scene = bed(overrides);
    const auto s = simulated(scene);
    const SimulationState settled = s->save();
    scene.run.gravity = {0.2 * 9.81, 0, -9.81};
    Simulation tilted(setup::simulationSetup(scene), base::cpuExec(1), settled);
    for (int k = 0; k < 1000; ++k) tilted.step();
    const terrain::GrainLedger l = tilted.ground().grains->ledger();
    return l.momentum.x;
  };
  const double onGrains = drift({}), onPlane = drift({"terrain.floor_grains=false"});
  EXPECT_LT(onGrains, 0.2 * onPlane);
}

TEST(RandomBeds, GradedBedKeepsItsFineGrainsAbove) {
  const auto s = simulated(bed({"terrain.grain_radius=0.015", "terrain.fine_depth=0.08", "terrain.coarsening=0.15",
                                "terrain.coarsest_radius=0.03"}));
  const terrain::GrainSnapshot grains = s->ground().grains->snapshot();
  double above = 0, below = 0, finestBelow = 1;
  int na = 0, nb = 0;
  for (std::size_t g = 0; g < grains.position.size(); ++g) {
    if (grains.fixed[g]) continue;
    const double z = grains.position[g].z, r = static_cast<double>(grains.radius[g]);
    if (z > -0.07) above += r, ++na;
    if (z < -0.2) below += r, ++nb, finestBelow = std::min(finestBelow, r);
  }
  ASSERT_TRUE(na > 500 && nb > 50);
  EXPECT_NEAR(above / na, 0.015, 0.001);
  EXPECT_GT(below / nb, 0.026);
  EXPECT_GT(finestBelow, 0.012) << "none of the finest has trickled down to the floor";
}

TEST(RandomBeds, TilesKeepTheirPorosity) {
  const std::vector<std::string> wide = {"terrain.size=[1.2, 1.2]", "terrain.porosity=0.41"};
  auto tiled = wide;
  tiled.push_back("terrain.tile=[0.6, 0.6]");
  const auto s = simulated(bed(tiled));
  EXPECT_NEAR(structure(*s).porosity, 0.41, 0.015);
  EXPECT_EQ(s->ground().grains->count() % 4, 0u);
}

TEST(RandomBeds, CrystalsAreRefused) {
  const setup::SimulationSetup setup = setup::simulationSetup(bed({"terrain.radius_distribution=single"}));
  terrain::BedStructure crystal;
  crystal.grains = 1000, crystal.order = 0.8, crystal.porosity = 1 - 0.645;
  EXPECT_THROW(checkStructure(*setup.ground.grains->bed, crystal), base::SimulationError);
  crystal.porosity = 1 - 0.639;
  EXPECT_NO_THROW(checkStructure(*setup.ground.grains->bed, crystal));
  // Unequal radii pack more densely without order.
  crystal.porosity = 1 - 0.645;
  EXPECT_NO_THROW(checkStructure(*setup::simulationSetup(bed()).ground.grains->bed, crystal));
}

TEST(RandomBeds, LatticeIsNoMoreThanOnRequest) {
  EXPECT_NE(commands::planText(bed()).find("on   random arrangement"), std::string::npos);
  EXPECT_NE(commands::planText(bed()).find("off  preparation"), std::string::npos);
  EXPECT_NE(commands::planText(bed({"terrain.porosity=0.4"})).find("on   preparation"), std::string::npos);
}

} // namespace
} // namespace grouser::simulation
