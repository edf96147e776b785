// SPDX-License-Identifier: BSD-3-Clause
// Bodies of mechanisms that touch grains: closed forms, energy balance, and rejected scenes.
#include "base/error.hpp"
#include "base/math.hpp"
#include "contact/surface_geometry.hpp"
#include "coupling/simulation.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/free_surface_notes.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/setup/simulation_setup.hpp"
#include "runs/setup/step_limit.hpp"
#include "tests/message_of.hpp"
#include "tests/system/scene_simulation.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>

namespace grouser::coupling {
namespace {

using base::Vec3d;

std::string head(const std::string& run, const std::string& more = {}) {
  return "version = 1\n[run]\nduration = 1.0\nprecision = \"double\"\nthreads = 1\n" + run +
         "\n[material.glass]\nstiffness = 1e5\nrestitution = 0.5\nfriction = 0.4\n" + more;
}

std::string grain(const std::string& position, const std::string& more = {}) {
  return fmt::format("[[grain]]\nposition = {}\nradius = 0.01\nmaterial = \"glass\"\n{}\n", position, more);
}

/// A free cube of 0.1 m.
std::string cube(const std::string& position, double mass, const std::string& more = {}) {
  return fmt::format("[[body]]\nname = \"cube\"\nmass = {}\nbox = [0.1, 0.1, 0.1]\nposition = {}\nmaterial = "
                     "\"glass\"\n{}\n[[body.shape]]\nkind = \"box\"\nsize = [0.1, 0.1, 0.1]\n",
                     mass, position, more);
}

/// Four fixed grains in a square that support a cube.
std::string feet() {
  std::string all;
  for (const char* place : {"[-0.03, -0.03, 0]", "[0.03, -0.03, 0]", "[-0.03, 0.03, 0]", "[0.03, 0.03, 0]"})
    all += grain(place, "fixed = true");
  return all;
}

TEST(ShapeGap, CapsuleIsTheNearestPointOfItsSegment) {
  const contact::SurfaceGeometry capsule{contact::SurfaceShape::capsule, {0.3, 0, 0.5}};
  std::mt19937 dice(1);
  std::uniform_real_distribution<double> any(-1.5, 1.5);
  for (int k = 0; k < 200; ++k) {
    const Vec3d p{any(dice), any(dice), any(dice)};
    const contact::SurfaceGap gap = gapTo(capsule, p);
    double nearest = 1e9; // the segment is sampled every 1e-3
    for (int i = -500; i <= 500; ++i) nearest = std::min(nearest, norm(p - Vec3d{0, 0, i * 1e-3}));
    EXPECT_NEAR(gap.distance, nearest - 0.3, 1e-5);
    EXPECT_NEAR(norm(gap.normal), 1, 1e-12);
    // The surface point is on the surface.
    EXPECT_NEAR(gapTo(capsule, p - gap.normal * gap.distance).distance, 0, 1e-12);
  }
}

TEST(Bodies, WeightIsTheMeanContactForceAtRest) {
  const auto s = simulationOf(head("time_step = 2e-5") + feet() + cube("[0, 0, 0.0599]", 2));
  advanceTo(*s, 0.5);
  s->restartMeans();
  advanceTo(*s, 0.6);
  const Vec3d force = s->mechanism()->contactForces()[0];
  EXPECT_NEAR(force.z, 2 * 9.81, 1e-3 * 2 * 9.81);
  EXPECT_LT(std::hypot(force.x, force.y), 1e-3 * 2 * 9.81);
  // Each foot carries a quarter: overlap = m g / (4 k).
  EXPECT_NEAR(s->mechanism()->state().pose[0].position.z, 0.06 - 2 * 9.81 / 4e5, 1e-7);
}

/// A body so heavy that it acts as a wall: the law uses the grain's mass, as for all parts.
TEST(Bodies, ABallBouncesOffAGrainAsTheLawSays) {
  const double radius = 0.01, mass = 2500 * 4.0 / 3 * base::kPi * radius * radius * radius;
  const auto rebound = [&](double step) {
    const auto s = simulationOf(
        head(fmt::format("gravity = [0, 0, 0]\ntime_step = {}", step), "density = 2500\n") + grain("[0, 0, 0]") +
        fmt::format("[[body]]\nname = \"ball\"\nmass = {}\ninertia = [1e-6, 1e-6, 1e-6]\nposition = "
                    "[0.021, 0, 0]\nvelocity = [-0.5, 0, 0]\nmaterial = \"glass\"\n[[body.shape]]\n"
                    "kind = \"sphere\"\nradius = 0.01\n",
                    1e6 * mass));
    advanceTo(*s, 0.02);
    const Vec3d body = s->mechanism()->state().twist[0].v;
    const terrain::GrainSnapshot g = s->ground().grains->snapshot();
    const double before = 0.5;
    return (body.x - static_cast<double>(g.velocity[0].x)) / before;
  };
  const double coarse = rebound(1e-5), fine = rebound(2.5e-6);
  EXPECT_NEAR(fine, 0.5, 0.004);
  EXPECT_LT(std::fabs(fine - 0.5), 0.6 * std::fabs(coarse - 0.5) + 2e-4);
}

TEST(Bodies, MomentumOfBodyAndGrainsIsConservedToRounding) {
  std::string grains;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) grains += grain(fmt::format("[{}, {}, 0]", 0.021 * i, 0.021 * j));
  const auto s = simulationOf(head("gravity = [0, 0, 0]\ntime_step = 1e-5") + grains +
                              cube("[0.015, 0.025, 0.08]", 0.05, "velocity = [0.3, 0, -2]\nspin = [5, 3, 0]"));
  const Vec3d linear = s->ledger().momentum, angular = s->ledger().angularMomentum;
  advanceTo(*s, 0.05);
  const Ledger l = s->ledger();
  EXPECT_GT(l.dissipated.total(), 1e-3) << "they have collided";
  EXPECT_LT(norm(l.momentum - linear), 1e-9 * norm(linear));
  EXPECT_LT(norm(l.angularMomentum - angular), 1e-6 * norm(angular)) << "torques on grains have single precision";
  EXPECT_EQ(l.impulseResidual, Vec3d{}) << "integers";
  EXPECT_LT(std::fabs(l.residual), 1e-9 * l.turnover);
}

TEST(Bodies, IntegrationErrorFallsWithTheStep) {
  const auto errorAt = [](double step) {
    const auto s = simulationOf(head(fmt::format("time_step = {}", step)) + feet() + cube("[0, 0, 0.08]", 2));
    advanceTo(*s, 0.15);
    const Ledger l = s->ledger();
    EXPECT_LT(std::fabs(l.residual), 1e-9 * l.turnover);
    return std::fabs(l.integrationError);
  };
  EXPECT_LT(errorAt(1e-5), 0.5 * errorAt(4e-5));
}

TEST(Bodies, APendulumLosesToGrainsWhatTheLedgerSays) {
  std::string grains;
  for (int i = -2; i <= 2; ++i) grains += grain(fmt::format("[{}, 0, 0.01]", 0.0205 * i));
  const auto s =
      simulationOf(head("time_step = 1e-5") + "[[plane]]\nnormal = [0, 0, 1]\nmaterial = \"glass\"\n" + grains +
                   cube("[0.15, 0, 0.22]", 0.5) +
                   "[[joint]]\nname = \"hinge\"\ntype = \"revolute\"\nbodies = [\"world\", \"cube\"]\npoint = "
                   "[0, 0, 0.22]\naxis = [0, 1, 0]\n");
  advanceTo(*s, 0.6);
  const Ledger l = s->ledger();
  EXPECT_GT(l.dissipated.ofGrains(), 0.02);
  EXPECT_NEAR(l.kinetic + l.potential + l.elastic + l.dissipated.total() + l.integrationError, 0, 1e-9 * l.turnover);
  EXPECT_LT(std::fabs(l.integrationError), 0.02 * l.dissipated.total());
}

TEST(Bodies, LoadsFromOutsideActBesideContacts) {
  const auto s = simulationOf(head("time_step = 2e-5") + feet() + cube("[0, 0, 0.0599]", 2));
  s->set({{0, InputKind::bodyLoad, 0, false, {0, 0, -10, 0, 0, 0}}});
  advanceTo(*s, 0.5);
  s->restartMeans();
  advanceTo(*s, 0.6);
  EXPECT_NEAR(s->mechanism()->contactForces()[0].z, 2 * 9.81 + 10, 1e-3 * 29.62);
}

TEST(Bodies, LightBodiesAskForAShorterStep) {
  const auto step = [](double mass) {
    return setup::stepLimit(setup::parseScene(head("") + feet() + cube("[0, 0, 0.06]", mass), "scene.toml")).step;
  };
  EXPECT_EQ(step(1000), step(100));
  EXPECT_LT(step(0.001), 0.7 * step(100));
  // A plate of 1 g at the allowed step comes to rest.
  const auto s = simulationOf(head("") + feet() + cube("[0, 0, 0.0605]", 0.001));
  advanceTo(*s, 0.4);
  EXPECT_LT(norm(s->mechanism()->state().twist[0].v), 1e-4);
}

TEST(Bodies, OverlapWithAGrainAtTheStartIsRefused) {
  const std::string message = test::messageOf([] { simulationOf(head("") + feet() + cube("[0, 0, 0.05]", 1)); });
  EXPECT_NE(message.find("body \"cube\" overlaps grain 0 of radius 0.01 m"), std::string::npos) << message;
  const std::string beside = test::messageOf([] {
    simulationOf(head("") + grain("[0, 0, 0]") +
                 "[[body]]\nname = \"arm\"\nmass = 1\ninertia = [1, 1, 1]\nposition = [1, 0, 0]\nmaterial = \"glass\"\n"
                 "[[body.shape]]\nkind = \"sphere\"\nradius = 0.1\nposition = [-0.9, 0, 0]\n");
  });
  EXPECT_NE(beside.find("body \"arm\" overlaps"), std::string::npos) << beside;
}

TEST(Bodies, FastBodiesAreRefusedOrStopTheRun) {
  const std::string fast = test::messageOf([] {
    simulationOf(head("time_step = 1e-4") + grain("[0, 0, 0]") + cube("[0, 0, 0.2]", 1, "velocity = [0, 0, -60]"));
  });
  EXPECT_NE(fast.find("body.0.velocity"), std::string::npos) << fast;
  const auto s = simulationOf(head("time_step = 1e-4") + grain("[0, 0, 0]") + cube("[0, 0, 100]", 1));
  s->set({{0, InputKind::bodyLoad, 0, false, {0, 0, -1e4, 0, 0, 0}}}); // 50 m/s are reached after 5 ms
  try {
    advanceTo(*s, 0.02);
    FAIL() << "a body went faster than half a radius a step";
  } catch (const base::SimulationError& error) {
    EXPECT_EQ(error.cause(), base::Cause::thrownPart);
    EXPECT_NEAR(s->time(), 0.005, 2e-4);
  }
}

TEST(Bodies, NotesNameWhatBodiesPassThroughAndLightBodies) {
  const auto sceneOf = [](const std::string& text) { return setup::parseScene(text, "scene.toml"); };
  const scene::Scene alone = sceneOf(head("") + grain("[0, 0, 0]") + cube("[0, 0, 0.2]", 1));
  EXPECT_EQ(setup::movingSurfacesWarning(alone), "");
  EXPECT_EQ(setup::bedWallsNote(alone), "");
  EXPECT_TRUE(setup::freeSurfaceNotes(alone).empty());
  const scene::Scene dense = sceneOf(head("", "density = 2500\n") + grain("[0, 0, 0]") +
                                     "[[body]]\nname = \"ball\"\nposition = [0, 0, 0.2]\nmaterial = \"glass\"\n"
                                     "[[body.shape]]\nkind = \"sphere\"\nradius = 0.05\n");
  EXPECT_TRUE(setup::freeSurfaceNotes(dense).empty()) << "its shape determines its mass";
  const scene::Scene light = sceneOf(head("") + grain("[0, 0, 0]") + cube("[0, 0, 0.2]", 0.01) +
                                     "[[plane]]\nnormal = [0, 0, 1]\nmaterial = \"glass\"\nvelocity = [0, 0, -0.1]\n");
  EXPECT_EQ(setup::movingSurfacesWarning(light), "bodies pass through planes, boxes, cylinders and meshes that move, "
                                                 "which have contact with grains only; use a driven [[body]] instead");
  EXPECT_EQ(setup::bedWallsNote(light), "");
  ASSERT_EQ(setup::freeSurfaceNotes(light).size(), 1u);
  EXPECT_NE(setup::freeSurfaceNotes(light)[0].find("body \"cube\" has a mass of 0.01 kg"), std::string::npos);
}

TEST(Bodies, ShippedScenesOfBodiesOnBedsDoNotWarn) {
  for (const char* name : {"blade", "cone", "boulder", "bucket", "rover"}) {
    const scene::Scene scene = setup::loadScene(std::string(GROUSER_SOURCE_DIR) + "/runs/scenes/" + name + ".toml");
    EXPECT_EQ(setup::movingSurfacesWarning(scene), "") << name;
    EXPECT_NE(setup::bedWallsNote(scene).find("keep bodies inside the bed, or add a fixed [[body]]"), std::string::npos)
        << name;
  }
}

TEST(Bodies, PeriodicSidesAreRefused) {
  const std::string message = test::messageOf([] {
    setup::parseScene(head("periodic = [true, false]\ndomain_x = [-1, 1]") + grain("[0, 0, 0]") +
                          cube("[0, 0, 0.2]", 1),
                      "scene.toml");
  });
  EXPECT_NE(message.find("run.periodic"), std::string::npos) << message;
}

TEST(Bodies, BadShapesAreRefusedAtTheirPlace) {
  const auto refused = [](const std::string& shape, const std::string& body = "material = \"glass\"") {
    return test::messageOf([&] {
      setup::parseScene(head("") + grain("[0, 0, 0]") + "[[body]]\nname = \"b\"\nmass = 1\ninertia = [1, 1, 1]\n" +
                            body + "\n[[body.shape]]\n" + shape,
                        "scene.toml");
    });
  };
  const auto says = [](const std::string& message, const std::string& words) {
    EXPECT_NE(message.find(words), std::string::npos) << message;
    EXPECT_NE(message.find("scene.toml:"), std::string::npos) << message;
  };
  says(refused("kind = \"sphere\""), "shape.0.radius");
  says(refused("kind = \"box\"\nradius = 1"), "shape.0.size [m] is missing");
  says(refused("kind = \"cylinder\"\nradius = 1"), "shape.0.length [m] is missing");
  says(refused("kind = \"sphere\"\nradius = 1\nsize = [1, 1, 1]"), "shape.0.size");
  says(refused("kind = \"sphere\"\nradius = 0"), "outside (0");
  says(refused("kind = \"ball\"\nradius = 1"), "sphere");
  says(refused("kind = \"sphere\"\nradius = 1\naxis = [0, 0, 1]"), "does not apply to a sphere");
  says(refused("kind = \"capsule\"\nradius = 1\nlength = 1\naxis = [0, 0, 0]"), "has zero length");
  says(refused("kind = \"capsule\"\nradius = 1\nlength = 1\nangle = 3"), "does not apply to a capsule");
  says(refused("kind = \"box\"\nsize = [1, 1, 1]\nangle = 3"), "both or neither");
  says(refused("kind = \"sphere\"\nradius = 1\ncolour = 3"), "colour");
  says(test::messageOf(
           [] { setup::parseScene(head("integrator = \"rattle\"") + feet() + cube("[0, 0, 0.06]", 1), "scene.toml"); }),
       "run.integrator");
  says(refused("kind = \"sphere\"\nradius = 1", ""), "material is missing");
  says(refused("kind = \"sphere\"\nradius = 1", "material = \"brass\""), "brass");
  EXPECT_NE(test::messageOf([] {
              setup::parseScene(head("") + grain("[0, 0, 0]") +
                                    "[[body]]\nname = \"b\"\nmass = 1\npoint = true\nmaterial = \"glass\"\n"
                                    "[[body.shape]]\nkind = \"sphere\"\nradius = 1\n",
                                "scene.toml");
            }).find("body.0.point"),
            std::string::npos);
}

} // namespace
} // namespace grouser::coupling
