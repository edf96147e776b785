// SPDX-License-Identifier: BSD-3-Clause
// A vehicle placed on a bed with stones above its smooth surface touches none of them.
#include "coupling/grains_under_shoes.hpp"
#include "coupling/simulation.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/setup/simulation_setup.hpp"
#include "tests/runs/shared_cache.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

namespace grouser::coupling {
namespace {

/// A random bed of 1,600 grains, not settled: stones are at their initial positions.
std::unique_ptr<Simulation> onStones(int seed, const std::vector<std::string>& more = {}) {
  std::vector<std::string> overrides = more;
  overrides.push_back("run.seed=" + std::to_string(seed));
  const scene::Scene scene =
      setup::parseScene("version = 1\n[run]\nduration = 0.01\ntime_step = 1e-4\n[material.soil]\nstiffness = 1e6\n"
                        "[terrain]\nheightmap = \"heightmaps/flat.png\"\nsize = [4.9, 2.5]\nheight_range = [0, 0]\n"
                        "material = \"soil\"\ngrain_radius = 0.05\ndepth = 0.12\nsettle_time_limit = 3\n"
                        "settle_kinetic_energy = 0.05\ncache = false\n"
                        "[vehicle]\nspec = \"vehicles/light_tracked.toml\"\nsphere_radius = 0.03\n",
                        "stones.toml", overrides);
  return std::make_unique<Simulation>(
      setup::simulationSetup(scene), base::cpuExec(1), [](double, double) {}, base::Comm{}, nullptr, sharedSpheres());
}

/// Deepest overlap of a grain with the box about pad and grousers of a downward shoe [m]; negative: distance of
/// the nearest grain below the shoe.
double deepest(const Simulation& s) {
  const vehicle::Assembly& assembly = s.vehicle()->assembly();
  const vehicle::ShoeSpec& shoe = assembly.spec.shoe;
  const terrain::GrainSnapshot grains = s.ground().grains->snapshot();
  double most = -1e300;
  for (const int index : assembly.groundParts) {
    const base::Pose pose =
        vehicle::partPose(s.vehicle()->assembly().parts[static_cast<std::size_t>(index)], s.vehicle()->state());
    if (rotate(pose.orientation, base::Vec3d{0, 0, 1}).z < 0.5) continue;
    for (std::size_t g = 0; g < grains.position.size(); ++g) {
      const base::Vec3d local = pose.toBody(grains.position[g]);
      const double r = std::fabs(static_cast<double>(grains.radius[g]));
      const double beside = std::hypot(std::max(0.0, std::fabs(local.x) - shoe.halfLength),
                                       std::max(0.0, std::fabs(local.y) - shoe.padHalfWidth));
      if (beside >= r) continue;
      most = std::max(most, local.z + std::sqrt(r * r - beside * beside) - (shoe.padBottom - shoe.grouserHeight));
    }
  }
  return most;
}

TEST(SetOnStones, NoShoeStandsInAGrain) {
  int lifted = 0;
  for (int seed = 1; seed <= 3; ++seed) {
    const std::unique_ptr<Simulation> s = onStones(seed);
    const double lift = s->save().vehicle->lift, into = deepest(*s);
    EXPECT_LE(into, 0) << "seed " << seed;
    if (lift > 0) {
      ++lifted;
      // At half a radius beside a pad a sphere is lower by 0.58 of the distance: 5 mm over the distance of a node.
      EXPECT_GT(into, -0.006) << "seed " << seed;
    }
    s->step();
    EXPECT_EQ(norm(s->vehicle()->meanGroundForce()), 0) << "seed " << seed;
  }
  EXPECT_GT(lifted, 0) << "none of these beds has a protruding stone";
}

TEST(SetOnStones, AResumedVehicleStoodWhereItWasSetDown) {
  for (int seed = 1; seed <= 4; ++seed) {
    const std::unique_ptr<Simulation> straight = onStones(seed, {"vehicle.chassis=\"fixed\""});
    if (straight->save().vehicle->lift == 0) continue;
    for (int i = 0; i < 20; ++i) straight->step();
    Simulation resumed(straight->setup(), base::cpuExec(1), straight->save(), {}, sharedSpheres());
    EXPECT_EQ(resumed.save().vehicle->lift, straight->save().vehicle->lift);
    for (int i = 0; i < 20; ++i) straight->step(), resumed.step();
    EXPECT_EQ(resumed.stateHash(), straight->stateHash());
    return;
  }
  FAIL() << "none of these beds has a protruding stone";
}

} // namespace
} // namespace grouser::coupling
