// SPDX-License-Identifier: BSD-3-Clause
// Rigid surfaces of scenes: their laws of motion, platens under load, measurements, checkpoints, and rejected
// scenes.
#include "base/sphere.hpp"
#include "coupling/surfaces.hpp"
#include "runs/setup/load_scene.hpp"

#include "base/error.hpp"
#include "base/math.hpp"
#include "coupling/simulation.hpp"
#include "runs/output/surface_mesh.hpp"
#include "runs/scene/scene.hpp"
#include "runs/scene/scene_file.hpp"
#include "runs/setup/ground_setup.hpp"
#include "runs/setup/scene_surfaces.hpp"
#include "runs/setup/simulation_setup.hpp"
#include "runs/setup/step_limit.hpp"
#include "tests/system/cube_file.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace grouser::coupling {
namespace {

using base::Vec3d;

const std::string kHead = R"(version = 1
[run]
duration = 1.0
time_step = 2e-5
threads = 1
[material.glass]
stiffness = 1e5
restitution = 0.3
friction = 0.6
)";

std::string grainAt(const std::string& position) {
  return "[[grain]]\nposition = " + position + "\nradius = 0.01\nmaterial = \"glass\"\n";
}

scene::Scene sceneOf(const std::string& rest, const std::vector<std::string>& overrides = {}) {
  return setup::parseScene(kHead + rest, "surfaces.toml", overrides);
}

std::unique_ptr<Simulation> made(const scene::Scene& scene, std::int64_t steps = 0, int threads = 1) {
  auto s = std::make_unique<Simulation>(setup::simulationSetup(scene), base::cpuExec(threads), [](double, double) {});
  while (s->steps() < steps) s->step();
  return s;
}

TEST(SurfaceMotion, VelocityIsTheSlopeOfThePlaceAndEndsWithIt) {
  SurfaceMotionLaw law;
  law.velocity = {0.3, -0.1, 0}, law.spin = {1, 2, -2}, law.pivot = {1, 0, 0}, law.amplitude = {0, 0.02, 0.01};
  law.frequency = 3, law.phase = 40.0 / 360, law.start = 0.25, law.until = 1.75;
  const SurfaceMotion motion(law, {0.2, 0.5, 0});
  EXPECT_LT(norm(motion.at(0.1).centre - Vec3d{0.2, 0.5, 0}), 1e-15);
  EXPECT_EQ(norm(motion.at(0.1).velocity), 0);
  constexpr double kStep = 1e-5;
  for (const double t : {0.3, 0.9, 1.6}) {
    const auto now = motion.at(t), before = motion.at(t - kStep), after = motion.at(t + kStep);
    // Third derivatives are below 200 m/s3: central differences are accurate to that times h^2 / 6, and round-off / h.
    EXPECT_LT(norm((after.centre - before.centre) * (0.5 / kStep) - now.velocity), 1e-8) << t;
    const base::Mat3d a = before.turned.matrix(), b = after.turned.matrix(), m = now.turned.matrix();
    for (int k = 0; k < 3; ++k) {
      const Vec3d axis{m.m[0][k], m.m[1][k], m.m[2][k]}, was{a.m[0][k], a.m[1][k], a.m[2][k]},
          is{b.m[0][k], b.m[1][k], b.m[2][k]};
      EXPECT_LT(norm((is - was) * (0.5 / kStep) - cross(now.spin, axis)), 1e-8);
    }
    EXPECT_NEAR(norm(now.centre - (Vec3d{1, 0, 0} + Vec3d{0.3, -0.1, 0} * (t - 0.25))), norm(Vec3d{0.8, 0.5, 0}), 0.06);
  }
  EXPECT_EQ(motion.at(2).velocity, Vec3d{});
  EXPECT_EQ(motion.at(2).centre, motion.at(1.75).centre);
  EXPECT_EQ(motion.at(9).turned.w, motion.at(1.75).turned.w);
}

const std::string kPress = R"([[plane]]
name = "floor"
material = "glass"
[[box]]
name = "lid"
position = [0, 0, 0.0301]
size = [0.08, 0.08, 0.02]
material = "glass"
free = "z"
mass = 2
load = -50
)" + grainAt("[0.02, 0.02, 0.01]") +
                           grainAt("[-0.02, 0.02, 0.01]") + grainAt("[0.02, -0.02, 0.01]") +
                           grainAt("[-0.02, -0.02, 0.01]");

TEST(FreeSurface, RestsWhereGrainsCarryLoadAndWeight) {
  const scene::Scene scene = sceneOf(kPress);
  const auto s = made(scene, 40000);
  const Surfaces& surfaces = *s->surfaces();
  ASSERT_EQ(surfaces.count(), 2u);
  const double weight = base::sphereMass(2500, 0.01) * 9.81, pressed = (50 + 2 * 9.81) / 4, k = 1e5;
  const double height = 0.02 - pressed / k - (pressed + weight) / k + 0.01;
  EXPECT_NEAR(surfaces.pose(1, s->steps()).position.z, height, 1e-3 * pressed / k) << "residual oscillation";
  auto fresh = made(scene, 40000);
  fresh->restartMeans();
  fresh->step();
  EXPECT_NEAR(fresh->surfaces()->observe(1, 0).force.z, 4 * pressed, 1e-3 * pressed);
  EXPECT_NEAR(fresh->surfaces()->observe(0, 0).force.z, -4 * (pressed + weight), 1e-3 * pressed);
  // Energy: the work of load and weight is stored in springs or dissipated. Dashpot losses use the speed in the
  // middle of the step as for a single contact; here two contacts load a grain: first order in the step.
  const Ledger l = s->ledger();
  EXPECT_NEAR(l.driveWork, 50 * (0.0301 - height), 1e-6 * 50);
  EXPECT_LT(std::fabs(l.residual), 0.05 * l.driveWork);
}

TEST(FreeSurface, IsCarriedAcrossWhileFreeAlongAnotherAxis) {
  const scene::Scene scene = sceneOf(kPress, {"box.lid.velocity=[0.05,0,0]", "box.lid.start=0.2"});
  const auto s = made(scene, 15000);
  EXPECT_NEAR(s->surfaces()->pose(0 + 1, 15000).position.x, 0.05 * 0.1, 1e-15);
  // The grains roll below it at half its speed.
  EXPECT_NEAR(s->ground().grains->snapshot().velocity[0].x, 0.025, 0.002);
}

TEST(FreeSurface, AStepTooLongForItsMassIsRefused) {
  const scene::Scene light = sceneOf(kPress, {"box.lid.mass=1e-4"});
  try {
    setup::chooseTimeStep(light);
    FAIL();
  } catch (const base::InputError& error) {
    EXPECT_NE(std::string(error.what())
                  .find("is above 1.54e-06 s, the stability limit of the stiffest contact in the scene (lid of"),
              std::string::npos)
        << error.what(); // on the springs of all four grains
  }
}

TEST(Surfaces, TooQuickToBeFeltAreRefusedAndBeltsAreNot) {
  const auto built = [](const std::string& surface) {
    return buildGround(
        setup::groundSetup(
            setup::parseScene("version = 1\n[run]\nduration = 1\n[material.soil]\n[[grain]]\nmaterial = \"soil\"\n"
                              "radius = 0.01\nposition = [0, 0, 1]\n" +
                                  surface + "material = \"soil\"\n",
                              "quick.toml"),
            1e-5),
        base::cpuExec(1));
  };
  const std::string box = "[[box]]\nname = \"lid\"\nposition = [0, 0, 0]\nsize = [1, 1, 0.001]\n";
  EXPECT_NO_THROW(built(box + "velocity = [0, 0, 499]\n")); // half a radius a step is 500 m/s
  EXPECT_THROW(built(box + "velocity = [0, 0, 501]\n"), base::InputError);
  EXPECT_THROW(built(box + "amplitude = [0.1, 0, 0]\nfrequency = 800\n"), base::InputError);
  EXPECT_NO_THROW(built("[[plane]]\nvelocity = [900, 0, 0]\n"));
  EXPECT_THROW(built("[[plane]]\nvelocity = [0, 0, 900]\n"), base::InputError);
  // 2 m from the pivot, at 400 rad/s: along the rotation axis that is no lever arm, across it 800 m/s.
  const std::string auger = "[[cylinder]]\nposition = [0, 0, 0]\nradius = 0.05\nlength = 0.1\nspin = [0, 0, 400]\n";
  EXPECT_NO_THROW(built(auger + "pivot = [0, 0, -2]\n"));
  EXPECT_THROW(built(auger + "pivot = [2, 0, 0]\n"), base::InputError);
}

TEST(FreeSurface, TooQuickToBeFeltStopsTheRunAndIsNamed) {
  const auto stop = [](const std::string& load) -> std::string {
    Simulation s(setup::simulationSetup(setup::parseScene(
                     "version = 1\n[run]\nduration = 1\ntime_step = 1e-5\n[material.soil]\n[[grain]]\nradius = "
                     "0.01\nposition = [0, 0, 1]\nmaterial = \"soil\"\n[[box]]\nname = \"lid\"\nmaterial = "
                     "\"soil\"\nposition = [5, 0, 0]\nsize = [1, 1, 1]\nfree = \"z\"\nmass = 1\nload = " +
                         load + "\n",
                     "lid.toml")),
                 base::cpuExec(1), [](double, double) {});
    try {
      while (s.steps() < 100) s.step();
    } catch (const base::SimulationError& error) {
      return error.what();
    }
    return "";
  };
  // Half a radius per step is 500 m/s, which a load of 1e6 N on 1 kg reaches in 50 steps.
  const std::string printed = stop("1e6");
  for (const char* part :
       {"step 50, time 0.0005 s: the loaded surface lid moves at 510 m/s", "(500 m/s)", "lower its load"})
    EXPECT_NE(printed.find(part), std::string::npos) << part << "\n" << printed;
  EXPECT_EQ(stop("4e5"), "");
}

TEST(FreeSurface, APlaneMayLieOnAllGrainsAtOnce) {
  std::string text =
      "version = 1\n[run]\nduration = 0.05\n[material.soil]\nstiffness = 1e5\n[[plane]]\nmaterial = \"soil\"\n"
      "[[plane]]\nname = \"lid\"\nmaterial = \"soil\"\npoint = [0, 0, 0.0201]\nnormal = [0, 0, -1]\n"
      "free = \"z\"\nmass = 0.02\nload = -3\n";
  for (int k = 0; k < 16; ++k)
    text += "[[grain]]\nmaterial = \"soil\"\nradius = 0.01\nposition = [" + std::to_string(0.03 * (k % 4)) + ", " +
            std::to_string(0.03 * static_cast<int>(k / 4)) + ", 0.01]\n";
  Simulation simulation(setup::simulationSetup(setup::parseScene(text, "lid.toml")), base::cpuExec(1),
                        [](double, double) {});
  // Sixteen springs on the lid: omega^2 = k (1 / m + 16 / M); undamped limit 2 / omega.
  const double grain = 2500 * 4.0 / 3 * base::kPi * 1e-6, omega = std::sqrt(1e5 * (1 / grain + 16 / 0.02));
  EXPECT_LT(simulation.timeStep(), 2 / omega);
  while (simulation.time() < 0.05) {
    simulation.step();
    if (simulation.steps() % 500 == 0) simulation.checkEnergy();
  }
  EXPECT_NEAR(simulation.surfaces()->pose(0, simulation.steps()).position.z, 0.02, 1e-4);
}

TEST(ShakenPlate, PressesWithWeightAndItsAcceleration) {
  // 10 Hz and 1 mm: 3.9 m/s2, the grain keeps its contact.
  const scene::Scene scene =
      sceneOf("[[box]]\nposition = [0, 0, -0.01]\nsize = [0.1, 0.1, 0.02]\nmaterial = \"glass\"\n"
              "amplitude = [0, 0, 1e-3]\nfrequency = 10\nphase = -90\n" +
              grainAt("[0, 0, 0.01]"));
  const auto s = made(scene, 5000);
  const double mass = base::sphereMass(2500, 0.01), omega = 20 * base::kPi;
  for (int k = 0; k < 40; ++k) {
    s->restartMeans();
    const double from = s->time();
    for (int n = 0; n < 125; ++n) s->step();
    const double mean = s->surfaces()->observe(0, s->steps()).force.z, middle = 0.5 * (from + s->time());
    const double acceleration = 1e-3 * omega * omega * base::cos(omega * middle);
    // A mean over 1/40 of the period is 0.1 % below the middle; the initial contact oscillation decays.
    EXPECT_NEAR(mean, -mass * (9.81 + acceleration), 0.01 * mass * 9.81) << middle;
  }
}

TEST(Box, TurnedIsASlopeThatABallRollsDown) {
  const double angle = base::kPi / 6;
  const scene::Scene scene =
      sceneOf("[[box]]\nposition = [0, 0, 0]\nsize = [2, 0.2, 0.04]\naxis = [0, 1, 0]\nangle = 30\n"
              "material = \"glass\"\n" +
              grainAt(fmt::format("[{}, 0, {}]", 0.03 * base::sin(angle) - 0.8 * base::cos(angle),
                                  0.03 * base::cos(angle) + 0.8 * base::sin(angle))));
  const auto s = made(scene, 20000);
  const double speed = norm(s->ground().grains->snapshot().velocity[0].as<double>());
  EXPECT_NEAR(speed, 5.0 / 7 * 9.81 * base::sin(angle) * s->time(), 0.005 * speed) << "fall shortened by rounding";
}

/// A drum with a lifter, a lid loaded by grains, a shaking plane, and a source above.
const std::string kMill = R"([[cylinder]]
name = "drum"
position = [0, 0, 0]
axis = [0, 1, 0]
radius = 0.08
length = 0.1
hollow = true
spin = [0, 8, 0]
material = "glass"
[[box]]
position = [0.07, 0, 0]
size = [0.012, 0.1, 0.02]
spin = [0, 8, 0]
pivot = [0, 0, 0]
material = "glass"
[[cylinder]]
position = [0, 0.06, 0]
axis = [0, 1, 0]
radius = 0.08
length = 0.02
free = "y"
mass = 0.5
load = -0.2
spin = [0, 8, 0]
material = "glass"
[[plane]]
point = [0, -0.05, 0]
normal = [0, 1, 0]
amplitude = [0, 0.002, 0]
frequency = 25
material = "glass"
[[source]]
low = [-0.02, -0.02, -0.03]
high = [0.02, 0.02, 0.03]
radius = 0.006
material = "glass"
velocity = [0, 0, -0.6]
number = 4
every = 0.06
total = 24
)";

TEST(Mill, ResumedRunHasTheBitsOfAStraightOneAndOfTwoThreads) {
  const scene::Scene scene = sceneOf(kMill);
  const auto straight = made(scene, 9000, 1), two = made(scene, 9000, 2);
  EXPECT_EQ(two->stateHash(), straight->stateHash());
  EXPECT_GT(std::fabs(straight->surfaces()->save().surfaces[1].work), 0) << "the lifter has done work";
  EXPECT_NE(straight->surfaces()->save().surfaces[3].offset, 0);
  for (const std::int64_t stop : {0, 4001}) {
    const auto first = made(scene, stop);
    Simulation second(setup::simulationSetup(scene), base::cpuExec(1), first->save());
    while (second.steps() < 9000) second.step();
    EXPECT_EQ(second.stateHash(), straight->stateHash()) << "stopped at " << stop;
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_EQ(second.surfaces()->observe(i, 9000).torque, straight->surfaces()->observe(i, 9000).torque);
      EXPECT_EQ(second.surfaces()->save().surfaces[i].work, straight->surfaces()->save().surfaces[i].work);
    }
  }
}

TEST(Mill, EnergyOfTheGrainsIsTheWorkOfItsSurfaces) {
  double worst[2];
  for (int half = 0; half < 2; ++half) {
    const double dt = half ? 1e-5 : 2e-5;
    const auto s = made(sceneOf(kMill, {fmt::format("run.time_step={}", dt)}), half ? 40000 : 20000);
    const Ledger l = s->ledger();
    EXPECT_GT(l.driveWork, 1e-3);
    EXPECT_GT(l.dissipated.total(), 0.3 * l.driveWork);
    worst[half] = std::fabs(l.residual) / l.driveWork;
  }
  // First order in the step: collisions at 20 steps per contact leave several per cent.
  EXPECT_LT(worst[0], 0.05);
  EXPECT_LT(worst[1], 0.04);
}

TEST(Surfaces, AreNotBuiltWhereThereAreNone) { EXPECT_EQ(made(sceneOf(grainAt("[0, 0, 0]")), 1)->surfaces(), nullptr); }

TEST(Surfaces, ResolvedCopyLoadsToTheSameScene) {
  const scene::Scene first = sceneOf(kMill + "[[box]]\nname = \"ramp\"\nposition = [1, 0, 0]\nsize = [1, 1, 0.1]\n"
                                             "orientation = [0.8, 0, 0.6, 0]\nmaterial = \"glass\"\n");
  const scene::Scene second = setup::parseScene(scene::resolvedToml(first), "copy.toml");
  EXPECT_EQ(second.planes, first.planes);
  EXPECT_EQ(second.boxes, first.boxes);
  EXPECT_EQ(second.cylinders, first.cylinders);
}

TEST(Surfaces, PicturesShowThemFromWhereGrainsAre) {
  const scene::Scene scene = sceneOf(kMill);
  const auto surfaces = setup::surfacesOf(scene);
  const setup::DrawnPlanes planes = setup::drawnPlanes(scene);
  const auto volume = [&](std::size_t i) {
    return spheredecomp::signedVolume(output::surfaceMesh(planes, surfaces[i]));
  };
  EXPECT_NO_THROW(spheredecomp::checkClosed(spheredecomp::weld(output::surfaceMesh(planes, surfaces[1])), "box"));
  EXPECT_NO_THROW(spheredecomp::checkClosed(spheredecomp::weld(output::surfaceMesh(planes, surfaces[3])), "rod"));
  EXPECT_NEAR(volume(1), 0.012 * 0.1 * 0.02, 1e-12);
  EXPECT_NEAR(volume(3), base::kPi * 0.08 * 0.08 * 0.02, 0.002 * volume(3)) << "a prism of 64 sides";
  // The wall of a drum faces inwards: without its ends the theorem yields two thirds of the volume.
  EXPECT_NEAR(volume(2), -2.0 / 3 * base::kPi * 0.08 * 0.08 * 0.1, -0.002 * volume(2));
  const base::TriangleMesh plane = output::surfaceMesh(planes, surfaces[0]);
  ASSERT_FALSE(plane.indices.empty());
  for (const Vec3d& v : plane.vertices) EXPECT_NEAR(v.z, 0, 1e-12) << "in its own frame";
}

TEST(Surfaces, OfThePairsMaterialFollowOverrides) {
  // A grain stays on a smooth belt, by the pair's own friction of 0.
  const std::string belt = "[[plane]]\nmaterial = \"belt\"\nvelocity = [1, 0, 0]\n[material.belt]\nstiffness = 1e5\n" +
                           grainAt("[0, 0, 0.01]");
  EXPECT_GT(made(sceneOf(belt), 2000)->ground().grains->snapshot().velocity[0].x, 0.05);
  EXPECT_EQ(
      made(sceneOf(belt + "[contact.\"belt|glass\"]\nfriction = 0\n"), 2000)->ground().grains->snapshot().velocity[0].x,
      0);
}

/// A block of 0.1 m with rotated edges, moving and turning below two sliding and bouncing balls.
std::string movingBlock(const std::string& head) {
  return head +
         "position = [0, 0, -0.05]\naxis = [0, 0, 1]\nangle = 20\nmaterial = \"glass\"\nname = \"block\"\n"
         "velocity = [0.05, 0, 0.02]\nspin = [0, 0, 2]\n" +
         grainAt("[0.01, 0, 0.0101]") + grainAt("[-0.02, 0.01, 0.03]");
}
std::string meshHead(double scale = 0.05) {
  return fmt::format("[[mesh]]\nfile = \"{}\"\nscale = {}\nsphere_radius = 0.004\n", cubeFile(), scale);
}

TEST(Mesh, CubeActsAsTheBoxDoes) {
  const auto mesh = made(sceneOf(movingBlock(meshHead())), 10000),
             box = made(sceneOf(movingBlock("[[box]]\nsize = [0.1, 0.1, 0.1]\n")), 10000);
  const auto a = mesh->ground().grains->snapshot(), b = box->ground().grains->snapshot();
  for (std::size_t i = 0; i < 2; ++i) {
    // Its discs are floats: 4e-9 m of 0.05 m, with overlaps of 1e-6 m; bounces amplify the difference.
    EXPECT_LT(norm(a.position[i] - b.position[i]), 2e-6) << "the path is 0.01 m";
    EXPECT_LT(norm(a.velocity[i].as<double>() - b.velocity[i].as<double>()), 1e-3 * norm(b.velocity[i].as<double>()));
  }
  EXPECT_NEAR(mesh->surfaces()->observe(0, 0).force.z, box->surfaces()->observe(0, 0).force.z, 1e-4);
  EXPECT_NEAR(mesh->ledger().driveWork, box->ledger().driveWork, 0.01 * std::fabs(box->ledger().driveWork));
}

TEST(Mesh, ResumedRunHasTheBitsOfAStraightOneAndOfTwoThreads) {
  const scene::Scene scene = sceneOf(movingBlock(meshHead()));
  const auto straight = made(scene, 5000, 1);
  EXPECT_EQ(made(scene, 5000, 2)->stateHash(), straight->stateHash());
  for (const std::int64_t stop : {0, 2500}) {
    const auto first = made(scene, stop);
    Simulation second(setup::simulationSetup(scene), base::cpuExec(1), first->save());
    while (second.steps() < 5000) second.step();
    EXPECT_EQ(second.stateHash(), straight->stateHash()) << "stopped at " << stop;
    EXPECT_EQ(second.surfaces()->observe(0, 5000).force, straight->surfaces()->observe(0, 5000).force);
  }
}

TEST(Mesh, ThatComesFromAfarMeetsAGrainThatHasNotMoved) {
  const scene::Scene scene = sceneOf(
      meshHead() + "position = [0, 0, -0.1]\nvelocity = [0, 0, 0.5]\nmaterial = \"glass\"\n" + grainAt("[0, 0, 0.01]"),
      {"run.gravity=[0,0,0]"});
  // Rebound with the restitution of 0.3.
  EXPECT_NEAR(static_cast<double>(made(scene, 6000)->ground().grains->snapshot().velocity[0].z), 0.5 * 1.3, 0.01);
}

TEST(Mesh, WhatItDoesNotGoTogetherWithIsRefused) {
  const auto refusal = [](const std::string& text) {
    try {
      made(sceneOf(text));
    } catch (const base::InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  const std::string block = movingBlock(meshHead());
  EXPECT_NE(refusal(meshHead() + "material = \"glass\"\n" + grainAt("[0, 0, 0.02]")).find("overlaps mesh 0"),
            std::string::npos);
  EXPECT_NE(
      refusal(block + meshHead() + "material = \"wood\"\n[material.wood]\n").find("use one material for all meshes"),
      std::string::npos);
  EXPECT_NE(refusal(movingBlock("[[mesh]]\nfile = \"nosuch.obj\"\n")).find("does not exist"), std::string::npos);
  EXPECT_NE(refusal(movingBlock("[[mesh]]\nfile = \"heightmaps/hills.png\"\n")).find("cannot be used"),
            std::string::npos);
  EXPECT_NE(refusal(movingBlock(meshHead(1e-3))).find("sphere_radius"), std::string::npos);
}

struct Fault {
  std::string key, value, says;
};
TEST(Surfaces, WhatCannotBeIsRefusedByName) {
  const std::string lid = kPress + "[[cylinder]]\nposition = [0, 0, 1]\nradius = 0.1\nlength = 1\nhollow = true\n"
                                   "material = \"glass\"\n";
  const Fault faults[] = {
      {"box.lid.size", "[0.1,-0.1,0.1]", "is outside"},
      {"box.lid.velocity", "[0,0,0.1]", "the free axis"},
      {"box.lid.amplitude", "[0,0,0.1]", "frequency [Hz] is missing"},
      {"box.lid.frequency", "3", "has no effect without amplitude"},
      {"box.lid.placed", "after_settling", "has no effect without a bed of grains"},
      {"box.lid.above_bed", "0.1", "has no effect without a bed of grains"},
      {"box.lid.pivot", "[1,0,0]", "has no effect without spin"},
      {"box.lid.start", "1.0", "on a fixed surface"},
      {"box.lid.free", "w", "x, y, z"},
      {"box.lid.angle", "3", "requires axis"},
      {"box.lid.material", "cheese", "is not a material"},
      {"box.lid.name", "floor", "the name of another surface"},
      {"box.lid.name", "my lid", "must not contain blanks"},
      {"box.lid.mass", "0", "is outside"},
      {"plane.floor.load", "3", "applies to free surfaces only"},
      {"plane.floor.normal", "[0,0,0]", "has zero length"},
      {"plane.floor.name", "cylinder0", "is the default name of another surface"},
      {"cylinder.0.radius", "0.009", "of a hollow cylinder must exceed"},
  };
  for (const Fault& f : faults) {
    try {
      sceneOf(lid, {f.key + "=" + f.value});
      ADD_FAILURE() << f.key << " = " << f.value << " was accepted";
    } catch (const base::InputError& error) {
      EXPECT_NE(std::string(error.what()).find(f.says), std::string::npos) << f.key << ": " << error.what();
    }
  }
}

} // namespace
} // namespace grouser::coupling
