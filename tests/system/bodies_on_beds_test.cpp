// SPDX-License-Identifier: BSD-3-Clause
// Bodies placed on a settled bed, their masses from shapes, and grain counts: closed forms and rejected scenes.
#include "base/comm.hpp"
#include "base/error.hpp"
#include "base/math.hpp"
#include "contact/surface_geometry.hpp"
#include "coupling/body_probes.hpp"
#include "coupling/simulation.hpp"
#include "runs/output/surface_mesh.hpp"
#include "runs/scene/scene.hpp"
#include "runs/session/row_columns.hpp"
#include "runs/setup/body_mass.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/setup/mechanism_setup.hpp"
#include "runs/setup/record_setup.hpp"
#include "runs/setup/simulation_setup.hpp"
#include "tests/message_of.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>

namespace grouser::coupling::on_beds {
namespace {

using base::kPi;
using base::Vec3d;
using contact::SurfaceGeometry;
using contact::SurfaceShape;

const std::string kHead = "version = 1\n[run]\nduration = 0.01\nthreads = 1\n[material.soil]\ndensity = 2500\n"
                          "stiffness = 1e5\nrestitution = 0.2\nfriction = 0.5\n";
const std::string kBed =
    "[terrain]\nheightmap = \"heightmaps/hills.png\"\nsize = [0.6, 0.6]\nheight_range = [0, 0.03]\n"
    "material = \"soil\"\ngrain_radius = 0.03\ndepth = 0.1\nsettle_kinetic_energy = 1e-2\n";
const std::string kGrain = "[[grain]]\nposition = [5, 0, 0]\nradius = 0.01\nmaterial = \"soil\"\n";

std::string body(const std::string& name, const std::string& keys) {
  return fmt::format("[[body]]\nname = \"{}\"\nmaterial = \"soil\"\n{}\n", name, keys);
}
scene::Scene sceneOf(const std::string& text) { return setup::parseScene(kHead + text, "placed.toml"); }
std::unique_ptr<Simulation> made(const scene::Scene& scene) {
  return std::make_unique<Simulation>(setup::simulationSetup(scene), base::cpuExec(1), [](double, double) {});
}
std::string refusal(const std::string& text) {
  return test::messageOf([&] { made(sceneOf(text)); });
}
const multibody::Body& firstBody(const MechanismSetup& setup) { return setup.model.bodies()[0]; }

TEST(ConeShape, GapIsTheDistanceToTheNearestPointOfItsSurface) {
  std::mt19937 dice(1);
  std::uniform_real_distribution<double> any(-1, 1);
  for (const Vec3d half : {Vec3d{0.3, 0, 0.5}, Vec3d{0.4, 0.1, 0.2}, Vec3d{0.2, 0.2, 0.3}}) {
    const SurfaceGeometry cone{SurfaceShape::cone, half};
    for (int k = 0; k < 300; ++k) {
      const Vec3d p{any(dice), any(dice), any(dice)};
      const contact::SurfaceGap gap = gapTo(cone, p);
      const double rho = std::hypot(p.x, p.y);
      double nearest = 1e9; // distance to the sampled outline
      for (int i = 0; i <= 4000; ++i) {
        const double t = i / 4000.0;
        nearest =
            std::min({nearest, std::hypot(rho - t * half.x, p.z + half.z), std::hypot(rho - t * half.y, p.z - half.z),
                      std::hypot(rho - (half.x + t * (half.y - half.x)), p.z + half.z - 2 * half.z * t)});
      }
      const double wide = half.x + (half.y - half.x) * (p.z + half.z) / (2 * half.z);
      const bool within = std::fabs(p.z) < half.z && rho < wide;
      EXPECT_NEAR(gap.distance, within ? -nearest : nearest, 1e-4);
      EXPECT_NEAR(norm(gap.normal), 1, 1e-12);
      EXPECT_NEAR(gapTo(cone, p - gap.normal * gap.distance).distance, 0, 1e-12) << "the point is on the surface";
    }
  }
}

TEST(ConeShape, FarthestPointIsThatOfItsMesh) {
  std::mt19937 dice(2);
  std::uniform_real_distribution<double> any(-1, 1);
  for (const SurfaceGeometry& shape :
       {SurfaceGeometry{SurfaceShape::cone, {0.4, 0.1, 0.2}}, SurfaceGeometry{SurfaceShape::box, {0.1, 0.2, 0.3}},
        SurfaceGeometry{SurfaceShape::cylinder, {0.2, 0, 0.1}},
        SurfaceGeometry{SurfaceShape::capsule, {0.2, 0, 0.3}}}) {
    const base::TriangleMesh mesh = output::shapeMesh(shape);
    for (int k = 0; k < 20; ++k) {
      const Vec3d d = base::normalized(Vec3d{any(dice), any(dice), any(dice)});
      double farthest = -1e9;
      for (const Vec3d& v : mesh.vertices) farthest = std::max(farthest, dot(v, d));
      EXPECT_NEAR(farthestAlong(shape, d), farthest, 2e-3) << "64 sides";
      EXPECT_GE(farthestAlong(shape, d), farthest - 1e-12);
    }
  }
}

/// Volume, centre and inertia by random points in the shape's box.
TEST(BodyMass, ClosedFormsAgreeWithSampledSolids) {
  std::mt19937 dice(3);
  std::uniform_real_distribution<double> any(-1, 1);
  for (const SurfaceGeometry& shape :
       {SurfaceGeometry{SurfaceShape::cone, {0.4, 0.1, 0.3}}, SurfaceGeometry{SurfaceShape::cone, {0.4, 0, 0.3}},
        SurfaceGeometry{SurfaceShape::box, {0.1, 0.2, 0.3}}, SurfaceGeometry{SurfaceShape::cylinder, {0.2, 0, 0.3}},
        SurfaceGeometry{SurfaceShape::capsule, {0.2, 0, 0.3}}, SurfaceGeometry{SurfaceShape::capsule, {0.2, 0, 0}}}) {
    const setup::SolidMoments closed = setup::momentsOf(shape);
    const Vec3d half = halfExtent(shape);
    constexpr int kPoints = 400000;
    const double share = 8 * half.x * half.y * half.z / kPoints;
    double volume = 0, height = 0, across = 0, along = 0;
    for (int k = 0; k < kPoints; ++k) {
      const Vec3d p{any(dice) * half.x, any(dice) * half.y, any(dice) * half.z};
      if (gapTo(shape, p).distance > 0) continue;
      const double z = p.z - closed.centre.z;
      volume += share, height += share * z, across += share * (p.y * p.y + z * z),
          along += share * (p.x * p.x + p.y * p.y);
    }
    // Four standard errors for so many points.
    EXPECT_NEAR(closed.volume, volume, 0.01 * volume);
    EXPECT_NEAR(height / volume, 0, 0.004 * half.z);
    EXPECT_NEAR(closed.inertia.m[0][0], across, 0.015 * across);
    EXPECT_NEAR(closed.inertia.m[2][2], along, 0.015 * along);
  }
}

TEST(BodyMass, ShapesGiveMassAndInertiaByTheParallelAxisTheorem) {
  // A dumb-bell: two balls of radius 0.1 m at y = +-0.3 m.
  const std::string shapes = "[[body.shape]]\nkind = \"sphere\"\nradius = 0.1\nposition = [0, 0.3, 0]\n"
                             "[[body.shape]]\nkind = \"sphere\"\nradius = 0.1\nposition = [0, -0.3, 0]\n";
  const double ball = 4.0 / 3 * kPi * 1e-3;
  const auto check = [&](const std::string& keys, double mass) {
    const MechanismSetup setup = setup::mechanismSetup(sceneOf(kGrain + body("bell", keys + shapes)));
    const base::Mat3d& I = firstBody(setup).inertia_B;
    EXPECT_NEAR(firstBody(setup).mass, mass, 1e-12 * mass);
    EXPECT_NEAR(I.m[1][1], mass * 0.4 * 0.01, 1e-12 * mass);
    EXPECT_NEAR(I.m[0][0], mass * (0.4 * 0.01 + 0.09), 1e-12 * mass);
    EXPECT_NEAR(I.m[2][2], I.m[0][0], 1e-12 * mass);
    EXPECT_NEAR(I.m[0][1], 0, 1e-12 * mass);
  };
  check("density = 1000\n", 2000 * ball);
  check("", 5000 * ball); // the material's density
  check("mass = 3\n", 3);
  // A turned box has products of inertia: of 0.2 x 0.4 x 0.1 m about z by 30 degrees.
  const MechanismSetup turned = setup::mechanismSetup(sceneOf(
      kGrain + body("box", "density = 1000\n[[body.shape]]\nkind = \"box\"\nsize = [0.2, 0.4, 0.1]\naxis = [0, 0, 1]\n"
                           "angle = 30\n")));
  EXPECT_NEAR(firstBody(turned).inertia_B.m[0][1], (8.0 / 12) * (0.17 - 0.05) / 2 * std::sin(kPi / 3), 1e-12);
}

TEST(BodyMass, ContradictionsAreRefusedAtTheirPlace) {
  const std::string shape = "[[body.shape]]\nkind = \"sphere\"\nradius = 0.1\n";
  const auto says = [](const std::string& message, const std::string& words) {
    EXPECT_NE(message.find(words), std::string::npos) << message;
    EXPECT_NE(message.find("placed.toml:"), std::string::npos) << message;
  };
  says(refusal(kGrain + body("b", shape + "position = [0, 0, 0.1]\n")), "its centre of mass at [0, 0, 0.1] m");
  says(refusal(kGrain + body("b", "density = 1000\nmass = 1\n" + shape)), "body.0.density");
  says(refusal(kGrain + body("b", "density = 1000\nfixed = true\n" + shape)), "body.0.density");
  says(refusal("[[body]]\nname = \"b\"\nmass = 1\nbox = [1, 1, 1]\ndensity = 1000\n"), "body.0.density");
  says(refusal("[[body]]\nname = \"b\"\nbox = [1, 1, 1]\n"), "body.0.mass");
  says(refusal(kGrain + body("b", shape + "tip_radius = 0.1\n")), "shape.0.tip_radius");
  says(refusal(kGrain + body("b", "[[body.shape]]\nkind = \"cone\"\nradius = 0.1\ntip_radius = 0.2\nlength = 1\n")),
       "shape.0.tip_radius");
  says(refusal(kGrain + body("b", "probe_position = [0.1, 0, 0]\n" + shape)), "body.0.probe_position");
}

/// A ball on a bar, and a joint, a spring and a bushing to the world.
std::string liftedBodies(const std::string& keys) {
  return body("ball", "position = [0.3, 0, 1]\n[[body.shape]]\nkind = \"sphere\"\nradius = 0.05\n") +
         "[[body]]\nname = \"bar\"\nmass = 1\nbox = [0.1, 0.1, 0.1]\nposition = [0.3, 0, 1.5]\n"
         "[[joint]]\nname = \"slide\"\ntype = \"prismatic\"\nbodies = [\"world\", \"ball\"]\npoint = [0.3, 0, 1]\n"
         "axis = [0, 0, 1]\n"
         "[[spring]]\nname = \"spring\"\nbodies = [\"world\", \"bar\"]\npoint_a = [0.3, 0, 2]\nstiffness = 10\n"
         "[[bushing]]\nname = \"bushing\"\nbodies = [\"bar\", \"world\"]\npoint = [0.3, 0, 1.5]\n"
         "stiffness = [10, 10, 10]\n" +
         keys;
}

TEST(AboveBed, LiftsBodiesAndWhatTheWorldHoldsTogether) {
  const auto s = made(sceneOf(kBed + liftedBodies("[mechanism]\nabove_bed = 0.004\n")));
  const multibody::Model& model = s->mechanism()->model();
  const double way = model.bodies()[0].pose.position.z - 1;
  // The highest grain is inside the ball's square; the ball itself may be farther from it.
  double top = -1;
  const terrain::GrainSnapshot g = s->ground().grains->snapshot();
  for (std::size_t k = 0; k < g.position.size(); ++k) {
    const double radius = g.radius.empty() ? s->ground().grains->model().radius : double{g.radius[k]};
    if (std::fabs(g.position[k].x - 0.3) < 0.05 + radius && std::fabs(g.position[k].y) < 0.05 + radius)
      top = std::max(top, g.position[k].z + radius);
  }
  EXPECT_NEAR(1 + way - 0.05, top + 0.004, 1e-6);
  EXPECT_DOUBLE_EQ(model.bodies()[1].pose.position.z, 1.5 + way);
  EXPECT_DOUBLE_EQ(model.joints()[0].frame_A.position.z, 1 + way);
  EXPECT_DOUBLE_EQ(model.joints()[0].frame_B.position.z, 0);
  EXPECT_DOUBLE_EQ(model.pointSprings()[0].point_A.z, 2 + way);
  EXPECT_DOUBLE_EQ(model.bushings()[0].frame_B.position.z, 1.5 + way);
  EXPECT_LT(s->mechanism()->drift().velocity, 1e-12);
}

TEST(AboveBed, AResumedRunTakesTheSameSteps) {
  const scene::Scene scene = sceneOf(kBed + liftedBodies("[mechanism]\nabove_bed = 0.004\n"));
  const auto straight = made(scene);
  for (int k = 0; k < 20; ++k) straight->step();
  const SimulationState saved = straight->save();
  Simulation resumed(setup::simulationSetup(scene), base::cpuExec(1), saved);
  for (int k = 0; k < 20; ++k) straight->step(), resumed.step();
  EXPECT_EQ(straight->stateHash(), resumed.stateHash());
}

TEST(AboveBed, IsRefusedWithoutABedUnderAShape) {
  const std::string key = "[mechanism]\nabove_bed = 0.004\n";
  EXPECT_NE(refusal(kGrain + liftedBodies(key)).find("[m] requires a bed of grains"), std::string::npos);
  EXPECT_NE(refusal("[[body]]\nname = \"b\"\nmass = 1\nbox = [1, 1, 1]\n" + key).find("mechanism.above_bed"),
            std::string::npos);
  std::string away = kBed + liftedBodies(key);
  for (std::size_t at; (at = away.find("[0.3, 0, ")) != std::string::npos;) away.replace(at, 9, "[3.3, 0, ");
  const std::string message = refusal(away);
  EXPECT_NE(message.find("no grain of the bed lies under a shape"), std::string::npos) << message;
  EXPECT_NE(message.find("placed.toml:"), std::string::npos) << message;
}

TEST(BodyProbe, WeighsTheGrainsWithCentresInItsBox) {
  std::string grains;
  for (int k = 0; k < 6; ++k)
    grains +=
        fmt::format("[[grain]]\nposition = [{}, 0, 0]\nradius = {}\nmaterial = \"soil\"\n", 0.1 * k, 0.01 + 0.002 * k);
  // The box of the rotated body extends in x from 0.05 to 0.35 m.
  const auto s = made(sceneOf(grains + body("b", "mass = 1\ninertia = [1, 1, 1]\nposition = [0.1, 0, 0.5]\n"
                                                 "axis = [0, 0, 1]\nangle = 90\nprobe_size = [0.02, 0.3, 0.02]\n"
                                                 "probe_position = [0, -0.1, -0.5]\n[[body.shape]]\n"
                                                 "kind = \"sphere\"\nradius = 0.05\n")));
  double mass = 0;
  for (int k = 1; k <= 3; ++k) mass += 2500 * 4.0 / 3 * kPi * std::pow(0.01 + 0.002 * k, 3);
  const std::vector<double> found =
      grainMassIn(s->setup().mechanism->probes, s->mechanism()->state(), *s->ground().grains, base::Comm{});
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NEAR(found[0], mass, 1e-6 * mass) << "radii are float";
}

TEST(OutputPlot, UnknownColumnsAndContradictionsAreRefusedAtTheirPlace) {
  const auto refused = [](const std::string& keys) {
    return test::messageOf([&] {
      const scene::Scene scene =
          sceneOf(kGrain + body("b", "[[body.shape]]\nkind = \"sphere\"\nradius = 0.1\n") + "[[output.plot]]\n" + keys);
      const auto s = made(scene);
      session::RowColumns(*s, setup::recordSetup(scene, {}).output);
    });
  };
  const auto says = [&](const std::string& keys, const std::string& words) {
    const std::string message = refused(keys);
    EXPECT_NE(message.find(words), std::string::npos) << message;
    EXPECT_NE(message.find("placed.toml:"), std::string::npos) << message;
  };
  EXPECT_EQ(refused("y = [\"bodies.b.position.z\"]\ny_label = \"z\"\n"), "");
  says("y = [\"bodies.b.positon.z\"]\ny_label = \"z\"\n", "did you mean \"bodies.b.position.z\"");
  says("x = \"tim\"\ny = [\"bodies.b.position.z\"]\ny_label = \"z\"\n",
       "output.plot.0.x names a column that the results lack");
  says("y = []\ny_label = \"z\"\n", "output.plot.0.y");
  says("y = [\"bodies.b.position.z\"]\n", "lacks the required key y_label");
  says("y = [\"bodies.b.position.z\"]\ny_label = \"z\"\nlabels = [\"a\", \"b\"]\n", "output.plot.0.labels");
  says("y = [\"bodies.b.position.z\"]\ny_label = \"z\"\nlevels = [1]\n", "output.plot.0.level_labels");
  says("y = [\"bodies.b.position.z\"]\ny_label = \"z\"\ny_range = [1, 0]\n", "output.plot.0.y_range");
}

} // namespace
} // namespace grouser::coupling::on_beds
