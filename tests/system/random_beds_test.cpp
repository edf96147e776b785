// SPDX-License-Identifier: BSD-3-Clause
// Random beds: prepared to a porosity, graded, on rough floors; identical on all threads, after a resume and in tiles.
#include "base/error.hpp"
#include "base/math.hpp"
#include "coupling/settling.hpp"
#include "coupling/simulation.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/setup/simulation_setup.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <memory>

namespace grouser::coupling {
namespace {

/// Twelve mean diameters wide and six deep, between periodic boundaries; settles quickly.
scene::Scene randomBed(const std::vector<std::string>& overrides = {}) {
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

TEST(BedPreparation, PorosityWantedIsReachedWithTheSameFrictionForEverySeed) {
  // Beds of 1000 grains scatter by 0.004 about the porosity of the bisection's small bed (12 seeds).
  const auto dense = simulated(randomBed({"terrain.porosity=0.37"})),
             loose = simulated(randomBed({"terrain.porosity=0.4"})),
             other = simulated(randomBed({"terrain.porosity=0.4", "run.seed=4"}));
  EXPECT_NEAR(structure(*dense).porosity, 0.37, 0.012);
  EXPECT_NEAR(structure(*loose).porosity, 0.4, 0.012);
  EXPECT_NEAR(structure(*other).porosity, 0.4, 0.012);
  EXPECT_GT(structure(*dense).coordination, structure(*loose).coordination);
  EXPECT_GT(loose->settled().friction, dense->settled().friction);
  EXPECT_EQ(loose->settled().friction, other->settled().friction);
  EXPECT_NE(loose->stateHash(), other->stateHash());
  for (const auto* s : {&dense, &loose, &other}) {
    EXPECT_LT(structure(**s).order, 0.05);
    // The grains have their own friction again.
    EXPECT_EQ((*s)->ground().grains->model().law.friction, 0.5);
  }
}

/// Keeps beds in memory.
struct Remembered final : FoundFrictions {
  mutable std::map<std::string, double> all;
  std::optional<double> find(const std::string& origin) const override {
    const auto at = all.find(origin);
    return at == all.end() ? std::nullopt : std::optional(at->second);
  }
  void keep(const std::string& origin, double friction) const override { all[origin] = friction; }
};

TEST(BedPreparation, FrictionIsFoundOnceForBedsOfOneSoil) {
  const Remembered found;
  int looks = 0;
  const auto friction = [&](std::vector<std::string> overrides) {
    overrides.insert(overrides.begin(), {"terrain.cache=true", "terrain.porosity=0.37"});
    const SimulationSetup setup = setup::simulationSetup(randomBed(overrides));
    looks = 0;
    return frictionFor(
        *setup.ground.grains->bed->preparation, base::cpuExec(1), [&](double, double) { ++looks; }, &found);
  };
  const double first = friction({});
  EXPECT_GT(looks, 0);
  EXPECT_EQ(friction({"run.seed=4", "terrain.size=[1.2, 0.9]"}), first);
  EXPECT_EQ(looks, 0) << "no bed has settled";
  EXPECT_EQ(found.all.size(), 1u);
  EXPECT_NE(friction({"material.soil.rolling_friction=0.1"}), first);
  EXPECT_GT(looks, 0) << "a different soil";
}

TEST(BedPreparation, LooserBedsNeedMoreFrictionAndEverySeedTheSame) {
  const auto friction = [](const char* porosity, const char* seed) {
    const SimulationSetup setup = setup::simulationSetup(randomBed({porosity, seed}));
    return frictionFor(*setup.ground.grains->bed->preparation, base::cpuExec(1), [](double, double) {});
  };
  const double loose = friction("terrain.porosity=0.4", "run.seed=1");
  EXPECT_EQ(friction("terrain.porosity=0.4", "run.seed=4"), loose);
  EXPECT_LT(friction("terrain.porosity=0.37", "run.seed=1"), loose);
}

TEST(BedPreparation, GrainsStickOnlyOnceTheyLie) {
  const std::vector<std::string> wanted = {"terrain.porosity=0.38"};
  std::vector<std::string> sticky = wanted;
  sticky.emplace_back("material.soil.cohesion=100"); // 8 N, five times the weight of a grain
  const auto dry = simulated(randomBed(wanted)), moist = simulated(randomBed(sticky));
  EXPECT_NEAR(structure(*moist).porosity, 0.38, 0.012);
  // Cohesive grains pack slightly more densely afterwards; cohesion during the fall requires a third of this friction.
  EXPECT_NEAR(moist->settled().friction / dry->settled().friction, 1, 0.3);
  EXPECT_NEAR(moist->ground().grains->model().law.pull(0.0125), 2 * base::kPi * 100 * 0.0125, 1e-9) << "and stick then";
  // With cohesion during the fall the bed would be far looser.
  const auto fallen = simulated(randomBed({"material.soil.cohesion=100", "terrain.settle_kinetic_energy=1e-2"}));
  EXPECT_GT(structure(*fallen).porosity, 0.42);
}

TEST(BedPreparation, PorosityOutOfReachIsRefusedWithWhatCanBeReached) {
  try {
    simulated(randomBed({"terrain.porosity=0.25"}));
    FAIL() << "spheres of these radii cannot pack so densely";
  } catch (const base::InputError& error) {
    for (const char* part : {"terrain.porosity = 0.25", "cannot be reached", "choose a porosity between"})
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
  }
  EXPECT_THROW(setup::simulationSetup(randomBed({"terrain.porosity=0.4", "material.soil.friction=0"})),
               base::InputError);
}

TEST(RandomBeds, AreTheSameOnAllThreadsWithAllSkinsAndResumed) {
  const scene::Scene scene = randomBed();
  const auto straight = simulated(scene), parallel = simulated(scene, 2), wide = simulated(randomBed({"run.skin=0.5"}));
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
  const auto s = simulated(randomBed());
  EXPECT_NEAR(structure(*s).settledHeight, 0, 0.025);
}

TEST(RandomBeds, FixedGrainsHoldTheFloor) {
  const auto rough = simulated(randomBed()), smooth = simulated(randomBed({"terrain.floor_grains=false"}));
  const terrain::GrainSnapshot grains = rough->ground().grains->snapshot();
  ASSERT_EQ(grains.fixed.size(), grains.position.size());
  const auto fixed = std::count_if(grains.fixed.begin(), grains.fixed.end(), [](auto f) { return f != 0; });
  EXPECT_EQ(fixed, 12 * 12);
  EXPECT_TRUE(smooth->ground().grains->snapshot().fixed.empty());
  // On a slope of 0.35 one bed comes to rest; the other rolls on its lowest grains without end.
  const std::string slope = "run.gravity=[3.43, 0, -9.81]";
  EXPECT_NO_THROW(simulated(randomBed({slope})));
  EXPECT_THROW(simulated(randomBed({slope, "terrain.floor_grains=false"})), base::SimulationError);
}

/// With the friction of the porosity search beds would flow down this slope without end.
void expectPreparedLevel(const std::vector<std::string>& more) {
  constexpr double kSlope = 0.35;
  std::vector<std::string> all = {"terrain.porosity=0.39", "run.gravity=[3.43, 0, -9.8]"};
  all.insert(all.end(), more.begin(), more.end());
  const auto leaning = simulated(randomBed(all));
  EXPECT_LT(leaning->settled().friction, kSlope);
  EXPECT_NEAR(structure(*leaning).porosity, 0.39, 0.012);
}

TEST(RandomBeds, ArePreparedLevelAndLeanWithTheFrictionOfTheirGrains) { expectPreparedLevel({}); }

TEST(RandomBeds, OfTilesArePreparedLevelToo) { expectPreparedLevel({"terrain.tile=[0.6, 0.6]"}); }

TEST(RandomBeds, GradedBedKeepsItsFineGrainsAbove) {
  const auto s =
      simulated(randomBed({"terrain.grain_radius=0.015", "terrain.fine_depth=0.08", "terrain.coarsening=0.15",
                           "terrain.coarsest_radius=0.03", "material.soil.stiffness=2e4"}));
  const terrain::GrainSnapshot grains = s->ground().grains->snapshot();
  double above = 0, below = 0;
  int na = 0, nb = 0, fineBelow = 0;
  for (std::size_t g = 0; g < grains.position.size(); ++g) {
    if (grains.fixed[g]) continue;
    const double z = grains.position[g].z, r = static_cast<double>(grains.radius[g]);
    if (z > -0.07) above += r, ++na;
    if (z < -0.2) below += r, ++nb, fineBelow += r < 0.016;
  }
  ASSERT_TRUE(na > 500 && nb > 50);
  EXPECT_NEAR(above / na, 0.015, 0.001);
  EXPECT_GT(below / nb, 0.026);
  EXPECT_LT(fineBelow, 0.03 * nb) << "hardly any fine grain has moved down";
}

TEST(RandomBeds, TilesKeepTheirPorosity) {
  const std::vector<std::string> wide = {"terrain.size=[1.2, 1.2]", "terrain.porosity=0.4"};
  auto tiled = wide;
  tiled.emplace_back("terrain.tile=[0.6, 0.6]");
  const auto s = simulated(randomBed(tiled));
  EXPECT_NEAR(structure(*s).porosity, 0.4, 0.012);
  EXPECT_EQ(s->ground().grains->count() % 4, 0u);
}

TEST(RandomBeds, CrystalsAreRefused) {
  const SimulationSetup setup = setup::simulationSetup(randomBed({"terrain.radius_distribution=single"}));
  terrain::BedStructure crystal;
  crystal.grains = 1000, crystal.order = 0.8, crystal.porosity = 1 - 0.645;
  EXPECT_THROW(checkStructure(*setup.ground.grains->bed, crystal), base::SimulationError);
  crystal.porosity = 1 - 0.639;
  EXPECT_NO_THROW(checkStructure(*setup.ground.grains->bed, crystal));
  // Unequal radii pack more densely without order.
  crystal.porosity = 1 - 0.645;
  EXPECT_NO_THROW(checkStructure(*setup::simulationSetup(randomBed()).ground.grains->bed, crystal));
}

} // namespace
} // namespace grouser::coupling
