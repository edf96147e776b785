// SPDX-License-Identifier: BSD-3-Clause
// Surfaces under load along one axis that are also pulled or turned: sheared plates and loaded wheels, against
// closed forms.
#include "base/math.hpp"
#include "base/sphere.hpp"
#include "coupling/simulation.hpp"
#include "coupling/surfaces.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/setup/simulation_setup.hpp"
#include "tests/system/cube_file.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace grouser::coupling {
namespace {

using base::Vec3d;

constexpr double kLoad = 40, kMass = 1;
const double kNormal = kLoad + 9.81 * kMass; // normal force of the load and its weight [N]

/// Grains in the corner of a rough floor and a rough wall at x = 0.01, below a slippery surface: they do not move.
std::string corner(const std::vector<double>& at = {0}) {
  std::string text = R"(version = 1
[run]
duration = 2.0
time_step = 2e-5
threads = 1
[material.rough]
stiffness = 1e6
restitution = 0.3
friction = 1.0
[material.slick]
stiffness = 1e6
restitution = 0.3
friction = 0.1
[[plane]]
material = "rough"
[[plane]]
point = [0.01, 0, 0]
normal = [-1, 0, 0]
material = "rough"
)";
  for (const double y : at)
    text += fmt::format("[[grain]]\nposition = [0, {}, 0.01]\nradius = 0.01\nmaterial = \"rough\"\n", y);
  return text;
}

std::string loaded(const std::string& shape, const std::string& motion) {
  return shape +
         fmt::format("name = \"tool\"\nmaterial = \"slick\"\nfree = \"z\"\nmass = {}\nload = {}\n"
                     "load_ramp = 0.05\nstart = 0.2\n",
                     kMass, -kLoad) +
         motion;
}

const std::string kPlate = "[[box]]\nposition = [0, 0, 0.03]\nsize = [0.3, 0.2, 0.02]\n";
const std::string kWheel = "[[cylinder]]\nposition = [0, 0, 0.12]\naxis = [0, 1, 0]\nradius = 0.1\nlength = 0.05\n";

std::unique_ptr<Simulation> made(const std::string& text, const std::vector<std::string>& overrides = {},
                                 int threads = 1) {
  return std::make_unique<Simulation>(setup::simulationSetup(setup::parseScene(text, "loaded.toml", overrides)),
                                      base::cpuExec(threads), [](double, double) {});
}

/// Means over the time between two times [s].
Surfaces::Observation between(Simulation& s, double from, double to, std::size_t surface = 0) {
  while (s.time() < from) s.step();
  const_cast<Surfaces*>(s.surfaces())->restartMeans();
  while (s.time() < to) s.step();
  return s.surfaces()->observe(surface, s.steps());
}

TEST(LoadedPlate, PulledOverGrainsThatStayIsHeldByFrictionTimesItsLoad) {
  const auto s = made(corner({-0.04, 0, 0.04}) + loaded(kPlate, "velocity = [0.1, 0, 0]\n"
                                                                "spin = [0, 0, 0]\npivot = [0, -0.5, 0.03]\n"));
  const Surfaces::Observation o = between(*s, 0.6, 0.65);
  // Residual oscillation after the ramp and the jerk of the pull.
  EXPECT_NEAR(o.force.z, kNormal, 1e-4 * kNormal);
  EXPECT_NEAR(o.force.x, -0.1 * o.force.z, 1e-5 * kNormal);
  EXPECT_NEAR(o.force.y, 0, 1e-4 * kNormal);
  EXPECT_NEAR(o.power, 0.1 * 0.1 * kNormal, 1e-3 * o.power) << "work of the pull; the load does no work at rest";
  EXPECT_NEAR(o.position.x, 0.1 * 0.45, 1e-12);
  const Vec3d lever{0, 0.5, 0};
  EXPECT_LT(norm(o.pivotTorque - o.torque - cross(lever, o.force)), 1e-9 * kNormal) << "about the pivot";
}

TEST(LoadedPlate, SinksAlikeWhetherPulledWithoutFrictionOrNot) {
  const std::vector<std::string> smooth{"material.slick.friction=0"};
  const auto still = made(corner() + loaded(kPlate, "velocity = [0, 0, 0]\n"), smooth),
             pulled = made(corner() + loaded(kPlate, "velocity = [0.1, 0.05, 0]\nspin = [0, 0, 1]\n"), smooth);
  for (int n = 0; n < 15000; ++n) still->step(), pulled->step();
  const SurfaceState a = still->surfaces()->save().surfaces[0], b = pulled->surfaces()->save().surfaces[0];
  EXPECT_EQ(a.offset, b.offset);
  EXPECT_EQ(a.speed, b.speed);
}

TEST(LoadedPlate, TurnedOverGrainsThatStayTakesFrictionTimesLoadTimesArm) {
  // Two grains at x = -a and a, each held by a block on the side that the plate drives it to.
  constexpr double kArm = 0.05;
  std::string text = corner();
  text.resize(text.find("[[plane]]\npoint"));
  for (const double side : {-1.0, 1.0})
    text += fmt::format("[[grain]]\nposition = [{0}, 0, 0.01]\nradius = 0.01\nmaterial = \"rough\"\n"
                        "[[box]]\nposition = [{0}, {1}, 0.009]\nsize = [0.02, 0.02, 0.018]\nmaterial = \"rough\"\n",
                        side * kArm, side * 0.02);
  text +=
      loaded("[[box]]\nposition = [0, 0, 0.03]\nsize = [0.3, 0.3, 0.02]\n", "spin = [0, 0, 0.5]\npivot = [0, 0, 0]\n");
  const auto s = made(text);
  const Surfaces::Observation o = between(*s, 0.6, 0.65, 2);
  EXPECT_NEAR(o.force.z, kNormal, 1e-4 * kNormal);
  // The grains yield by only mu N / (2 k) = 2.5e-6 m, but rotate about their contacts by some 1e-5 m.
  EXPECT_NEAR(o.torque.z, -0.1 * kNormal * kArm, 1e-3 * 0.1 * kNormal * kArm);
  EXPECT_NEAR(o.pivotTorque.z, o.torque.z, 1e-6 * std::fabs(o.torque.z)) << "the pivot lies below its centre";
  EXPECT_NEAR(o.power, 0.5 * 0.1 * kNormal * kArm, 1e-3 * o.power);
}

TEST(LoadedWheel, SpinningOnTheSpotTakesFrictionTimesLoadTimesRadius) {
  const auto s = made(corner() + loaded(kWheel, "spin = [0, -2, 0]\n")); // its lowest point goes to +x
  const Surfaces::Observation o = between(*s, 0.6, 0.65);
  // The grain touches the wall with an offset of some 1e-5 m: the contact is inclined by that over R + r.
  EXPECT_NEAR(o.force.z, kNormal, 1e-3 * kNormal);
  EXPECT_NEAR(o.force.x, -0.1 * kNormal, 1e-2 * 0.1 * kNormal);
  EXPECT_NEAR(o.torque.y, 0.1 * kNormal * 0.1, 1e-2 * 0.1 * kNormal * 0.1);
  EXPECT_NEAR(o.power, 2 * std::fabs(o.torque.y), 1e-3 * o.power);
}

TEST(LoadedWheel, RollingFreelyFeelsNoFrictionAndSlippingAllOfIt) {
  const auto pull = [](double spin) {
    const auto s = made(corner() + loaded(kWheel, fmt::format("velocity = [0.05, 0, 0]\nspin = [0, {}, 0]\n", spin)));
    const Surfaces::Observation o = between(*s, 0.205, 0.21);
    // 0.4 mm past the top of the grain: the contact is inclined.
    const Vec3d normal = base::normalized(Vec3d{0.05 * 0.0075, 0, 0.11});
    return dot(o.force, Vec3d{normal.z, 0, -normal.x}) / norm(o.force);
  };
  EXPECT_NEAR(pull(0.5), 0, 0.005) << "v = omega R";
  EXPECT_NEAR(pull(0), -0.1, 0.005) << "locked";
  EXPECT_NEAR(pull(0.25), -0.1, 0.005) << "braked to half the speed";
}

TEST(LoadedPlate, HeightConvergesAtFirstOrderAsSymplecticEulerDoes) {
  // An elastic plate dropped on an elastic grain and pulled: differences between steps of h, h/2, h/4 halve.
  const auto height = [](int finer) {
    const auto s = made(corner() + loaded(kPlate, "velocity = [0.1, 0, 0]\n"),
                        {fmt::format("run.time_step={}", 2e-5 / finer), "material.rough.restitution=1",
                         "material.slick.restitution=1", "material.slick.friction=0", "material.rough.friction=0",
                         "box.tool.load_ramp=0.004", "box.tool.start=0.0"});
    while (s->steps() < 500 * finer) s->step();
    return s->surfaces()->pose(0, s->steps()).position.z;
  };
  const double h = height(1), half = height(2), quarter = height(4), eighth = height(8);
  EXPECT_GT(std::fabs(h - half), 1e-9) << "the difference is above rounding";
  EXPECT_NEAR((h - half) / (half - quarter), 2, 0.3);
  EXPECT_NEAR((half - quarter) / (quarter - eighth), 2, 0.15);
}

TEST(LoadedPlate, LedgerClosesAndThePullIsWhatFrictionTakes) {
  const auto s = made(corner({-0.04, 0, 0.04}) + loaded(kPlate, "velocity = [0.1, 0, 0]\n"));
  while (s->time() < 0.3) s->step();
  const Ledger a = s->ledger();
  while (s->time() < 0.6) s->step();
  const Ledger b = s->ledger();
  const double pulled = 0.1 * kNormal * 0.1 * 0.3;
  EXPECT_NEAR(b.driveWork - a.driveWork, pulled, 1e-3 * pulled);
  EXPECT_NEAR(b.dissipated.friction - a.dissipated.friction, pulled, 2e-3 * pulled);
  // Rounding: only the plate moves, across; the bound refers to the impulse, not to the turnover.
  EXPECT_LT(std::fabs(b.residual), 1e-9 * b.driveWork);
  EXPECT_LT(std::fabs(b.integrationError - a.integrationError), 1e-3 * pulled);
  EXPECT_LT(norm(b.momentumResidual), 1e-9) << "impulses are some 30 N s";
}

TEST(LoadedMesh, CubeThatIsPressedPulledAndTurnedActsAsTheBoxDoes) {
  const std::string motion = "velocity = [0.1, 0, 0]\nspin = [0, 0.3, 1]\npivot = [0, 0.02, 0.07]\n";
  const auto box = made(corner({-0.03, 0.03}) +
                        loaded("[[box]]\nposition = [0, 0, 0.07]\nsize = [0.1, 0.1, 0.1]\n", motion)),
             mesh = made(corner({-0.03, 0.03}) +
                         loaded(fmt::format("[[mesh]]\nfile = \"{}\"\nscale = 0.05\nsphere_radius = 0.004\n"
                                            "position = [0, 0, 0.07]\n",
                                            cubeFile()),
                                motion));
  const Surfaces::Observation a = between(*box, 0.25, 0.3), b = between(*mesh, 0.25, 0.3);
  EXPECT_GT(a.force.z, 0.5 * kNormal);
  EXPECT_LT(norm(a.force - b.force), 0.02 * norm(a.force)) << "its discs are floats with rounded edges";
  EXPECT_LT(norm(a.torque - b.torque), 0.02 * norm(a.force) * 0.05);
  EXPECT_NEAR(a.position.z, b.position.z, 1e-6);
}

TEST(LoadedWheel, ResumedRunHasTheBitsOfAStraightOneOfThreadsAndOfSkins) {
  const std::string text =
      corner({-0.03, 0, 0.03}) + loaded(kWheel, "velocity = [0.05, 0, 0]\nspin = [0, 2, 0]\npivot = [0, 0, 0.13]\n");
  const auto run = [&](std::unique_ptr<Simulation> s) {
    while (s->steps() < 14000) s->step();
    return s;
  };
  const auto straight = run(made(text));
  EXPECT_EQ(run(made(text, {}, 2))->stateHash(), straight->stateHash());
  EXPECT_EQ(run(made(text, {"run.skin=0.7"}))->stateHash(), straight->stateHash());
  const auto first = made(text);
  while (first->steps() < 11111) first->step();
  Simulation second(setup::simulationSetup(setup::parseScene(text, "loaded.toml")), base::cpuExec(1), first->save());
  while (second.steps() < 14000) second.step();
  EXPECT_EQ(second.stateHash(), straight->stateHash());
  EXPECT_EQ(second.surfaces()->observe(0, 14000).pivotTorque, straight->surfaces()->observe(0, 14000).pivotTorque);
  EXPECT_NE(straight->surfaces()->save().surfaces[0].offset, 0);
}

} // namespace
} // namespace grouser::coupling
