// SPDX-License-Identifier: BSD-3-Clause
// The whole vehicle: identical results, rest on the bed, the rigid-ground control, and sinkage on the bed.
#include "coupling/simulation.hpp"

#include "runs/setup/load_scene.hpp"
#include "runs/setup/simulation_setup.hpp"
#include "tests/device_under_test.hpp"
#include "tests/runs/shared_cache.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fmt/format.h>
#include <memory>

namespace grouser::coupling {
namespace {

/// Hash of tests/scenes/coupled.toml: the vehicle on 4,992 grains after 2,000 steps. A change of it is a change of
/// the physics or of its order of operations, and needs a stated reason in the commit.
constexpr const char* kCoupledHash = "a730de5cca96dbe3";

void quiet(double, double) {}

/// `together`: steps per call, which a GPU batches; 0: single steps.
std::string coupledHash(const base::Exec& exec, const std::vector<std::string>& overrides = {},
                        std::int64_t together = 0, storage::BedCache* beds = nullptr,
                        storage::SphereCache* spheres = nullptr) {
  Simulation simulation(setup::simulationSetup(setup::loadScene(testScene("coupled.toml"), overrides)), exec, quiet, {},
                        beds, spheres);
  while (simulation.steps() < 2000) {
    if (together == 0)
      simulation.step();
    else
      simulation.advance(std::min(together, 2000 - simulation.steps()));
  }
  EXPECT_EQ(simulation.ledger().impulseResidual, base::Vec3d{}) << "vehicle and bed exchange exact opposites";
  return simulation.stateHash();
}

TEST(OneAnswer, CoupledSceneOnOneThread) { EXPECT_EQ(coupledHash(base::cpuExec(1)), kCoupledHash); }

TEST(OneAnswer, CoupledSceneOnTwoThreadsWithOtherRebuilds) {
  EXPECT_EQ(coupledHash(base::cpuExec(2), {"run.skin=0.6"}, 0, nullptr, sharedSpheres()), kCoupledHash);
}

TEST(OneAnswer, CoupledSceneOnCuda) {
  if (!base::cudaAvailable()) GTEST_SKIP() << "no CUDA device";
  EXPECT_EQ(coupledHash(base::cudaExec()), kCoupledHash);
}

/// Steps in one batch; in batches of an odd number, which start with either buffer, with rebuilds within them; and in
/// pairs.
TEST(OneAnswer, CoupledSceneOnCudaLaunchedAhead) {
  if (!base::cudaAvailable()) GTEST_SKIP() << "no CUDA device";
  EXPECT_EQ(coupledHash(base::cudaExec(), {}, 2000), kCoupledHash);
  EXPECT_EQ(coupledHash(base::cudaExec(), {"run.skin=0.02"}, 13), kCoupledHash) << "rebuilds within a batch";
  EXPECT_EQ(coupledHash(base::cudaExec(), {"run.skin=0.8"}, 2), kCoupledHash);
}

TEST(OneAnswer, CoupledSceneInBatchesOfSteps) {
  EXPECT_EQ(coupledHash(base::cpuExec(2), {}, 100, sharedBeds(), sharedSpheres()), kCoupledHash);
}

/// Cohesive soil, such as loam, that adheres to the shoes.
TEST(OneAnswer, OfSoilThatSticksToTheVehicle) {
  const auto hash = [](const base::Exec& exec, const std::string& adhesion) {
    Simulation simulation(setup::simulationSetup(setup::loadScene(
                              testScene("coupled.toml"),
                              {"material.soil.cohesion=20", "material.soil.adhesion_radius=0.03", "terrain.layers=2",
                               "vehicle.sphere_radius=0.03", "vehicle.clearance=0", "vehicle.adhesion=" + adhesion})),
                          exec, quiet, {}, sharedBeds(), sharedSpheres());
    while (simulation.steps() < 1000) simulation.advance(1000 - simulation.steps());
    return simulation.stateHash();
  };
  const std::string one = hash(base::cpuExec(1), "0.5");
  EXPECT_EQ(hash(base::cpuExec(2), "0.5"), one);
  if (base::cudaAvailable()) {
    EXPECT_EQ(hash(base::cudaExec(), "0.5"), one);
  }
  EXPECT_NE(hash(base::cpuExec(1), "0"), one) << "the hash must depend on adhesion";
}

/// Hash of a run with complementarity contacts. `resumes`: continues from a saved state halfway.
std::string solvedHash(const base::Exec& exec, const std::string& skin = "0.3", bool resumes = false) {
  const SimulationSetup setup = setup::simulationSetup(setup::loadScene(
      testScene("coupled.toml"), {"run.contact=complementarity", "terrain.layers=2", "terrain.grain_radius=0.06",
                                  "vehicle.sphere_radius=0.03", "vehicle.clearance=0", "driver.tension_ramp=0.005",
                                  "driver.weight_ramp=0.005", "run.residual=1e-3", "run.skin=" + skin}));
  auto simulation = std::make_unique<Simulation>(setup, exec, quiet, base::Comm{}, sharedBeds(), sharedSpheres());
  while (simulation->steps() < 200) simulation->step();
  if (resumes)
    simulation = std::make_unique<Simulation>(setup, exec, simulation->save(), base::Comm{}, sharedSpheres());
  while (simulation->steps() < 400) simulation->step();
  const Ledger l = simulation->ledger();
  EXPECT_EQ(l.impulseResidual, base::Vec3d{});
  EXPECT_GT(l.partContacts, 5);
  EXPECT_LT(std::fabs(l.residual), 1e-6 * l.turnover);
  EXPECT_LT(std::fabs(l.integrationError), 0.02 * l.turnover);
  EXPECT_EQ(simulation->ground().grains->system().impulses->totals().missed, 0);
  return simulation->stateHash();
}

TEST(OneAnswer, VehicleOnGrainsWhoseContactsAreSolvedFor) {
  const std::string one = solvedHash(base::cpuExec(1));
  EXPECT_EQ(solvedHash(base::cpuExec(2), "0.6", true), one) << "threads, lists, and a resumed run";
  if (base::cudaAvailable()) {
    EXPECT_EQ(solvedHash(base::cudaExec()), one);
  }
}

TEST(OneAnswer, AnotherSeedIsAnotherState) {
  const auto hash = [](const char* seed) {
    return Simulation(setup::simulationSetup(setup::loadScene(
                          testScene("coupled.toml"),
                          {seed, "vehicle.sphere_radius=0.03", "terrain.layers=2", "terrain.settle_time_limit=0"})),
                      base::cpuExec(1), quiet, {}, nullptr, sharedSpheres())
        .stateHash();
  };
  const std::string one = hash("run.seed=7");
  EXPECT_EQ(hash("run.seed=7"), one);
  EXPECT_NE(hash("run.seed=8"), one) << "the hash must depend on the state";
}

/// Track history of one shoe.
struct Track {
  std::vector<double> time, height;
  std::vector<bool> onGround;
};

struct Drive {
  std::vector<double> time, speed; ///< times of the left track's tooth passages
  std::vector<Track> shoes;
};

/// Runs a scene and keeps the left track's shoes every hundredth of a second.
Drive drive(Simulation& simulation, double duration) {
  Drive d;
  const auto every = static_cast<std::int64_t>(std::llround(0.01 / simulation.timeStep()));
  d.shoes.resize(simulation.vehicle()->assembly().tracks[0].shoes.size());
  while (simulation.time() < duration) {
    for (std::int64_t i = 0; i < every; ++i) simulation.step();
    const vehicle::Observation o = simulation.vehicle()->observe();
    simulation.restartMeans();
    d.time.push_back(simulation.time());
    d.speed.push_back(o.tracks[0].toothSpeed);
    for (std::size_t s = 0; s < d.shoes.size(); ++s) {
      d.shoes[s].time.push_back(simulation.time());
      d.shoes[s].height.push_back(o.tracks[0].padHeight[s]);
      d.shoes[s].onGround.push_back(o.tracks[0].onGround[s] > 0);
    }
  }
  return d;
}

struct Line {
  double slope = 0, error = 0; ///< [m/s], standard error
  int points = 0;
};

/// Least squares through the heights of four consecutive shoes while they carry load after `from`, each about its own
/// mean.
Line slopeOnGround(const Drive& d, std::size_t first, double from) {
  double xx = 0, xy = 0, yy = 0;
  Line line;
  for (std::size_t s = first; s < first + 4; ++s) {
    const Track& t = d.shoes[s];
    double tm = 0, hm = 0;
    int n = 0;
    for (std::size_t i = 0; i < t.time.size(); ++i)
      if (t.onGround[i] && t.time[i] > from) tm += t.time[i], hm += t.height[i], ++n;
    if (n < 3) continue;
    tm /= n, hm /= n;
    for (std::size_t i = 0; i < t.time.size(); ++i) {
      if (!t.onGround[i] || t.time[i] <= from) continue;
      const double x = t.time[i] - tm, y = t.height[i] - hm;
      xx += x * x, xy += x * y, yy += y * y;
    }
    line.points += n;
  }
  line.slope = xy / xx;
  line.error = std::sqrt(std::max(0.0, yy - line.slope * xy) / (line.points - 5) / xx);
  return line;
}

/// Whether a shoe carried load after `from` and was then picked up by the sprocket.
bool passed(const Track& t, double from) {
  int carried = 0;
  double lowest = 1e9;
  for (std::size_t i = 0; i < t.time.size(); ++i)
    if (t.time[i] > from && t.onGround[i]) ++carried, lowest = std::min(lowest, t.height[i]);
  return carried >= 15 && !t.onGround.back() && t.height.back() > lowest + 0.03;
}

/// The first of the last four consecutive shoes that did: those with the longest ground contact.
std::size_t fourShoes(const Drive& d, double from) {
  for (std::size_t s = d.shoes.size() - 3; s-- > 0;) {
    bool all = true;
    for (std::size_t k = s; k < s + 4; ++k) all = all && passed(d.shoes[k], from);
    if (all) return s;
  }
  ADD_FAILURE() << "no four shoes were picked up";
  return 0;
}

TEST(RigidGround, ShoesStayLevelAndSpeedIsPitchRadiusTimesOmega) {
  Simulation simulation(
      setup::simulationSetup(setup::loadScene(testScene("rigid.toml"), {"vehicle.sphere_radius=0.03"})), testExec(),
      quiet, {}, nullptr, sharedSpheres());
  const double omega = 2, begin = 0.5;
  const Drive d = drive(simulation, 6.0);
  const vehicle::VehicleSpec& spec = simulation.vehicle()->assembly().spec;

  // Static overlap: the ground carries the weight on grousers as an elastic foundation, a fraction of a millimetre.
  double lowest = 1, highest = -1;
  for (const Track& shoe : d.shoes)
    for (std::size_t i = 0; i < shoe.time.size(); ++i) {
      // Only shoes well inside the ground contact: loaded for 0.1 s before and after.
      bool inside = shoe.time[i] > begin + 0.3;
      for (std::size_t k = i < 10 ? 0 : i - 10; k <= i + 10; ++k)
        inside = inside && k < shoe.time.size() && shoe.onGround[k];
      if (!inside) continue;
      lowest = std::min(lowest, shoe.height[i]), highest = std::max(highest, shoe.height[i]);
    }
  EXPECT_LT(highest - lowest, 1e-3) << "heights from " << lowest << " to " << highest;

  double sum = 0;
  int n = 0;
  for (std::size_t i = 0; i < d.time.size(); ++i)
    if (d.time[i] > 3.0) sum += d.speed[i], ++n; // it oscillates for two seconds
  EXPECT_NEAR(sum / n / (omega * spec.pitchRadius()), 1, 0.004);

  const Line line = slopeOnGround(d, fourShoes(d, begin), begin);
  std::printf("rigid: heights within %.3f mm, speed %.4f of omega r, slope %.3g +- %.2g m/s\n",
              1e3 * (highest - lowest), sum / n / (omega * spec.pitchRadius()), line.slope, line.error);
  EXPECT_LT(std::fabs(line.slope), 1e-3) << "bound for the slope on a bed";
}

TEST(GranularBed, ShoesSinkWhileTheyCarryAndArePickedUp) {
  Simulation simulation(setup::simulationSetup(setup::loadScene(
                            testScene("coupled.toml"), {"driver.drive_start=0.5", "driver.weight_ramp=0.2",
                                                        "terrain.size=[4.7,2.6]", "vehicle.sphere_radius=0.03"})),
                        testExec(), quiet, {}, sharedBeds(), sharedSpheres());
  const double begin = 0.5;
  const Drive d = drive(simulation, 2.6);
  const Line line = slopeOnGround(d, fourShoes(d, begin), begin);
  std::printf("bed: slope %.3g +- %.2g m/s over %d points\n", line.slope, line.error, line.points);
  EXPECT_LT(line.slope, -3e-3) << "three times the bound of the rigid control";
  EXPECT_LT(line.slope + 3 * line.error, 0) << "significant";
}

TEST(GranularBed, CarriesTheWholeWeightAtRest) {
  Simulation simulation(setup::simulationSetup(setup::loadScene(
                            testScene("coupled.toml"), {"driver.sprocket_speed=0", "driver.weight_ramp=0.3",
                                                        "driver.drive_start=0.4", "vehicle.sphere_radius=0.03"})),
                        testExec(), quiet, {}, sharedBeds(), sharedSpheres());
  // The lowest pad, from tightening of the track until the full weight is on.
  const auto lowest = [&] {
    const std::vector<double> pads = simulation.vehicle()->observe().tracks[0].padHeight;
    return *std::min_element(pads.begin(), pads.end());
  };
  while (simulation.time() < 0.1) simulation.step();
  const double before = lowest();
  while (simulation.time() < 0.7) simulation.step();
  const double sunk = before - lowest();
  simulation.restartMeans();
  while (simulation.time() < 1.2) simulation.step();
  const double weight = simulation.vehicle()->assembly().mass * 9.81;
  const double force = simulation.vehicle()->meanGroundForce().z;
  std::printf("rest: ground force / weight = %.5f, sunk by %.1f mm\n", force / weight, 1e3 * sunk);
  EXPECT_NEAR(force / weight, 1, 0.005);
  EXPECT_GT(sunk, 3e-3) << "three times the scatter of shoes on rigid ground";
}

} // namespace
} // namespace grouser::coupling
