// SPDX-License-Identifier: BSD-3-Clause
// Scenes with periodic boundaries, and beds made of copies of a settled tile.
#include "base/error.hpp"
#include "coupling/settled_ground.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/grain_kinds.hpp"
#include "runs/setup/ground_setup.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/setup/periodic_boundaries.hpp"
#include "runs/setup/sources.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace grouser::coupling {
namespace {

constexpr double kStep = 1e-4, kRadius = 0.03;

scene::Scene bed(const std::vector<std::string>& overrides = {}) {
  return setup::parseScene("version = 1\n[run]\nduration = 0.1\ntime_step = 1e-4\n[material.soil]\nstiffness = 1e5\n"
                           "restitution = 0.2\n[terrain]\nheightmap = \"heightmaps/flat.png\"\nsize = [1.0, 0.8]\n"
                           "height_range = [0.1, 0.1]\nmaterial = \"soil\"\ngrain_radius = 0.03\nlayers = "
                           "3\narrangement = \"lattice\"\nfloor_grains = false\nwall_friction = 0.5\n"
                           "settle_kinetic_energy = 1e-4\ncache = false\n",
                           "bed.toml", overrides);
}

const std::vector<std::string> kJoined = {"run.periodic=[true, true]"};
std::vector<std::string> with(std::vector<std::string> list, const std::vector<std::string>& more) {
  list.insert(list.end(), more.begin(), more.end());
  return list;
}

SettleReport settled(const scene::Scene& scene, LaidGround& ground) {
  const GroundSetup setup = setup::groundSetup(scene, kStep);
  ground = buildGround(setup, base::cpuExec(1));
  return settle(*setup.grains->bed, ground, [](double, double) {});
}

TEST(JoinedBed, IsAsDenseAtItsSidesAsInside) {
  // Averaged over the axis, a walled bed is less dense near its walls: no centre is closer to them than a radius.
  const auto share = [](const std::vector<std::string>& overrides) {
    LaidGround ground;
    settled(bed(overrides), ground);
    const auto snapshot = ground.grains->snapshot();
    int near = 0;
    for (const base::Vec3d& x : snapshot.position) near += x.x < 0.1 || x.x >= 0.9;
    return static_cast<double>(near) / static_cast<double>(snapshot.position.size());
  };
  EXPECT_NEAR(share(kJoined), 0.2, 0.03); // a fifth of the length; rows of grains are 0.06 m apart
  EXPECT_LT(share({}), 0.16);
}

TEST(JoinedBed, HeightMapMustBeLevelAcrossTheSides) {
  EXPECT_THROW(buildGround(setup::groundSetup(bed({"terrain.heightmap=heightmaps/hills.png",
                                                   "terrain.height_range=[0, 0.05]", "run.periodic=[true, false]"}),
                                              kStep),
                           base::cpuExec(1)),
               base::InputError);
  const auto slope = terrain::HeightField::plane({0, 1, -0.4, 0.4}, 0.1, 0, 0.2);
  EXPECT_NO_THROW(setup::checkLevelAcross(bed({"run.periodic=[true, false]"}), slope));
  EXPECT_THROW(setup::checkLevelAcross(bed({"run.periodic=[false, true]"}), slope), base::InputError);
}

TEST(TiledBed, OfJoinedTilesIsInBalanceAtOnce) {
  const std::vector<std::string> level = with(kJoined, {"terrain.height_range=[0, 0]"}),
                                 tiles = with(level, {"terrain.tile=[0.5, 0.4]"});
  LaidGround tile, whole = buildGround(setup::groundSetup(bed(tiles), kStep), base::cpuExec(1));
  settled(bed(with(level, {"terrain.size=[0.5, 0.4]"})), tile);
  EXPECT_EQ(whole.grains->count(), 4 * tile.grains->count());
  const terrain::GrainLedger one = tile.grains->ledger(), four = whole.grains->ledger();
  EXPECT_EQ(four.contacts, 4 * one.contacts);
  EXPECT_NEAR(four.elastic, 4 * one.elastic, 1e-5 * four.elastic); // quanta of each grain
  EXPECT_NEAR(four.kinetic, 4 * one.kinetic, 1e-9 * four.kinetic);
  // A bed that settled in a periodic ring stays at rest: all springs exist, across the seams too.
  const auto before = whole.grains->snapshot().position;
  for (int k = 0; k < 500; ++k) whole.grains->refreshNeighbours(), whole.grains->step();
  const auto after = whole.grains->snapshot().position;
  double mean = 0;
  for (std::size_t i = 0; i < before.size(); ++i)
    mean += norm(after[i] - before[i]) / static_cast<double>(before.size());
  EXPECT_LT(mean, 3e-3 * kRadius);
}

TEST(TiledBed, BetweenWallsIsABedLikeOneThatFell) {
  LaidGround tiled, fallen;
  settled(bed({"terrain.tile=[0.5, 0.4]", "terrain.settle_kinetic_energy=1e-2"}), tiled);
  settled(bed({"terrain.settle_kinetic_energy=1e-2"}), fallen);
  const auto n = static_cast<double>(fallen.grains->count());
  EXPECT_NEAR(static_cast<double>(tiled.grains->count()), n, 0.1 * n);
  const terrain::GrainLedger a = tiled.grains->ledger(), b = fallen.grains->ledger();
  EXPECT_NEAR(static_cast<double>(a.contacts), static_cast<double>(b.contacts), 0.15 * static_cast<double>(b.contacts));
  EXPECT_LT(a.deepestOverlap, 0.05 * kRadius);
}

TEST(TiledBed, FillsHillsOnALevelFloorUpToTheHeightMap) {
  const scene::Scene scene = bed({"terrain.heightmap=heightmaps/hills.png", "terrain.height_range=[0, 0.3]",
                                  "terrain.floor=flat", "terrain.tile=[0.5, 0.4]"});
  LaidGround ground = buildGround(setup::groundSetup(scene, kStep), base::cpuExec(1));
  for (const base::Vec3d& x : ground.grains->snapshot().position)
    ASSERT_LE(x.z, ground.surface->height(x.x, x.y) + 1e-6);
  EXPECT_THROW(buildGround(setup::groundSetup(bed({"terrain.heightmap=heightmaps/hills.png",
                                                   "terrain.height_range=[0, 0.3]", "terrain.tile=[0.5, 0.4]"}),
                                              kStep),
                           base::cpuExec(1)),
               base::InputError);
}

TEST(TiledBed, SurfacesElsewhereDoNotTouchTheTile) {
  // Works in periodic tiles as without the surface; a surface inside the bed is an error.
  const auto ledgerWith = [](const std::string& box) {
    const std::string text =
        "version = 1\n[run]\nduration = 0.1\ntime_step = 1e-4\nperiodic = [true, true]\n[material.soil]\nstiffness = "
        "1e5\n"
        "restitution = 0.2\n[terrain]\nheightmap = \"heightmaps/flat.png\"\nsize = [1.0, 0.8]\nheight_range = [0, 0]\n"
        "material = \"soil\"\ngrain_radius = 0.03\nlayers = 3\narrangement = \"lattice\"\nfloor_grains = "
        "false\nwall_friction = 0.5\ntile = [0.5, 0.4]\ncache = false\n" +
        box;
    LaidGround ground = buildGround(setup::groundSetup(setup::parseScene(text, "bed.toml"), kStep), base::cpuExec(1));
    for (int k = 0; k < 20; ++k) ground.grains->refreshNeighbours(), ground.grains->step();
    return ground.grains->ledger();
  };
  const std::string at = "[[box]]\nmaterial = \"soil\"\nsize = [0.3, 0.2, 0.04]\nposition = [0.25, 0, ";
  const terrain::GrainLedger without = ledgerWith(""), far = ledgerWith(at + "5]\n");
  EXPECT_GT(without.boundaryContacts, 50);
  EXPECT_EQ(far.boundaryContacts, without.boundaryContacts);
  EXPECT_EQ(far.elastic, without.elastic) << "springs on the floor";
  EXPECT_EQ(far.kinetic, without.kinetic);
  EXPECT_THROW(ledgerWith(at + "-0.05]\n"), base::InputError);
}

TEST(PeriodicBoundaries, GrainsOfASourceDoNotEnterInEachOthersImages) {
  for (int seed = 1; seed <= 20; ++seed) {
    const scene::Scene scene = setup::parseScene(
        "version = 1\n[run]\nduration = 0.1\nperiodic = [true, true]\ndomain_x = [0, 0.2]\ndomain_y = "
        "[-0.1, 0.1]\nseed = " +
            std::to_string(seed) +
            "\n[material.soil]\n[[source]]\nlow = [0, -0.1, 0]\nhigh = [0.2, 0.1, 0.01]\nradius = 0.01\n"
            "material = \"soil\"\nnumber = 25\ntotal = 25\nevery = 1\n",
        "rain.toml");
    const std::vector<terrain::GrainSpec> grains =
        setup::sourcesOf(scene, setup::grainKinds(scene), kStep).enteringAt(0);
    ASSERT_EQ(grains.size(), 25u);
    for (std::size_t i = 0; i < grains.size(); ++i)
      for (std::size_t j = 0; j < i; ++j)
        EXPECT_GT(
            norm(terrain::toNearestImage(setup::periodicBoundaries(scene), grains[i].position - grains[j].position)),
            0.02);
  }
}

TEST(PeriodicBoundaries, GrainsOfASceneTouchAcrossThem) {
  const auto scene = [](const std::string& x) {
    return setup::parseScene("version = 1\n[run]\nduration = 0.1\nperiodic = [true, false]\ndomain_x = [-0.5, 0.5]\n"
                             "[material.soil]\nstiffness = 1e5\n[[grain]]\nposition = [0.48, 0, 0]\nradius = 0.03\n"
                             "material = \"soil\"\n[[grain]]\nposition = [" +
                                 x + ", 0, 0]\nradius = 0.03\nmaterial = \"soil\"\n",
                             "two.toml");
  };
  EXPECT_EQ(buildGround(setup::groundSetup(scene("-0.461"), kStep), base::cpuExec(1)).grains->ledger().contacts, 1);
  EXPECT_EQ(buildGround(setup::groundSetup(scene("-0.459"), kStep), base::cpuExec(1)).grains->ledger().contacts, 0);
  EXPECT_THROW(buildGround(setup::groundSetup(scene("-0.49"), kStep), base::cpuExec(1)), base::InputError)
      << "overlap at the start is too deep";
  EXPECT_THROW(buildGround(setup::groundSetup(scene("-0.51"), kStep), base::cpuExec(1)), base::InputError) << "outside";
}

} // namespace
} // namespace grouser::coupling
