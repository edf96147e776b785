// SPDX-License-Identifier: BSD-3-Clause
// Scenes with a fluid: floating bodies against closed forms, energies, resumed runs, and identical results.
#include "base/error.hpp"
#include "coupling/fluid_domain.hpp"
#include "coupling/simulation.hpp"
#include "coupling/vehicle_rig.hpp"
#include "runs/setup/fluid_bodies.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/setup/simulation_setup.hpp"
#include "tests/device_under_test.hpp"
#include "tests/runs/shared_cache.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace grouser::coupling {
namespace {

constexpr double kWaterGravity = 9.81; // [m/s2]

std::string waterTank(const std::string& more) {
  return "version = 1\n[run]\nduration = 3.0\n[material.wood]\ndensity = 500\nfoundation_modulus = 1e7\nrestitution = "
         "0.3\nfriction = 0.3\n[fluid]\ndimensions = 2\nspacing = 0.025\ntank_low = [-0.5, 0, 0]\ntank_high = [0.5, 0, "
         "0.6]\nlevel = 0.4\nsmoothing = 1.5\n" +
         more;
}

/// A square of 0.2 m, eight spacings, one metre thick.
std::string floatingBox(double mass, double z, const std::string& more = {}) {
  return fmt::format("[[body]]\nname = \"box\"\nmaterial = \"wood\"\nmass = {}\nbox = [0.2, 1, 0.2]\nposition = [0, 0, "
                     "{}]\n{}\n[[body.shape]]\nkind = \"box\"\nsize = [0.2, 1, 0.2]\n",
                     mass, z, more);
}

Simulation madeFluid(const std::string& text, int threads = 1) {
  return Simulation(
      setup::simulationSetup(setup::parseScene(text, "fluid.toml")), testExec(threads), [](double, double) {}, {},
      nullptr, sharedSpheres());
}

std::vector<fluid::BodyLoad> columnLoads(const Simulation& s) { return fluidOf(s)->columnLoads(&s.vehicle()->state()); }

double heightOf(const Simulation& s) { return s.mechanism()->state().pose[0].position.z; }

/// A box of half the density of water settles half under water, within 0.15 spacings; its mean load is its
/// weight. The water keeps its volume within a hundredth.
TEST(FluidScene, ABoxFloatsAtItsDraught) {
  std::string probes;
  for (const char* x : {"-0.35", "-0.25", "0.25", "0.35"})
    probes +=
        fmt::format("[[fluid.probe]]\nname = \"at{}\"\nkind = \"level\"\nposition = [{}, 0, 0]\n", probes.size(), x);
  Simulation s = madeFluid(waterTank(probes + floatingBox(20, 0.405)));
  double height = 0, lift = 0, level = 0;
  int samples = 0, looks = 0;
  while (s.time() < 2.5) {
    s.step();
    if (s.time() < 1) continue;
    height += heightOf(s), lift += fluidOf(s)->bodyLoads()[0].force.z, ++samples;
    if (s.steps() % 20 != 0) continue;
    for (const double z : fluidOf(s)->probe()) level += z / 4;
    ++looks;
  }
  height /= samples, lift /= samples, level /= looks;
  EXPECT_NEAR(height, level, 0.00375);
  EXPECT_NEAR(lift / (20 * kWaterGravity), 1, 0.02);
  const double water = static_cast<double>(fluidOf(s)->fluid().particles()) * 0.025 * 0.025;
  EXPECT_NEAR(level - 0.02, water, 0.01 * water);
}

/// A box of 2 % of the density of water, with a ghost inertia above its mass: it oscillates and is not ejected.
TEST(FluidScene, ALightBoxIsNotThrown) {
  Simulation s = madeFluid(waterTank(floatingBox(0.4, 0.49)));
  ASSERT_GT(s.setup().fluid->bodies[0].gain, 10);
  double highest = 0, fastest = 0;
  while (s.time() < 0.8) {
    s.step();
    highest = std::max(highest, heightOf(s)), fastest = std::max(fastest, norm(s.mechanism()->state().twist[0].v));
  }
  EXPECT_LT(highest, 0.53);
  EXPECT_LT(fastest, 0.5);
}

/// All energies except the step's error, which is small against the exchanged energy.
TEST(FluidScene, EnergiesClose) {
  Simulation s = madeFluid(waterTank(floatingBox(20, 0.45)));
  while (s.time() < 0.5) s.step();
  const Ledger l = s.ledger();
  EXPECT_GT(l.dissipated.fluid, 0);
  EXPECT_LT(std::fabs(l.integrationError), 0.01 * std::fabs(l.potential));
  EXPECT_LT(std::fabs(l.residual), 1e-9);
}

/// A driven body: the work of the drive increases the energy of the water.
TEST(FluidScene, WorkOfADriveGoesIntoTheWater) {
  Simulation s = madeFluid(waterTank(floatingBox(20, 0.2) +
                                     "[[joint]]\nname = \"rail\"\ntype = \"prismatic\"\nbodies = [\"world\", "
                                     "\"box\"]\npoint = [0, 0, 0.2]\naxis = [1, 0, 0]\n[[drive]]\nname = "
                                     "\"motor\"\njoint = \"rail\"\nimposes = \"position\"\ntime = [0, 1]\nvalues = "
                                     "[0, 0.2]\n"));
  while (s.time() < 0.6) s.step();
  const Ledger l = s.ledger();
  EXPECT_GT(l.driveWork, 1);
  EXPECT_LT(std::fabs(l.integrationError), 0.02 * l.driveWork);
}

TEST(FluidScene, HasOneAnswerOnAnyThreadsAndWhenResumed) {
  const std::string text = waterTank(floatingBox(15, 0.42));
  Simulation one = madeFluid(text, 1), two = madeFluid(text, 2);
  const int steps = 151;
  ASSERT_GT(one.setup().fluid->stepsPerStep, 1);
  ASSERT_NE(steps % one.setup().fluid->stepsPerStep, 0) << "must resume between two steps of the fluid";
  for (int k = 0; k < steps; ++k) one.step(), two.step();
  EXPECT_EQ(one.stateHash(), two.stateHash());
  Simulation resumed(setup::simulationSetup(setup::parseScene(text, "fluid.toml")), testExec(2), one.save());
  EXPECT_EQ(resumed.stateHash(), one.stateHash());
  for (int k = 0; k < 77; ++k) one.step(), resumed.step();
  EXPECT_EQ(resumed.stateHash(), one.stateHash());
  EXPECT_EQ(resumed.ledger().dissipated.fluid, one.ledger().dissipated.fluid);
}

/// One track and the hull above it, held over the ground, in a tank: water to 0.3 m above the lowest grousers, at
/// a spacing of 0.06 m, the thickness of the shoes.
const std::string kFord = fmt::format(
    "version = 1\n[run]\nduration = 3.0\n[vehicle]\nspec = \"{}/assets/vehicles/light_tracked.toml\"\nchassis = "
    "\"fixed\"\ntracks = \"single\"\n[driver]\nsprocket_speed = 2.0\ndrive_start = 10\n[fluid]\nspacing = "
    "0.06\ntank_low = [-0.6, -0.9, -0.18]\ntank_high = [3.3, 0.9, 0.9]\nlevel = 0.3\n",
    GROUSER_SOURCE_DIR);

/// The lift on a vehicle is the weight of the displaced water, within 30 % for shoes one spacing thick.
TEST(FluidScene, AVehicleIsLiftedByTheWaterItDisplaces) {
  Simulation s = madeFluid(kFord, 2);
  const setup::StartingBodies bodies(setup::parseScene(kFord, "ford.toml"));
  double lift = 0;
  int samples = 0;
  while (s.time() < 0.12) {
    s.step();
    if (s.time() < 0.06) continue;
    for (const fluid::BodyLoad& l : columnLoads(s)) lift += l.force.z;
    ++samples;
  }
  lift /= samples;
  const double volume = bodies.vehicleBelow(0.3);
  EXPECT_NEAR(lift / (1000 * kWaterGravity * volume), 1, 0.3);
  ASSERT_EQ(fluidOf(s)->columns(), (std::vector<std::string>{"vehicle/hull", "vehicle/left_track"}));
  // The torque of a track is about the hull's centre of mass.
  const std::vector<fluid::BodyLoad> each = fluidOf(s)->bodyLoads();
  base::Vec3d torque;
  for (std::size_t k = 1; k < each.size(); ++k) {
    const std::vector<base::Pose>& pose = s.vehicle()->state().pose;
    const base::Vec3d arm = pose[s.setup().fluid->bodies[k].body].position - pose[0].position;
    torque += each[k].torque + cross(arm, each[k].force);
  }
  EXPECT_LT(norm(columnLoads(s)[1].torque - torque), 1e-9 * norm(torque));
  // A run resumed between two steps of the fluid has the same rows.
  ASSERT_GT(s.setup().fluid->stepsPerStep, 1);
  if (s.steps() % s.setup().fluid->stepsPerStep == 0) s.step();
  const Simulation resumed(s.setup(), testExec(2), s.save(), {}, sharedSpheres());
  EXPECT_EQ(columnLoads(resumed)[1].torque, columnLoads(s)[1].torque);
  EXPECT_EQ(resumed.stateHash(), s.stateHash());
}

/// The vehicle on rigid ground in 0.5 m of water.
const std::string kRestingFord = fmt::format(
    "version = 1\n[run]\nduration = 6.0\n[material.ground]\nstiffness = 1e7\nrestitution = 0.3\nfriction = "
    "0.8\n[terrain]\nmaterial = \"ground\"\nheightmap = \"{0}/assets/heightmaps/flat.png\"\nsize = [5.0, "
    "3.0]\nheight_range = [-0.128, 0.127]\nkind = \"rigid\"\n[vehicle]\nspec = "
    "\"{0}/assets/vehicles/light_tracked.toml\"\nsphere_radius = 0.02\n[driver]\nsprocket_speed = 1.0\n[fluid]\n"
    "spacing = 0.1\nlevel = 0.5\n",
    GROUSER_SOURCE_DIR);

/// Particles and markers are made for a vehicle on the ground.
TEST(FluidScene, RefusesAVehicleOnAnObstacle) {
  const std::string text =
      kRestingFord + "[[box]]\nposition = [1.5, 0.9, 0.05]\nsize = [0.3, 0.4, 0.1]\nmaterial = \"ground\"\n";
  EXPECT_THROW(madeFluid(text, 2), base::InputError);
}

/// A vehicle that waits for rest starts although the water supports more than 7 % of its weight.
TEST(FluidScene, AVehicleInWaterRests) {
  Simulation s = madeFluid(kRestingFord, 2);
  double lift = 0;
  while (s.time() < 3 && !s.vehicle()->driveStart()) {
    s.step();
    lift = 0;
    for (const fluid::BodyLoad& l : columnLoads(s)) lift += l.force.z;
  }
  EXPECT_TRUE(s.vehicle()->driveStart());
  EXPECT_GT(lift, 0.07 * 5018 * kWaterGravity);
}

/// A state without its fluid, or with more bodies, belongs to another scene.
TEST(FluidScene, RefusesTheStateOfAnotherScene) {
  const SimulationSetup setup =
      setup::simulationSetup(setup::parseScene(waterTank(floatingBox(5, 0.42)), "fluid.toml"));
  SimulationState state = Simulation(setup, testExec(1), [](double, double) {}).save();
  state.fluid->bodies.push_back(0);
  EXPECT_THROW(Simulation(setup, testExec(1), state), base::InputError);
  state.fluid.reset();
  EXPECT_THROW(Simulation(setup, testExec(1), state), base::InputError);
}

} // namespace
} // namespace grouser::coupling
