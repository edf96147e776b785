// SPDX-License-Identifier: BSD-3-Clause
// Objects placed on a settled bed: the bed settles without them, positions are correct, and results are identical.
#include "coupling/placed_on_bed.hpp"

#include "base/error.hpp"
#include "coupling/simulation.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/bed_alone.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/setup/provenance.hpp"
#include "runs/setup/simulation_setup.hpp"
#include "runs/setup/step_limit.hpp"
#include "runs/storage/bed_cache.hpp"
#include "tests/runs/folder_fixture.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

namespace grouser::coupling {

using namespace test; // fixtures

namespace {

using base::Vec3d;

/// Some 200 grains of mixed radii on a floor of fixed grains.
std::string bedScene(const std::string& more) {
  return "version = 1\n[run]\nduration = 0.5\n[material.soil]\nstiffness = 1e5\nrestitution = 0.2\n[material.steel]\n"
         "stiffness = 2e5\n[terrain]\nheightmap = \"heightmaps/hills.png\"\nsize = [0.6, 0.6]\nheight_range = [0, "
         "0.03]\nmaterial = \"soil\"\ngrain_radius = 0.03\ndepth = 0.1\nsettle_kinetic_energy = 1e-2\n" +
         more;
}

std::string plate(const std::string& keys) {
  return "[[box]]\nname = \"plate\"\nmaterial = \"steel\"\nposition = [0.3, 0, 5]\nsize = [0.2, 0.2, 0.04]\n" + keys;
}
const std::string kFree = "free = \"z\"\nmass = 4\nload = -30\nload_ramp = 0.02\n";

scene::Scene sceneWithBed(const std::string& more, const std::vector<std::string>& overrides = {}) {
  return setup::parseScene(bedScene(more), "placed.toml", overrides);
}
std::unique_ptr<Simulation> made(const scene::Scene& scene, int threads = 1, storage::BedCache* beds = nullptr,
                                 bool* settles = nullptr) {
  return std::make_unique<Simulation>(
      setup::simulationSetup(scene), base::cpuExec(threads),
      [settles](double, double) {
        if (settles) *settles = true;
      },
      base::Comm{}, beds);
}
std::string refusal(const scene::Scene& scene) {
  try {
    made(scene);
  } catch (const base::InputError& error) {
    return error.what();
  }
  return "";
}

/// The highest top of the first `count` grains over a rectangle.
double highestUnder(const terrain::GrainSnapshot& all, std::size_t count, double x0, double x1, double y0, double y1) {
  double top = -1e300;
  for (std::size_t k = 0; k < count; ++k) {
    const Vec3d& p = all.position[k];
    const double r = static_cast<double>(all.radius[k]);
    if (p.x + r > x0 && p.x - r < x1 && p.y + r > y0 && p.y - r < y1) top = std::max(top, p.z + r);
  }
  return top;
}

TEST(PutOnBed, BedHasTheBitsOfOneAloneWhateverIsPutOnIt) {
  const terrain::GrainState alone = made(sceneWithBed(""))->ground().grains->state();
  const std::string rigs =
      plate(kFree + "above_bed = 0.01\n") +
      "[[grain]]\nposition = [0.1, 0.2, 0]\nabove_bed = 0.005\nradius = 0.02\nmaterial = \"steel\"\n";
  const auto with = made(sceneWithBed(rigs));
  const terrain::GrainState rig = with->ground().grains->state();
  const std::size_t n = alone.rows();
  ASSERT_EQ(rig.rows(), n + 1);
  for (std::size_t k = 0; k < n; ++k) {
    EXPECT_EQ(base::toUnits(rig.position[k]), base::toUnits(alone.position[k]));
    EXPECT_EQ(rig.velocity[k], alone.velocity[k]);
    EXPECT_EQ(rig.spin[k], alone.spin[k]);
    EXPECT_EQ(rig.remainders[k].position, alone.remainders[k].position);
    EXPECT_EQ(rig.contacts[k], alone.contacts[k]);
    EXPECT_EQ(rig.wallBits[k], alone.wallBits[k]);
  }
  EXPECT_TRUE(std::equal(alone.contactShear.begin(), alone.contactShear.end(), rig.contactShear.begin()));
  EXPECT_GT(alone.contactShear.size(), 200u);
  EXPECT_TRUE(std::equal(alone.radius.begin(), alone.radius.end(), rig.radius.begin()));
  EXPECT_TRUE(std::equal(alone.fixed.begin(), alone.fixed.end(), rig.fixed.begin()));
  EXPECT_GT(std::count(alone.fixed.begin(), alone.fixed.end(), 1u), 10);
  // Tops are computed in single precision, relative to 0.1 m.
  EXPECT_NEAR(with->settled().highest, highestUnder(with->ground().grains->snapshot(), n, -9, 9, -9, 9), 1e-7);
}

TEST(PutOnBed, SpringsOnWhatStoodInTheBedStayItsOwn) {
  // Four walls, the floor (in one or several places), then surfaces: the sill is the last.
  const std::string sill = "[[box]]\nname = \"sill\"\nposition = [0.2, 0, -0.05]\nsize = [0.04, 0.4, 0.08]\n"
                           "material = \"steel\"\n";
  for (const char* interpolation : {"smooth", "monotone"}) {
    const std::vector<std::string> ground{std::string("terrain.interpolation=") + interpolation};
    const terrain::GrainState
        alone = made(sceneWithBed(sill, ground))->ground().grains->state(),
        rig = made(sceneWithBed(plate(kFree + "above_bed = 0.01\n") + sill, ground))->ground().grains->state();
    const auto before = static_cast<std::size_t>(alone.layout.boundaries), after = before + 1;
    ASSERT_EQ(static_cast<std::size_t>(rig.layout.boundaries), after);
    EXPECT_EQ(rig.floorNormal, alone.floorNormal);
    int touching = 0;
    for (std::size_t k = 0; k < alone.rows(); ++k) {
      EXPECT_EQ(rig.wallBits[k] >> before & 1u, alone.wallBits[k] >> (before - 1) & 1u);
      EXPECT_EQ(rig.wallBits[k] >> (before - 1) & 1u, 0u) << "the plate is above the bed";
      EXPECT_EQ(rig.wallShear[after * k + before], alone.wallShear[before * k + before - 1]);
      for (std::size_t b = 0; b + 1 < before; ++b)
        EXPECT_EQ(rig.wallShear[after * k + b], alone.wallShear[before * k + b]);
      touching += norm(alone.wallShear[before * k + before - 1]) > 0 ? 1 : 0;
    }
    EXPECT_GT(touching, 2);
  }
}

TEST(PutOnBed, StandsAboveTheHighestGrainUnderIt) {
  const auto bed = made(sceneWithBed(""))->ground().grains->snapshot();
  const auto s =
      made(sceneWithBed(plate("velocity = [0, 0, -0.1]\nabove_bed = 0.002\nspin = [0, 0, 1]\npivot = [0, 0, 4]\n") +
                        "[[grains]]\nlow = [0.0, -0.3, 1]\nhigh = [0.1, -0.2, 1.1]\nradius = 0.01\n"
                        "material = \"soil\"\nabove_bed = 0.001\n"));
  EXPECT_NEAR(s->surfaces()->pose(0, 0).position.z - 0.02,
              highestUnder(bed, bed.position.size(), 0.2, 0.4, -0.1, 0.1) + 0.002, 1e-12);
  const SurfaceMotion& motion = s->surfaces()->surface(0).motion;
  EXPECT_NEAR(motion.at(0).centre.z - motion.at(0).pivot.z, 1, 1e-12) << "the pivot moves with it";
  const terrain::GrainSnapshot now = s->ground().grains->snapshot();
  Vec3d low{1e300, 1e300, 1e300}, high{-1e300, -1e300, -1e300};
  for (std::size_t k = bed.position.size(); k < now.position.size(); ++k) {
    low = base::min(low, now.position[k] - Vec3d{0.01, 0.01, 0.01});
    high = base::max(high, now.position[k] + Vec3d{0.01, 0.01, 0.01});
  }
  const double lowest = low.z, top = highestUnder(bed, bed.position.size(), low.x, high.x, low.y, high.y);
  EXPECT_NEAR(lowest, top + 0.001, 1e-8) << "the lattice's lowest layer stands on the box's floor";
}

TEST(PutOnBed, OverlapIsRefusedWithNumbersAndRemedy) {
  const std::string deep = refusal(sceneWithBed(plate("velocity = [0, 0, -0.1]\n"), {"box.plate.position.2=0.0"}));
  for (const char* part : {"placed.toml:", "plate would penetrate", "m into grain", "above_bed", "placed = \"before\""})
    EXPECT_NE(deep.find(part), std::string::npos) << part << "\n" << deep;
  const std::string grain =
      refusal(sceneWithBed("[[grain]]\nposition = [0.3, 0, 0]\nradius = 0.05\nmaterial = \"steel\"\n"));
  for (const char* part : {"placed.toml:", "m into grain", "above_bed"})
    EXPECT_NE(grain.find(part), std::string::npos) << part << "\n" << grain;
  EXPECT_NE(refusal(sceneWithBed(plate(kFree + "above_bed = 0.01\n"), {"box.plate.position.0=7"}))
                .find("no grain of the bed"),
            std::string::npos);
  EXPECT_THROW(sceneWithBed(plate("above_bed = 0.1\nplaced = \"before\"\n")), base::InputError);
  EXPECT_THROW(sceneWithBed("[[plane]]\nmaterial = \"steel\"\nabove_bed = 0.1\n"), base::InputError)
      << "no lowest point";
  // Two grains at one position, which no bed can separate.
  const std::string stone =
      "[[grain]]\nposition = [0.3, 0, 0]\nradius = 0.02\nmaterial = \"steel\"\nabove_bed = 0.01\n";
  EXPECT_NE(refusal(sceneWithBed(stone + stone)).find("m into grain"), std::string::npos);
}

TEST(PutOnBed, WhatRestsStandsInTheBedAndWhatMovesComesLater) {
  const auto count = [](const std::string& keys) {
    return made(sceneWithBed(plate(keys), {"box.plate.position.2=0.0"}))->ground().grains->count();
  };
  const std::size_t all = made(sceneWithBed(""))->ground().grains->count();
  EXPECT_LT(count(""), all) << "grains surround it";
  EXPECT_EQ(count("velocity = [0, 0, 0.1]\nplaced = \"before\"\n"), count(""));
  EXPECT_FALSE(setup::isPutOnBed(sceneWithBed(plate(""))));
  EXPECT_TRUE(setup::isPutOnBed(sceneWithBed(plate("velocity = [0, 0, 0.1]\n"))));
  EXPECT_TRUE(setup::isPutOnBed(sceneWithBed(plate("placed = \"after_settling\"\n"))));
  EXPECT_FALSE(setup::isPutOnBed(sceneWithBed(plate("velocity = [0, 0, 0.1]\n"), {"terrain.settle_time_limit=0"})));
}

std::string manyRigs() {
  return plate(kFree + "above_bed = 0.002\nvelocity = [0.1, 0, 0]\n") +
         "[[mesh]]\nfile = \"meshes/road_wheel.obj\"\nscale = 0.2\nposition = [0.3, 0.22, 0]\nmaterial = \"steel\"\n"
         "above_bed = 0.001\nfree = \"z\"\nmass = 2\nspin = [0, 3, 0]\n"
         "[[grain]]\nposition = [0.15, -0.2, 0]\nradius = 0.04\nmaterial = \"steel\"\nabove_bed = 0.001\n"
         "[[source]]\nlow = [0.5, -0.2, 0.4]\nhigh = [0.5, 0, 0.4]\nradius = 0.03\nmaterial = \"soil\"\ntotal = 1\n"
         "every = 1\nstart = 0.02\n";
}

/// tests/scenes/rigs.toml; one_answer_scenes_test.cpp has its hash for threads, lists and a stop.
TEST(PutOnBed, ResumedAtItsStartAlsoHasTheBitsOfAStraightRun) {
  const scene::Scene scene = sceneWithBed(manyRigs());
  const auto straight = made(scene);
  Simulation second(setup::simulationSetup(scene), base::cpuExec(1), straight->save());
  EXPECT_EQ(second.stateHash(), straight->stateHash());
  for (int n = 0; n < 1200; ++n) straight->step(), second.step();
  EXPECT_EQ(second.stateHash(), straight->stateHash());
  EXPECT_NE(straight->surfaces()->observe(0, 1200).force.z, 0) << "the plate has touched the bed";
  EXPECT_NE(straight->surfaces()->observe(1, 1200).force.z, 0) << "so has the wheel";
}

TEST(PutOnBed, LargerStonesLeaveTheBedToItself) {
  // A stone of three radii coarsens the position units by two bits: springs and overlaps are kept, and the residual
  // motion of the bed continues as before, until rounding of 1e-9 m and damping by each contact's own mass differ.
  const std::vector<std::string> steps{"run.time_step=1e-4"};
  const auto alone = made(sceneWithBed("", steps)),
             s = made(sceneWithBed("[[grain]]\nposition = [0.3, 0, 0]\nradius = 0.09\nmaterial = \"steel\"\n"
                                   "above_bed = 0.05\n",
                                   steps));
  EXPECT_NE(s->ground().grains->scale().unit, alone->ground().grains->scale().unit);
  const double from = s->ground().grains->snapshot().position.back().z;
  while (s->steps() < 300) s->step(), alone->step();
  const auto with = s->ground().grains->snapshot().position, without = alone->ground().grains->snapshot().position;
  ASSERT_EQ(with.size(), without.size() + 1);
  for (std::size_t k = 0; k < without.size(); ++k) EXPECT_LT(norm(with[k] - without[k]), 1e-6) << "of 2 mm of way";
  EXPECT_NEAR(from - with.back().z, 0.5 * 9.81 * 0.03 * (0.03 + 1e-4), 1e-7) << "symplectic Euler";
}

class KeptForRigs : public FolderTest {};

TEST_F(KeptForRigs, OneBedServesAllRigs) {
  storage::BedCache beds(folder_);
  bool settles = false;
  made(sceneWithBed(""), 1, &beds, &settles);
  EXPECT_TRUE(settles);
  const SettleReport kept = [&] {
    const scene::Scene bed = sceneWithBed("");
    return beds.find(setup::bedOrigin(bed, setup::chooseTimeStep(bed))).value();
  }();
  EXPECT_GT(kept.highest, kept.meanHeight);
  for (const std::string& rigs :
       {plate(kFree + "above_bed = 0.1\n"), plate("velocity = [0, 0, -0.01]\n"), manyRigs()}) {
    settles = false;
    const auto s = made(sceneWithBed(rigs), 1, &beds, &settles);
    EXPECT_FALSE(settles);
    EXPECT_EQ(s->settled().highest, kept.highest);
  }
}

} // namespace
} // namespace grouser::coupling
