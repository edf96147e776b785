// SPDX-License-Identifier: BSD-3-Clause
// Bodies of mechanisms that touch rigid surfaces and each other: closed forms, energy balance, and rejected scenes.
#include "base/error.hpp"
#include "base/math.hpp"
#include "contact/shape_points.hpp"
#include "coupling/simulation.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/setup/simulation_setup.hpp"
#include "tests/message_of.hpp"
#include "tests/system/scene_simulation.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <string>

namespace grouser::coupling::touching {
namespace {

using base::Vec3d;
using test::messageOf;

constexpr double kGravity = 9.81;

std::string head(const std::string& run = {}, const std::string& material = {}, double restitution = 0.4) {
  return "version = 1\n[run]\nduration = 1.0\n" + run + "\n[material.steel]\nfriction = 0.3\n" +
         fmt::format("restitution = {}\n", restitution) + material;
}
constexpr double kLossless = 1; // restitution
const std::string kPlane = "[[plane]]\nnormal = [0, 0, 1]\nmaterial = \"steel\"\n";

/// A free box of steel.
std::string box(const std::string& name, const std::string& size, double mass, const std::string& position,
                const std::string& more = {}) {
  return fmt::format("[[body]]\nname = \"{}\"\nmass = {}\nbox = {}\nposition = {}\nmaterial = \"steel\"\n{}\n"
                     "[[body.shape]]\nkind = \"box\"\nsize = {}\n",
                     name, mass, size, position, more, size);
}

/// A free ball or cylinder of steel, of uniform density.
std::string ball(const std::string& name, double radius, double mass, const std::string& position,
                 const std::string& more = {}) {
  const double i = 0.4 * mass * radius * radius;
  return fmt::format("[[body]]\nname = \"{}\"\nmass = {}\ninertia = [{}, {}, {}]\nposition = {}\nmaterial = "
                     "\"steel\"\n{}\n[[body.shape]]\nkind = \"sphere\"\nradius = {}\n",
                     name, mass, i, i, i, position, more, radius);
}
std::string wheel(double radius, double width, double mass, const std::string& position, const std::string& more = {}) {
  const double spin = 0.5 * mass * radius * radius, tilt = mass * (3 * radius * radius + width * width) / 12;
  return fmt::format("[[body]]\nname = \"wheel\"\nmass = {}\ninertia = [{}, {}, {}]\nposition = {}\nmaterial = "
                     "\"steel\"\n{}\n[[body.shape]]\nkind = \"cylinder\"\nradius = {}\nlength = {}\naxis = [0, 1, 0]\n",
                     mass, tilt, spin, tilt, position, more, radius, width);
}

/// Energy residual of the ledger over the exchanged energy [-].
double residualShare(Simulation& s) {
  const Ledger l = s.ledger();
  return std::fabs(l.residual) / l.turnover;
}

TEST(ShapePoints, CarryTheAreaOfTheShape) {
  using contact::SurfaceShape;
  const auto sums = [](const contact::SurfaceGeometry& g) {
    double area = 0, worst = 0;
    Vec3d moment;
    for (const contact::SurfaceSample& s : contact::shapePoints(g)) {
      area += s.area, moment += s.centre.as<double>() * static_cast<double>(s.area);
      worst = std::max(worst, std::fabs(gapTo(g, s.centre.as<double>()).distance));
    }
    EXPECT_LT(norm(moment), 1e-5 * area) << "centred";
    EXPECT_LT(worst, 1e-6) << "on the surface";
    return area;
  };
  EXPECT_NEAR(sums({SurfaceShape::box, {0.1, 0.2, 0.05}}), 8 * (0.02 + 0.005 + 0.01), 1e-6);
  EXPECT_NEAR(sums({SurfaceShape::cylinder, {0.1, 0, 0.2}}), 2 * base::kPi * 0.1 * (0.4 + 0.1), 1e-5);
  EXPECT_NEAR(sums({SurfaceShape::cone, {0.1, 0.1, 0.2}}), 2 * base::kPi * 0.1 * (0.4 + 0.1), 1e-4);
  EXPECT_NEAR(sums({SurfaceShape::capsule, {0.1, 0, 0}}), 4 * base::kPi * 0.01, 1e-5);
  EXPECT_NEAR(sums({SurfaceShape::capsule, {0.1, 0, 0.2}}), 4 * base::kPi * 0.01 + 2 * base::kPi * 0.1 * 0.4, 1e-5);
}

TEST(BodyContacts, RestOnAPlaneByModulusTimesVolume) {
  const double modulus = 1e8; // equal materials keep their modulus
  const auto s = simulationOf(head({}, "foundation_modulus = 1e8\n") + kPlane +
                              box("block", "[0.2, 0.1, 0.1]", 10, "[0, 0, 0.05]") +
                              ball("ball", 0.05, 1, "[0, 1, 0.05]") + wheel(0.1, 0.08, 5, "[0, -1, 0.1]"));
  advanceTo(*s, 0.4);
  s->restartMeans();
  advanceTo(*s, 0.5);
  const auto& pose = stateOf(*s).pose;
  const auto force = s->mechanism()->contactForces();
  // Side faces also press with their lowest row of points.
  const double deep = 10 * kGravity / (modulus * 0.02);
  EXPECT_NEAR(0.05 - pose[0].position.z, deep, 0.08 * deep);
  const double ofBall = std::sqrt(kGravity / (base::kPi * modulus * 0.05));
  EXPECT_NEAR(0.05 - pose[1].position.z, ofBall, 0.05 * ofBall);
  const double ofWheel = base::pow(0.75 * 5 * kGravity / (modulus * 0.08 * std::sqrt(0.2)), 2.0 / 3);
  EXPECT_NEAR(0.1 - pose[2].position.z, ofWheel, 0.08 * ofWheel);
  for (const auto& [body, mass] : {std::pair(0, 10.0), std::pair(1, 1.0), std::pair(2, 5.0)})
    EXPECT_NEAR(force[static_cast<std::size_t>(body)].z, mass * kGravity, 1e-3 * mass * kGravity) << body;
  EXPECT_LT(residualShare(*s), 1e-9);
}

TEST(BodyContacts, ABlockStopsAfterVSquaredOverTwoMuG) {
  const auto s =
      simulationOf(head() + kPlane + box("block", "[0.2, 0.1, 0.05]", 10, "[0, 0, 0.025]", "velocity = [1, 0, 0]"));
  advanceTo(*s, 0.6); // it stops after v / (mu g) = 0.34 s
  EXPECT_NEAR(stateOf(*s).pose[0].position.x, 1 / (2 * 0.3 * kGravity), 2e-3 / (2 * 0.3 * kGravity));
  EXPECT_LT(norm(stateOf(*s).twist[0].v), 1e-3);
  const Ledger l = s->ledger();
  EXPECT_NEAR(l.dissipated.parts, 5, 0.02) << "m v^2 / 2";
  EXPECT_LT(residualShare(*s), 1e-9);
}

TEST(BodyContacts, TowedBlockFeelsMuTimesWeight) {
  const std::string drawn =
      "[[joint]]\nname = \"rail\"\ntype = \"prismatic\"\nbodies = [\"world\", \"sled\"]\npoint = "
      "[0, 0, 0.3]\naxis = [1, 0, 0]\n[[drive]]\nname = \"winch\"\njoint = \"rail\"\nvalue = 0.2\n"
      "[[joint]]\nname = \"hanger\"\ntype = \"prismatic\"\nbodies = [\"sled\", \"block\"]\npoint = "
      "[0, 0, 0.1]\naxis = [0, 0, 1]\n";
  const auto s = simulationOf(
      head() + kPlane +
      "[[body]]\nname = \"sled\"\nmass = 1\nbox = [0.1, 0.1, 0.1]\nposition = [0, 0, 0.3]\nvelocity = [0.2, 0, 0]\n" +
      box("block", "[0.2, 0.1, 0.05]", 10, "[0, 0, 0.025]", "velocity = [0.2, 0, 0]") + drawn);
  advanceTo(*s, 0.4);
  s->restartMeans();
  advanceTo(*s, 0.8);
  const Vec3d force = s->mechanism()->contactForces()[1];
  EXPECT_NEAR(force.z, 10 * kGravity, 1e-3 * 10 * kGravity);
  EXPECT_NEAR(force.x, -0.3 * 10 * kGravity, 1e-3 * 0.3 * 10 * kGravity);
}

TEST(BodyContacts, BallThatSlidesComesToRoll) {
  // A solid ball set sliding at v rolls after 2 v / (7 mu g), then at 5 v / 7.
  const auto s =
      simulationOf(head({}, {}, kLossless) + kPlane + ball("ball", 0.1, 2, "[0, 0, 0.1]", "velocity = [1, 0, 0]"));
  advanceTo(*s, 2 / (7 * 0.3 * kGravity) + 0.1);
  const multibody::Twist& V = stateOf(*s).twist[0];
  EXPECT_NEAR(V.v.x, 5.0 / 7, 5e-3);
  EXPECT_NEAR(V.w.y * 0.1, V.v.x, 5e-3);
}

TEST(BodyContacts, WheelRollsDownASlopeAtTwoThirdsOfGSine) {
  const double slope = 0.2, angle = std::atan(slope);
  const auto s =
      simulationOf(head(fmt::format("gravity = [{}, 0, {}]", kGravity * std::sin(angle), -kGravity * std::cos(angle)),
                        {}, kLossless) +
                   kPlane + wheel(0.1, 0.08, 5, "[0, 0, 0.1]"));
  advanceTo(*s, 0.2);
  const double before = stateOf(*s).twist[0].v.x;
  advanceTo(*s, 0.7);
  const double expected = 2.0 / 3 * kGravity * std::sin(angle);
  EXPECT_NEAR((stateOf(*s).twist[0].v.x - before) / 0.5, expected, 0.02 * expected);
}

/// A hull on four driven wheels of radius 0.1 m, wheelbase 0.5 m, at a rim speed of 0.2 m/s.
std::string rover(double hull, double wheelMass) {
  std::string text =
      fmt::format("[[body]]\nname = \"hull\"\nmass = {}\nbox = [0.6, 0.3, 0.1]\nposition = [0, 0, 0.2498]\n"
                  "velocity = [0.2, 0, 0]\n",
                  hull);
  for (const double x : {0.25, -0.25})
    for (const double y : {0.25, -0.25}) {
      const std::string name = fmt::format("{}_{}", x > 0 ? "front" : "rear", y > 0 ? "left" : "right");
      const std::string place = fmt::format("[{}, {}, 0.0998]", x, y);
      std::string one = wheel(0.1, 0.06, wheelMass, place, "velocity = [0.2, 0, 0]\nspin = [0, 2, 0]");
      one.replace(one.find("\"wheel\""), 7, "\"" + name + "\"");
      text += one + fmt::format("[[joint]]\nname = \"{0}\"\ntype = \"revolute\"\nbodies = [\"hull\", \"{0}\"]\npoint = "
                                "{1}\naxis = [0, 1, 0]\n[[drive]]\nname = \"{0}\"\njoint = \"{0}\"\nvalue = 2\n",
                                name, place);
    }
  return text;
}

/// The tangential spring of a round part rolls along with its patch, so driven wheels do not creep.
TEST(BodyContacts, RoverOnASlopeHasTheTorquesLoadsAndSpeedOfStatics) {
  const double hull = 20, wheelMass = 2, mass = hull + 4 * wheelMass, slope = 0.2, angle = std::atan(slope);
  const double along = kGravity * std::sin(angle), across = kGravity * std::cos(angle);
  const std::string gravity = fmt::format("gravity = [{}, 0, {}]", -along, -across);
  for (const char* modulus : {"1e8", "1e9"}) {
    const auto s = simulationOf(head(gravity, fmt::format("foundation_modulus = {}\n", modulus)) + kPlane +
                                rover(hull, wheelMass));
    advanceTo(*s, 0.5);
    s->restartMeans();
    const double from = stateOf(*s).pose[0].position.x;
    double torque = 0;
    int steps = 0;
    for (; s->time() < 1.5; ++steps) {
      s->step();
      for (int d = 0; d < 4; ++d) torque += s->mechanism()->drive(d).torque;
    }
    torque /= steps;
    EXPECT_NEAR(torque, mass * along * 0.1, 0.02 * mass * along * 0.1) << modulus;
    const double slip = 1 - (stateOf(*s).pose[0].position.x - from) / (s->time() - 0.5) / 0.2;
    std::printf("modulus %s N/m3: slip %.2f %%, torque / statics %.3f\n", modulus, 100 * slip,
                torque / (mass * along * 0.1));
    EXPECT_NEAR(slip, 0, 1e-4) << modulus;
    // Moments about the contact of an axle: the height of the centre of mass shifts load to the rear.
    const double height = (hull * 0.25 + 4 * wheelMass * 0.1) / mass, shift = mass * along * height / 0.5;
    const auto force = s->mechanism()->contactForces();
    EXPECT_NEAR(force[1].z + force[2].z, 0.5 * mass * across - shift, 0.02 * mass * across) << "front, " << modulus;
    EXPECT_NEAR(force[3].z + force[4].z, 0.5 * mass * across + shift, 0.02 * mass * across) << "rear, " << modulus;
  }
}

TEST(BodyContacts, BlockSticksBelowTheFrictionAngleAndSlidesBeyond) {
  const auto drift = [](double slope) {
    const double angle = std::atan(slope);
    const auto s = simulationOf(
        head(fmt::format("gravity = [{}, 0, {}]", kGravity * std::sin(angle), -kGravity * std::cos(angle))) + kPlane +
        box("block", "[0.2, 0.1, 0.05]", 10, "[0, 0, 0.025]"));
    advanceTo(*s, 0.2);
    const Vec3d before = stateOf(*s).pose[0].position;
    advanceTo(*s, 0.7);
    return (stateOf(*s).pose[0].position - before).x;
  };
  EXPECT_LT(std::fabs(drift(0.29)), 1e-5);
  const double angle = std::atan(0.4), a = kGravity * (std::sin(angle) - 0.3 * std::cos(angle));
  EXPECT_NEAR(drift(0.4), 0.5 * a * (0.7 * 0.7 - 0.2 * 0.2), 0.02 * 0.5 * a * 0.45);
}

TEST(BodyContacts, FlatBounceHasTheRestitutionOfThePair) {
  for (const double e : {0.8, 0.4}) {
    const auto s = simulationOf(head("gravity = [0, 0, 0]\ntime_step = 2e-6", {}, e) + kPlane +
                                box("cube", "[0.1, 0.1, 0.1]", 1, "[0, 0, 0.0505]", "velocity = [0, 0, -0.2]"));
    advanceTo(*s, 0.02);
    EXPECT_NEAR(stateOf(*s).twist[0].v.z, 0.2 * e, 0.002) << e;
  }
}

/// Centrifugal force presses a block onto the floor of a rotating wheel. Contact velocities are relative to the
/// rotating surface.
TEST(BodyContacts, ABlockTurnsWithTheFloorThatItLiesOn) {
  const double rate = 2;
  const auto s = simulationOf(
      head("gravity = [0, 0, 0]") +
      "[[body]]\nname = \"wheel\"\nmass = 50\ninertia = [5, 5, 5]\nspin = [2, 0, 0]\nmaterial = \"steel\"\n"
      "[[body.shape]]\nkind = \"box\"\nsize = [0.4, 0.4, 0.1]\nposition = [0, 0, -0.35]\n[[joint]]\nname = "
      "\"axle\"\ntype = \"revolute\"\nbodies = [\"world\", \"wheel\"]\npoint = [0, 0, 0]\naxis = [1, 0, 0]\n"
      "[[drive]]\nname = \"motor\"\njoint = \"axle\"\nvalue = 2\n" +
      box("block", "[0.1, 0.1, 0.05]", 2, "[0, 0, -0.275]", "velocity = [0, 0.55, 0]\nspin = [2, 0, 0]"));
  advanceTo(*s, 1);
  const double angle = -rate * s->time();
  const Vec3d p = stateOf(*s).pose[1].position;
  EXPECT_NEAR(p.y * std::cos(angle) - p.z * std::sin(angle), 0, 1e-3) << "slid";
  EXPECT_NEAR(p.y * std::sin(angle) + p.z * std::cos(angle), -0.275, 1e-4) << "lifted";
  EXPECT_NEAR(stateOf(*s).twist[1].w.x, rate, 0.01);
}

TEST(BodyContacts, BodiesCollideWithExactMomentum) {
  const std::string free = "gravity = [0, 0, 0]";
  const auto s =
      simulationOf(head(free) + ball("a", 0.05, 1, "[0, 0, 0]", "velocity = [1, 0, 0]") +
                   box("b", "[0.1, 0.1, 0.1]", 3, "[0.15, 0.02, 0.01]", "velocity = [-0.5, 0, 0]\nspin = [0, 1, 2]"));
  const Vec3d before = s->ledger().momentum;
  const multibody::Totals start = s->mechanism()->bodiesBalance().now;
  advanceTo(*s, 0.2);
  const multibody::Totals now = s->mechanism()->bodiesBalance().now;
  EXPECT_LT(norm(now.linearMomentum - start.linearMomentum), 1e-9) << before.x;
  EXPECT_LT(norm(now.angularMomentum - start.angularMomentum), 1e-6);
  EXPECT_LT(stateOf(*s).twist[0].v.x, 0) << "they have collided";
  EXPECT_LT(now.kinetic, start.kinetic);
  EXPECT_LT(residualShare(*s), 1e-9);
}

TEST(BodyContacts, AStackBearsItsWeight) {
  const auto s = simulationOf(head() + kPlane + box("low", "[0.2, 0.2, 0.1]", 8, "[0, 0, 0.05]") +
                              box("middle", "[0.15, 0.15, 0.1]", 4, "[0, 0, 0.15]") +
                              box("top", "[0.1, 0.1, 0.1]", 2, "[0.01, 0, 0.25]"));
  advanceTo(*s, 0.5);
  s->restartMeans();
  advanceTo(*s, 0.7);
  const auto force = s->mechanism()->contactForces();
  // The contact force on each body balances its own weight.
  for (const auto& [body, mass] : {std::pair(0, 8.0), std::pair(1, 4.0), std::pair(2, 2.0)})
    EXPECT_NEAR(force[static_cast<std::size_t>(body)].z, mass * kGravity, 2e-3 * mass * kGravity) << body;
  EXPECT_NEAR(s->mechanism()->meanForceOn(0).z, -14 * kGravity, 2e-3 * 14 * kGravity) << "the plane";
  EXPECT_NEAR(stateOf(*s).pose[2].position.z, 0.25, 5e-4);
}

TEST(BodyContacts, JointedBodiesDoNotTouchEachOther) {
  const std::string pair = "gravity = [0, 0, 0]";
  const std::string two = box("a", "[0.1, 0.1, 0.1]", 1, "[0, 0, 0]") + box("b", "[0.1, 0.1, 0.1]", 1, "[0.08, 0, 0]");
  EXPECT_NE(messageOf([&] { simulationOf(head(pair) + two); }).find("overlaps body"), std::string::npos);
  const auto s =
      simulationOf(head(pair) + two +
                   "[[joint]]\nname = \"hinge\"\ntype = \"revolute\"\nbodies = [\"a\", \"b\"]\npoint = [0.04, 0, "
                   "0]\naxis = [0, 1, 0]\n");
  advanceTo(*s, 0.05);
  EXPECT_EQ(s->mechanism()->contactForces()[0], Vec3d{});
}

TEST(BodyContacts, RigidTerrainCarriesBodies) {
  const auto s = simulationOf(head() +
                              "[terrain]\nkind = \"rigid\"\nsize = [2, 2]\nmaterial = \"steel\"\nheightmap = "
                              "\"heightmaps/flat.png\"\nheight_range = [-0.128, 0.127]\n" +
                              box("block", "[0.2, 0.1, 0.05]", 10, "[0.5, 0, 0.025]", "velocity = [0.5, 0, 0]"));
  advanceTo(*s, 0.5);
  EXPECT_NEAR(stateOf(*s).pose[0].position.x - 0.5, 0.25 / (2 * 0.3 * kGravity), 2e-3 * 0.25 / (2 * 0.3 * kGravity));
  s->restartMeans();
  advanceTo(*s, 0.6);
  EXPECT_NEAR(s->mechanism()->contactForces()[0].z, 10 * kGravity, 1e-3 * 10 * kGravity);
}

TEST(BodyContacts, MeshesAndCylindersAtRestCarryBodies) {
  const auto s = simulationOf(
      head() +
      "[[cylinder]]\nposition = [0, 0, -0.5]\nradius = 0.5\nlength = 1\naxis = [0, 0, 1]\nmaterial = \"steel\"\n" +
      ball("ball", 0.1, 2, "[0.1, 0, 0.1]"));
  advanceTo(*s, 0.3);
  s->restartMeans();
  advanceTo(*s, 0.4);
  EXPECT_NEAR(s->mechanism()->contactForces()[0].z, 2 * kGravity, 2e-3 * 2 * kGravity);
}

TEST(BodyContacts, HaveOneAnswerWhenResumed) {
  const std::string text = head() + kPlane +
                           box("low", "[0.2, 0.2, 0.1]", 8, "[0, 0, 0.051]", "velocity = [0.5, 0, 0]") +
                           ball("ball", 0.05, 1, "[0.05, 0.02, 0.16]", "spin = [0, 3, 1]");
  const auto straight = simulationOf(text), first = simulationOf(text);
  advanceTo(*straight, 0.1), advanceTo(*first, 0.06);
  const SimulationState saved = first->save();
  Simulation resumed(setup::simulationSetup(setup::parseScene(text, "scene.toml")), base::cpuExec(2), saved);
  EXPECT_EQ(resumed.stateHash(), first->stateHash());
  advanceTo(resumed, 0.1);
  EXPECT_EQ(resumed.stateHash(), straight->stateHash());
}

TEST(BodyContacts, AreRefusedWhereTheyOverlapAtTheStart) {
  EXPECT_NE(messageOf([] {
              simulationOf(head() + kPlane + box("block", "[0.2, 0.1, 0.1]", 10, "[1, 0, 0.04]"));
            }).find("overlaps plane0 by 0.01 m"),
            std::string::npos);
  EXPECT_NE(messageOf([] {
              simulationOf(head() +
                           "[terrain]\nkind = \"rigid\"\nsize = [2, 2]\nmaterial = \"steel\"\nheightmap = "
                           "\"heightmaps/flat.png\"\nheight_range = [-0.128, 0.127]\n" +
                           box("block", "[0.2, 0.1, 0.1]", 10, "[1, 0, 0.04]"));
            }).find("overlaps the ground by 0.01 m"),
            std::string::npos);
  const std::string inner = box("inner", "[0.1, 0.1, 0.1]", 1, "[0, 0, 0.02]"),
                    outer = box("outer", "[1, 1, 1]", 10, "[0, 0, 0]");
  for (const std::string& two : {inner + outer, outer + inner})
    EXPECT_NE(messageOf([&] { simulationOf(head() + two); }).find("overlaps body"), std::string::npos);
  // The points of the ball touch boxes; none of them is inside this one.
  EXPECT_NE(
      messageOf([&] { simulationOf(head() + inner + ball("around", 0.5, 10, "[0, 0, 0]")); }).find("overlaps body"),
      std::string::npos);
  EXPECT_NE(messageOf([&] {
              simulationOf(head() + "[[box]]\nsize = [0.1, 0.1, 0.1]\nposition = [0, 0, 0]\nmaterial = \"steel\"\n" +
                           outer);
            }).find("overlaps box0"),
            std::string::npos);
}

TEST(BodyContacts, ATorqueOnAPointBodyIsRefused) {
  const auto s = simulationOf("version = 1\n[run]\nduration = 1.0\n[[body]]\nname = \"p\"\nmass = 2\npoint = true\n");
  s->set({{0, InputKind::bodyLoad, 0, false, {1, 0, 0, 0, 0, 0}}});
  EXPECT_NE(messageOf([&] {
              s->set({{0, InputKind::bodyLoad, 0, false, {0, 0, 0, 0, 0, 1}}});
            }).find("torque on body \"p\""),
            std::string::npos);
}

TEST(BodyContacts, BodiesBesideTheTerrainAreRefused) {
  const auto scene = [](double x, double speed) {
    return head() +
           "[terrain]\nkind = \"rigid\"\nsize = [4, 2]\nmaterial = \"steel\"\nheightmap = "
           "\"heightmaps/flat.png\"\nheight_range = [-0.128, 0.127]\n" +
           ball("ball", 0.1, 1, fmt::format("[{}, 0, 0.1]", x), fmt::format("velocity = [{}, 0, 0]", speed));
  };
  EXPECT_NE(messageOf([&] { simulationOf(scene(4.7, 0)); }).find("body \"ball\" is beside the terrain"),
            std::string::npos);
  const auto s = simulationOf(scene(3.9, 5));
  EXPECT_THROW(advanceTo(*s, 0.2), base::SimulationError);
}

TEST(BodyContacts, AStepThatTheFoundationDoesNotBearIsRefused) {
  const std::string message = messageOf([] {
    simulationOf(head("time_step = 1e-3") + kPlane + box("plate", "[0.2, 0.2, 0.01]", 0.01, "[0, 0, 0.005]"));
  });
  EXPECT_NE(message.find("body \"plate\" of 0.01 kg on rigid surfaces or bodies"), std::string::npos) << message;
  // With the automatic step the plate comes to rest.
  const auto s = simulationOf(head() + kPlane + box("plate", "[0.2, 0.2, 0.01]", 0.01, "[0, 0, 0.0052]"));
  advanceTo(*s, 0.1);
  EXPECT_LT(norm(stateOf(*s).twist[0].v), 1e-4);
}

} // namespace
} // namespace grouser::coupling::touching
