// SPDX-License-Identifier: BSD-3-Clause
// Impacts and rolling of bodies against closed forms: restitution on every face, of every shape, for every mass ratio;
// free rolling; overlaps at rest and beyond the limit.
#include "base/error.hpp"
#include "base/math.hpp"
#include "contact/restitution.hpp"
#include "coupling/simulation.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/setup/simulation_setup.hpp"
#include "tests/system/scene_simulation.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <utility>

namespace grouser::coupling::restitution {
namespace {

using base::Vec3d;

constexpr double kGravity = 9.81;
const std::string kPlane = "[[plane]]\nmaterial = \"a\"\n";

std::string head(double restitution, const std::string& run = "gravity = [0, 0, 0]", double friction = 0) {
  return fmt::format("version = 1\n[run]\nduration = 2.0\n{}\n[material.a]\ndensity = 500\nfriction = {}\n"
                     "restitution = {}\n",
                     run, friction, restitution);
}

std::string body(const std::string& name, const std::string& shape, const std::string& place) {
  return fmt::format("[[body]]\nname = \"{}\"\nmaterial = \"a\"\n{}\n[[body.shape]]\n{}\n", name, place, shape);
}
std::string cube(double edge) { return fmt::format("kind = \"box\"\nsize = [{0}, {0}, {0}]", edge); }

struct Solid {
  const char *name, *shape;
  double height; ///< of the centre above the plane [m]
};
constexpr Solid kSolids[] = {
    {"plate", "kind = \"box\"\nsize = [1, 1, 0.02]", 0.01},
    {"box", "kind = \"box\"\nsize = [0.2, 0.2, 0.1]", 0.05},
    {"column", "kind = \"box\"\nsize = [0.1, 0.1, 0.6]", 0.3},
    {"cylinder on end", "kind = \"cylinder\"\nradius = 0.1\nlength = 0.2", 0.1},
    {"disc", "kind = \"cylinder\"\nradius = 0.2\nlength = 0.02", 0.01},
    {"cylinder on its side", "kind = \"cylinder\"\nradius = 0.1\nlength = 0.2\naxis = [0, 1, 0]", 0.1},
    {"ball", "kind = \"sphere\"\nradius = 0.1", 0.1},
    {"capsule", "kind = \"capsule\"\nradius = 0.1\nlength = 0.2\naxis = [1, 0, 0]", 0.1}};

/// At the automatic step; 2 % of the restitution.
TEST(BodyRestitution, IsThatOfTheMaterialOnAnyShape) {
  for (const double e : {0.8, 0.5, 0.2, 0.1, 0.05, 0.01})
    for (const Solid& solid : kSolids) {
      const auto s = simulationOf(
          head(e) + kPlane +
          body("b", solid.shape, fmt::format("position = [0, 0, {}]\nvelocity = [0, 0, -0.3]", solid.height + 1e-4)));
      advanceTo(*s, 0.03);
      EXPECT_NEAR(stateOf(*s).twist[0].v.z, 0.3 * e, 0.3 * e * 0.02) << solid.name << " " << e;
      EXPECT_LT(norm(stateOf(*s).twist[0].w), 0.01) << solid.name << " " << e;
    }
}

/// Momentum and relative speed of two free cubes; the second has up to a thousand times the mass of the first.
TEST(BodyRestitution, UsesTheMassesOfBothBodies) {
  for (const double e : {0.8, 0.5, 0.2})
    for (const double mass : {1.0, 2.0, 10.0, 1000.0}) {
      const auto place = [](double kilograms, double x, double v) {
        return fmt::format("mass = {0}\nbox = [0.1, 0.1, 0.1]\nposition = [{1}, 0, 0]\nvelocity = [{2}, 0, 0]",
                           kilograms, x, v);
      };
      const auto s = simulationOf(head(e) + body("a", cube(0.1), place(1, 0, 0.1)) +
                                  body("b", cube(0.1), place(mass, 0.102, -0.1)));
      advanceTo(*s, 0.06);
      const double a = stateOf(*s).twist[0].v.x, b = stateOf(*s).twist[1].v.x;
      EXPECT_NEAR((b - a) / 0.2, e, 0.02 * e) << mass;
      EXPECT_NEAR(a + mass * b, 0.1 - 0.1 * mass, 1e-9 * mass) << mass;
    }
}

/// A table on four feet: all patches of a body with one normal are one contact.
TEST(BodyRestitution, HoldsForABodyOnFourFeet) {
  std::string table = "[[body]]\nname = \"table\"\nmaterial = \"a\"\nmass = 10\nbox = [0.6, 0.6, 0.1]\nposition = [0, "
                      "0, 0.0501]\nvelocity = [0, 0, -0.2]\n";
  for (const char* at : {"[0.25, 0.25, 0]", "[-0.25, 0.25, 0]", "[0.25, -0.25, 0]", "[-0.25, -0.25, 0]"})
    table += fmt::format("[[body.shape]]\n{}\nposition = {}\n", cube(0.1), at);
  const auto s = simulationOf(head(0.5) + kPlane + table);
  advanceTo(*s, 0.05);
  EXPECT_NEAR(stateOf(*s).twist[0].v.z, 0.1, 0.002);
}

/// Lowest corner of a cube of 0.1 m: height [m] and vertical speed [m/s].
std::pair<double, double> lowestCorner(const multibody::State& state) {
  const base::Mat3d turned = state.pose[0].orientation.matrix();
  std::pair<double, double> lowest{1e300, 0};
  for (const double x : {-0.05, 0.05})
    for (const double y : {-0.05, 0.05})
      for (const double z : {-0.05, 0.05}) {
        const Vec3d arm = turned * Vec3d{x, y, z};
        const double height = state.pose[0].position.z + arm.z;
        if (height < lowest.first) lowest = {height, state.twist[0].v.z + cross(state.twist[0].w, arm).z};
      }
  return lowest;
}

/// Speed of the lowest corner at the end of the first touch / before it, of a cube of 0.1 m that hits a plane without
/// friction at 0.3 m/s.
double cornerRebound(double restitution, double modulus, const std::string& orientation) {
  const auto placed = [&](double height) {
    return simulationOf(head(restitution) + fmt::format("foundation_modulus = {}\n", modulus) + kPlane +
                        body("cube", cube(0.1),
                             fmt::format("position = [0, 0, {}]\nvelocity = [0, 0, -0.3]\n{}", height, orientation)));
  };
  const auto s = placed(1e-5 + 0.2 - lowestCorner(stateOf(*placed(0.2))).first);
  while (s->time() < 0.1 && lowestCorner(stateOf(*s)).first >= 0) s->step();
  while (s->time() < 0.1 && lowestCorner(stateOf(*s)).first < 0) s->step();
  return lowestCorner(stateOf(*s)).second / 0.3;
}

/// Bodies turn while an edge or a corner touches, and the lowest corner moves. Stiffer contacts are shorter, so the
/// speeds converge to the restitution; below the centre of mass a body does not turn.
TEST(BodyRestitution, OfEdgesAndCornersConvergesToThatOfTheMaterial) {
  const double upright = std::acos(1 / std::sqrt(3.0)) * 180 / base::kPi; // a corner is below the centre
  const auto turned = [](const char* axis, double degrees) {
    return fmt::format("axis = {}\nangle = {}", axis, degrees);
  };
  std::printf("restitution:                      0.8             0.5             0.2\n"
              "foundation_modulus [N/m3]:   1e8    1e12     1e8    1e12     1e8    1e12\n");
  for (const auto& [name, orientation] : {std::pair{"edge, 45 degrees", turned("[0, 1, 0]", 45)},
                                          {"edge, 30 degrees", turned("[0, 1, 0]", 30)},
                                          {"edge, 15 degrees", turned("[0, 1, 0]", 15)},
                                          {"edge, 5 degrees", turned("[0, 1, 0]", 5)},
                                          {"corner below the centre", turned("[1, -1, 0]", upright)},
                                          {"corner, 30 degrees from it", turned("[1, -1, 0]", upright - 30)}}) {
    std::printf("%-26s", name);
    for (const double e : {0.8, 0.5, 0.2}) {
      const double soft = cornerRebound(e, 1e8, orientation), stiff = cornerRebound(e, 1e12, orientation);
      std::printf(" %7.3f %7.3f", soft, stiff);
      EXPECT_NEAR(stiff, e, 0.02) << name;
      EXPECT_LE(std::fabs(stiff - e), std::fabs(soft - e) + 1e-3) << name;
    }
    std::printf("\n");
  }
}

/// Small rocking of a box on its face is a linear oscillation: successive peaks of the angular velocity have the ratio
/// exp(-pi zeta / sqrt(1 - zeta^2)).
TEST(BodyRestitution, RockingOnAFaceHasTheDampingRatioOfTheMaterial) {
  for (const double e : {0.9, 0.8, 0.5}) {
    const auto s = simulationOf(head(e, "time_step = 1e-5") + kPlane +
                                body("b", cube(0.2),
                                     fmt::format("mass = 2\nbox = [0.2, 0.2, 0.2]\nposition = [0, 0, {}]\n"
                                                 "spin = [0, 0.002, 0]",
                                                 0.1 - 2 * kGravity / (1e8 * 0.04))));
    double low = 0, high = 0;
    while (s->time() < 0.02) {
      s->step();
      const double w = stateOf(*s).twist[0].w.y;
      if (w < low && high == 0) low = w;
      if (w > high && low < 0) high = w;
    }
    const double zeta = contact::dampingRatioFor(e, false);
    EXPECT_NEAR(high / -low, std::exp(-base::kPi * zeta / std::sqrt(1 - zeta * zeta)), 0.02) << e;
  }
}

/// Without friction nothing turns a ball or a cylinder about its axis, whatever points touch the plane.
TEST(BodyRestitution, RoundBodiesDoNotSpinWithoutFriction) {
  const auto s = simulationOf(head(0.5, "gravity = [0.7, 0.2, -9.81]") + kPlane +
                              body("ball", "kind = \"sphere\"\nradius = 0.1",
                                   "mass = 2\nposition = [0, 0, 0.0995]\naxis = [1, 2, 3]\nangle = 17") +
                              body("wheel", "kind = \"cylinder\"\nradius = 0.1\nlength = 0.06\naxis = [0, 1, 0]",
                                   "mass = 2\nposition = [0, 1, 0.0998]\naxis = [0, 1, 0]\nangle = 17"));
  advanceTo(*s, 0.5);
  EXPECT_NEAR(stateOf(*s).twist[0].v.x, 0.7 * s->time(), 1e-9);
  EXPECT_LT(norm(stateOf(*s).twist[0].w), 1e-12);
  EXPECT_LT(std::fabs(stateOf(*s).twist[1].w.y), 1e-12);
}

/// A capsule that topples on its cap rolls like a ball, and keeps its energy.
TEST(BodyRestitution, ACapsuleTopplesWithoutLoss) {
  constexpr double kRadius = 0.1, kHalf = 0.2, kMass = 2, kInertia = 0.04, kTilt = 0.3;
  const auto s = simulationOf(
      head(0.3, "", 0.6) + kPlane +
      body("b", fmt::format("kind = \"capsule\"\nradius = {}\nlength = {}", kRadius, 2 * kHalf),
           fmt::format("mass = {}\ninertia = [{}, {}, 0.01]\nposition = [0, 0, {}]\naxis = [0, 1, 0]\nangle = {}",
                       kMass, kInertia, kInertia, kRadius + kHalf * std::cos(kTilt) - 5e-4, kTilt * 180 / base::kPi)));
  const auto energy = [&] {
    const multibody::Twist& t = stateOf(*s).twist[0];
    return 0.5 * kMass * norm2(t.v) + 0.5 * kInertia * norm2(t.w) + kMass * kGravity * stateOf(*s).pose[0].position.z;
  };
  advanceTo(*s, 0.05);
  const double before = energy(), height = stateOf(*s).pose[0].position.z;
  while (stateOf(*s).pose[0].position.z > kRadius + 0.5 * kHalf) s->step();
  const double fallen = kMass * kGravity * (height - stateOf(*s).pose[0].position.z);
  EXPECT_NEAR(energy(), before, 0.005 * fallen);
}

/// A ball and a wheel keep their speed at any restitution, and a ball gains 5/7 g sin on a slope.
TEST(BodyRestitution, RoundBodiesRollFreely) {
  for (const double e : {1.0, 0.4, 0.05})
    for (const double v : {1.0, 4.0}) {
      const std::string motion = fmt::format("mass = 2\nvelocity = [{}, 0, 0]\nspin = [0, {}, 0]\n", v, 10 * v);
      const auto s =
          simulationOf(head(e, "", 0.6) + kPlane +
                       body("ball", "kind = \"sphere\"\nradius = 0.1", motion + "position = [0, 0, 0.0995]") +
                       body("wheel", "kind = \"cylinder\"\nradius = 0.1\nlength = 0.06\naxis = [0, 1, 0]",
                            motion + "position = [0, 1, 0.0998]"));
      advanceTo(*s, 1.2);
      for (int b = 0; b < 2; ++b)
        EXPECT_NEAR(stateOf(*s).twist[static_cast<std::size_t>(b)].v.x, v, 1e-3 * v) << e << ", body " << b;
    }
  const double angle = 0.2;
  const auto s = simulationOf(
      head(0.3, fmt::format("gravity = [{}, 0, {}]", kGravity * std::sin(angle), -kGravity * std::cos(angle)), 0.6) +
      kPlane + body("ball", "kind = \"sphere\"\nradius = 0.1", "mass = 2\nposition = [0, 0, 0.0995]"));
  advanceTo(*s, 0.3);
  const double before = stateOf(*s).twist[0].v.x;
  advanceTo(*s, 0.8);
  EXPECT_NEAR((stateOf(*s).twist[0].v.x - before) / 0.5, 5.0 / 7 * kGravity * std::sin(angle), 0.005 * kGravity);
}

/// At the automatic step, at any restitution, bodies come to rest at W / (K A).
TEST(BodyRestitution, BodiesComeToRestAtLowRestitution) {
  for (const double e : {0.2, 0.1, 0.05, 0.01})
    for (const auto& [size, height] : {std::pair{"[0.2, 0.2, 0.1]", 0.1}, {"[0.5, 0.5, 0.02]", 0.02}}) {
      const double half = 0.5 * height;
      const auto s = simulationOf(
          head(e, "", 0.3) + kPlane +
          body("b", fmt::format("kind = \"box\"\nsize = {}", size), fmt::format("position = [0, 0, {}]", half + 0.01)));
      advanceTo(*s, 0.6);
      const double deep = 500 * height * kGravity / 1e8;
      EXPECT_NEAR(half - stateOf(*s).pose[0].position.z, deep, 0.02 * deep) << e << " " << size;
      EXPECT_LT(norm(stateOf(*s).twist[0].v), 1e-6) << e << " " << size;
    }
}

TEST(BodyRestitution, ATooDeepOverlapEndsTheRun) {
  const auto messageOf = [](const std::string& more) -> std::string {
    const auto s =
        simulationOf(head(0.3, "", 0.5) + kPlane +
                     body("light", cube(0.1), "mass = 1\nbox = [0.1, 0.1, 0.1]\nposition = [0, 0, 0.05]\n" + more) +
                     body("heavy", cube(0.1), "mass = 1000\nbox = [0.1, 0.1, 0.1]\nposition = [0, 0, 0.15]"));
    try {
      advanceTo(*s, 0.5);
    } catch (const base::SimulationError& error) {
      EXPECT_EQ(error.cause(), base::Cause::excessiveOverlap);
      return error.what();
    }
    return "";
  };
  EXPECT_NE(messageOf("").find("body \"light\" overlaps body \"heavy\" by more than 0.025 m"), std::string::npos)
      << messageOf("");
  const std::string sooner = messageOf("largest_overlap = 0.002\n");
  EXPECT_NE(sooner.find("more than 0.002 m"), std::string::npos) << sooner;
  EXPECT_NE(sooner.find("foundation_modulus"), std::string::npos) << sooner;
}

} // namespace
} // namespace grouser::coupling::restitution
