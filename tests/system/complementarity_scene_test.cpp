// SPDX-License-Identifier: BSD-3-Clause
// Whole scenes with complementarity contacts: force-driven and rotating surfaces, and beds.
#include "base/math.hpp"
#include "coupling/simulation.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/setup/simulation_setup.hpp"
#include "tests/device_under_test.hpp"
#include "tests/system/cube_file.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>

namespace grouser {
namespace {

coupling::Simulation made(const std::string& text, int threads = 2) {
  return coupling::Simulation(setup::simulationSetup(setup::parseScene(text, "scene.toml")), testExec(threads),
                              [](double, double) {});
}

/// Nine balls in a square on a plane, under a plate that is free to fall.
std::string underPlate(double mass, const std::string& method, double cohesion = 0) {
  return "version = 1\n[run]\nduration = 1\ncontact = \"" + method +
         "\"\n[material.glass]\ndensity = 2500\nstiffness = 1e5\nrestitution = 0.2\nfriction = 0.5\ncohesion = " +
         std::to_string(cohesion) +
         "\n[[plane]]\npoint = [0, 0, 0]\nnormal = [0, 0, 1]\nmaterial = \"glass\"\n"
         "[[grains]]\nform = \"lattice\"\nlow = [-0.04, -0.04, 0]\nhigh = [0.04, 0.04, 0.0225]\nradius = 0.01\n"
         "spacing = 2.2\nmaterial = \"glass\"\n"
         "[[box]]\nname = \"plate\"\nposition = [0, 0, 0.03]\nsize = [0.1, 0.1, 0.01]\nmaterial = \"glass\"\n"
         "free = \"z\"\nmass = " +
         std::to_string(mass) + "\n";
}

TEST(ComplementarityScene, APlateLiesOnGrainsWithItsWeightHoweverLight) {
  // Lighter and heavier than a ball (0.01 kg). Staggered coupling would diverge for the light plate.
  for (const auto& [mass, cohesion] : {std::pair{0.005, 0.0}, {1.0, 0.0}, {0.05, 0.2}}) {
    coupling::Simulation s = made(underPlate(mass, "complementarity", cohesion));
    while (s.time() < 0.4) s.step();
    s.restartMeans();
    for (int k = 0; k < 20; ++k) s.step();
    const auto plate = s.surfaces()->observe(0, s.steps());
    EXPECT_NEAR(plate.force.z, 9.81 * mass, 0.002 * 9.81 * mass) << mass;
    EXPECT_NEAR(plate.position.z, 0.025, 2e-4) << mass;
    EXPECT_EQ(s.ground().grains->system().impulses->totals().missed, 0);
    const coupling::Ledger l = s.ledger();
    EXPECT_NEAR(l.residual, 0, 1e-6 * l.turnover);
    EXPECT_LT(norm(l.momentumResidual), 1e-5 * mass * 9.81 * s.time());
  }
}

/// Runs a scene uninterrupted and resumed, and compares states and solver totals.
void expectResumes(const std::string& text) {
  coupling::Simulation whole = made(text), first = made(text, 1);
  while (first.steps() < 60) first.step();
  coupling::Simulation resumed(first.setup(), testExec(2), first.save());
  while (whole.steps() < 130) whole.step();
  while (resumed.steps() < 130) resumed.step();
  EXPECT_EQ(resumed.stateHash(), whole.stateHash());
  const auto& a = resumed.ground().grains->system().impulses->totals();
  const auto& b = whole.ground().grains->system().impulses->totals();
  EXPECT_EQ(a.words(), b.words());
}

TEST(ComplementarityScene, ResumesToTheSameBits) { expectResumes(underPlate(0.05, "complementarity")); }

/// Replaces the plate by a body.
std::string underBody(double mass, const std::string& body, const std::string& joint = "") {
  std::string text = underPlate(1, "complementarity");
  text.replace(text.find("[[box]]"), std::string::npos,
               "[[body]]\nname = \"plate\"\nmaterial = \"glass\"\nmass = " + std::to_string(mass) + "\n" + body +
                   joint);
  return text;
}
const char* const kFreeBox = "box = [0.1, 0.1, 0.01]\nposition = [0, 0, 0.03]\n[[body.shape]]\nkind = \"box\"\n"
                             "size = [0.1, 0.1, 0.01]\n";

TEST(ComplementarityScene, ABodyLiesOnGrainsWithItsWeightHoweverLight) {
  for (const double mass : {0.005, 1.0}) { // a ball has 0.01 kg
    coupling::Simulation s = made(underBody(mass, kFreeBox));
    while (s.time() < 0.4) s.step();
    s.restartMeans();
    for (int k = 0; k < 20; ++k) s.step();
    EXPECT_NEAR(s.mechanism()->contactForces()[0].z, 9.81 * mass, 0.002 * 9.81 * mass) << mass;
    EXPECT_NEAR(s.mechanism()->state().pose[0].position.z, 0.025, 2e-4) << mass;
    EXPECT_EQ(s.ground().grains->system().impulses->totals().missed, 0);
    const coupling::Ledger l = s.ledger();
    EXPECT_NEAR(l.residual, 0, 1e-6 * l.turnover);
    EXPECT_LT(norm(l.momentumResidual), 1e-5 * mass * 9.81 * s.time());
    EXPECT_LT(norm(l.angularResidual), 1e-6 * mass * 9.81 * s.time());
    EXPECT_LT(norm(l.impulseResidual), 1e-12 * mass * 9.81 * s.time());
  }
}

TEST(ComplementarityScene, AHingedLeverPressesWithItsMoment) {
  // A bar of 0.2 m rests on the balls, hinged at x = -0.1 m. Its weight has the moment m g 0.1 m about the hinge.
  coupling::Simulation s = made(underBody(2,
                                          "box = [0.2, 0.06, 0.01]\nposition = [0, 0, 0.025]\n[[body.shape]]\nkind = "
                                          "\"box\"\nsize = [0.2, 0.06, 0.01]\n",
                                          "[[joint]]\nname = \"hinge\"\ntype = \"revolute\"\nbodies = [\"world\", "
                                          "\"plate\"]\npoint = [-0.1, 0, 0.025]\naxis = [0, 1, 0]\n"));
  while (s.time() < 0.4) s.step();
  s.restartMeans();
  for (int k = 0; k < 20; ++k) s.step();
  const base::Vec3d force = s.mechanism()->contactForces()[0], hinge = s.mechanism()->state().joint[0].force;
  EXPECT_NEAR(force.z + hinge.z, 9.81 * 2, 0.01);
  // The force is between the forces of the far column only (x = 0.022 m) and the near column only (-0.022 m).
  EXPECT_GT(force.z, 9.81 * 2 * 0.1 / 0.123);
  EXPECT_LT(force.z, 9.81 * 2 * 0.1 / 0.077);
  const coupling::Ledger l = s.ledger();
  EXPECT_NEAR(l.residual, 0, 1e-5 * l.turnover);
}

TEST(ComplementarityScene, AHingedBarThrowsABallByItsMomentOfInertia) {
  // A bar of 20 g swings about its end, without friction and gravity, and hits a ball of mass m at rest at a distance a
  // from the hinge: the ball leaves at (1 + e) w a I / (I + m a^2), with the moment of inertia I about the hinge.
  const double w = 2, e = 0.5, a = 0.15, mass = 0.02, radius = 0.01;
  coupling::Simulation s = made(
      "version = 1\n[run]\nduration = 1\ncontact = \"complementarity\"\ngravity = [0, 0, 0]\nresidual = 1e-8\n"
      "time_step = 1e-4\nprecision = \"double\"\n[material.glass]\ndensity = 2500\nstiffness = 1e5\nrestitution = 0.5\n"
      "friction = 0\n[[grain]]\nposition = [0.05, 0.0152, 0]\nradius = 0.01\nmaterial = \"glass\"\n"
      "[[body]]\nname = \"bar\"\nmaterial = \"glass\"\nmass = 0.02\nbox = [0.2, 0.01, 0.06]\nposition = [0, 0, 0]\n"
      "velocity = [0, 0.2, 0]\nspin = [0, 0, 2]\n[[body.shape]]\nkind = \"box\"\nsize = [0.2, 0.01, 0.06]\n"
      "[[joint]]\nname = \"hinge\"\ntype = \"revolute\"\nbodies = [\"world\", \"bar\"]\npoint = [-0.1, 0, 0]\n"
      "axis = [0, 0, 1]\n");
  for (int k = 0; k < 20; ++k) s.step();
  const double inertia = mass * ((0.2 * 0.2 + 0.01 * 0.01) / 12 + 0.1 * 0.1);
  const double ball = 2500 * 4 / 3.0 * base::kPi * radius * radius * radius;
  const double expected = (1 + e) * w * a * inertia / (inertia + ball * a * a);
  EXPECT_NEAR(s.ground().grains->snapshot().velocity[0].y, expected, 2e-3 * expected);
  const coupling::Ledger l = s.ledger();
  EXPECT_NEAR(l.residual, 0, 1e-6 * l.turnover);
}

TEST(ComplementarityScene, ALoadedMeshSinksAsABoxDoes) {
  const auto cube = [](const std::string& kind) {
    std::string text = underPlate(0.4, "complementarity");
    const std::size_t box = text.find("[[box]]\nname = \"plate\"\nposition = [0, 0, 0.03]\nsize = [0.1, 0.1, 0.01]");
    return text.substr(0, box) + kind + "position = [0, 0, 0.072]\n" + text.substr(text.find("material", box));
  };
  coupling::Simulation box = made(cube("[[box]]\nsize = [0.1, 0.1, 0.1]\n")),
                       mesh =
                           made(cube("[[mesh]]\nfile = \"" + cubeFile() + "\"\nscale = 0.05\nsphere_radius = 0.004\n"));
  for (coupling::Simulation* s : {&box, &mesh}) {
    while (s->time() < 0.4) s->step();
    s->restartMeans();
    for (int k = 0; k < 20; ++k) s->step();
    EXPECT_NEAR(s->surfaces()->observe(0, s->steps()).force.z, 9.81 * 0.4, 0.01);
    EXPECT_EQ(s->ground().grains->system().impulses->totals().missed, 0);
    const coupling::Ledger l = s->ledger();
    EXPECT_NEAR(l.residual, 0, 1e-6 * l.turnover);
  }
  EXPECT_NEAR(mesh.surfaces()->pose(0, mesh.steps()).position.z, box.surfaces()->pose(0, box.steps()).position.z, 1e-4);
}

TEST(ComplementarityScene, ABodyThatFallsOnGrainsResumesToTheSameBits) { expectResumes(underBody(0.05, kFreeBox)); }

/// Spheres of Hertz contacts, Young's modulus [Pa], that start just in contact, one above the other on a plane.
std::string hertzColumn(double young, int count) {
  std::string text = fmt::format(
      "version = 1\n[run]\nduration = 1\ncontact = \"complementarity\"\nprecision = \"double\"\nresidual = 1e-7\n"
      "[complementarity]\niterations = 5000\n[material.a]\ndensity = 2500\nlaw = \"hertz\"\nyoung = {}\n"
      "poisson = 0.25\nrestitution = 0.1\nfriction = 0.5\n[[plane]]\nmaterial = \"a\"\n",
      young);
  for (int k = 0; k < count; ++k)
    text += fmt::format("[[grain]]\nposition = [0, 0, {}]\nradius = 0.01\nmaterial = \"a\"\n", 0.01 + 0.02 * k);
  return text;
}

TEST(ComplementarityScene, HertzContactsRestAtTheirStaticOverlapAtAnyStep) {
  // Overlap of the load F on two spheres (or a plane): (F / (4/3 E* sqrt R*))^(2/3).
  const double radius = 0.01, weight = 2500 * 4 / 3.0 * base::kPi * radius * radius * radius * 9.81;
  for (const double young : {1e7, 1e8, 1e9, 1e10})
    for (const int count : {1, 4}) {
      coupling::Simulation s = made(hertzColumn(young, count));
      while (s.time() < 0.5) s.step();
      EXPECT_NO_THROW(s.checkEnergy()) << young;
      const double modulus = 4 / 3.0 * young / (2 * (1 - 0.25 * 0.25));
      const auto overlap = [&](int carried, double effective) {
        return std::pow(carried * weight / (modulus * std::sqrt(effective)), 2 / 3.0);
      };
      // Positions have a resolution of 1e-8 diameters, and the residual moves a grain by 1.4e-10 m per step.
      const double accuracy = 1e-9;
      const auto z = [&, found = s.ground().grains->snapshot()](int k) {
        return found.position[static_cast<std::size_t>(k)].z;
      };
      EXPECT_NEAR(radius - z(0), overlap(count, radius), accuracy) << young;
      for (int k = 1; k < count; ++k)
        EXPECT_NEAR(2 * radius - (z(k) - z(k - 1)), overlap(count - k, 0.5 * radius), accuracy) << young << " " << k;
      EXPECT_EQ(s.ground().grains->system().impulses->totals().missed, 0);
      // The energy of n Hertz springs: 2/5 of load times overlap.
      double elastic = 0.4 * count * weight * overlap(count, radius);
      for (int k = 1; k < count; ++k) elastic += 0.4 * (count - k) * weight * overlap(count - k, 0.5 * radius);
      EXPECT_NEAR(s.ledger().elastic, elastic, 0.01 * elastic + 1e-9 * weight);
    }
}

/// A ball that rolls between two Hertz contacts, under a lid that moves and presses.
std::string underLid(const std::string& run) {
  return "version = 1\n[run]\nduration = 0.1\nprecision = \"double\"\nmax_overlap = 0.5\n" + run +
         "[material.a]\ndensity = 2500\nlaw = \"hertz\"\nyoung = 2e6\nrestitution = 0.5\nfriction = 0.3\n"
         "rolling_friction = 0.05\n[material.l]\ndensity = 2500\nlaw = \"hertz\"\nyoung = 2e6\nrestitution = 0.5\n"
         "friction = 0.03\nrolling_friction = 0.05\n"
         "[[box]]\nname = \"fl\"\nposition = [0, 0, -0.05]\nsize = [1, 1, 0.1]\nmaterial = \"a\"\n"
         "[[box]]\nname = \"lid\"\nposition = [0, 0, 0.06980]\nsize = [1, 1, 0.1]\nmaterial = \"l\"\n"
         "velocity = [0.05, 0.02, -0.002]\n"
         "[[grain]]\nposition = [0, 0, 0.0099]\nradius = 0.01\nmaterial = \"a\"\n";
}

TEST(ComplementarityScene, SpringsOfHertzContactsFollowTheirStiffnessAsWithPenaltyContacts) {
  coupling::Simulation explicitly = made(underLid("time_step = 4e-6\n"), 1),
                       solved = made(underLid("contact = \"complementarity\"\ntime_step = 1e-4\nresidual = 1e-8\n"
                                              "[complementarity]\niterations = 5000\n"),
                                     1);
  for (coupling::Simulation* s : {&explicitly, &solved})
    while (s->time() < 0.1 - 1e-9) s->step();
  const base::Vec3d a = explicitly.ground().grains->snapshot().position[0],
                    b = solved.ground().grains->snapshot().position[0];
  // Both are of first order in the step: the springs alone change this distance by a tenth.
  EXPECT_NEAR(a.x, 5.86e-4, 1e-6);
  EXPECT_NEAR(b.x, a.x, 1e-3 * a.x);
  EXPECT_NEAR(b.y, a.y, 1e-3 * a.x);
  const coupling::Dissipated x = explicitly.ledger().dissipated, y = solved.ledger().dissipated;
  EXPECT_NEAR(y.rolling, x.rolling, 0.01 * x.rolling);
  EXPECT_NEAR(y.microSlip, x.microSlip, 0.1 * x.microSlip);
  EXPECT_NEAR(y.total(), x.total(), 0.01 * x.total());
}

TEST(ComplementarityScene, TheDashpotOfRollingHeats) {
  // A ball rolls to and fro on its rolling spring until the dashpots have taken its energy, 7/10 m v^2.
  coupling::Simulation s =
      made("version = 1\n[run]\nduration = 0.03\ncontact = \"complementarity\"\ntime_step = 2e-5\n"
           "precision = \"double\"\nresidual = 1e-9\n[complementarity]\niterations = 3000\n[material.a]\n"
           "density = 2500\nstiffness = 1e5\nrestitution = 0.3\nfriction = 0.9\nrolling_friction = 0.3\n"
           "[[plane]]\nmaterial = \"a\"\n[[grain]]\nposition = [0, 0, 0.009998972699202276]\n"
           "velocity = [0.001, 0, 0]\nspin = [0, 0.1, 0]\nradius = 0.01\nmaterial = \"a\"\n",
           1);
  while (s.time() < 0.03 - 1e-9) s.step();
  const double energy = 0.7 * 2500 * 4 / 3.0 * base::kPi * 1e-6 * 1e-6;
  const coupling::Ledger l = s.ledger();
  EXPECT_NEAR(l.kinetic, -energy, 1e-3 * energy);
  EXPECT_NEAR(l.dissipated.rolling + l.dissipated.damping, energy, 0.06 * energy) << "the step resolves the motion";
  EXPECT_NEAR(l.dissipated.rolling, 5.0e-9, 0.1e-9) << "as with penalty contacts, without the shear dashpot's share";
  EXPECT_NEAR(l.integrationError, 0, 0.06 * energy);
}

TEST(ComplementarityScene, ABedSettlesAsWithPenaltyContacts) {
  const auto bed = [](const std::string& method) {
    return "version = 1\n[run]\nduration = 0.2\ncontact = \"" + method +
           "\"\n[material.soil]\ndensity = 2500\nstiffness = 1e6\nrestitution = 0.3\nfriction = 0.5\n"
           "[terrain]\nheightmap = \"" GROUSER_SOURCE_DIR "/assets/heightmaps/flat.png\"\nsize = [0.8, 0.8]\n"
           "height_range = [0, 0]\nmaterial = \"soil\"\ngrain_radius = 0.04\ndepth = 0.25\n"
           "settle_time_limit = 4\ncache = false\n";
  };
  coupling::Simulation explicitly = made(bed("penalty")), solved = made(bed("complementarity"));
  ASSERT_EQ(explicitly.ground().structure->porosity, solved.ground().structure->porosity);
  const double before = solved.ledger().potential;
  while (solved.time() < 0.1) solved.step();
  // A body at rest stays in place, with the springs of the restored state.
  EXPECT_LT(solved.ledger().fastestGrain, 0.01);
  const double weight = static_cast<double>(solved.ground().grains->count()) * 2500 * 4.19 * 0.04 * 0.04 * 0.04 * 9.81;
  EXPECT_NEAR(solved.ledger().potential, before, weight * 1e-4);
  EXPECT_EQ(solved.ground().grains->system().impulses->totals().missed, 0);
}

} // namespace
} // namespace grouser
