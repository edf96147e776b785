// SPDX-License-Identifier: BSD-3-Clause
// Distances from rigid surfaces in closed form, and the travel of a surface that requires a rebuild.
#include "base/random.hpp"
#include "terrain/rigid_surface.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace grouser::terrain {
namespace {

using base::Vec3d;

const SurfaceGeometry kPlane{SurfaceShape::plane, {}};
const SurfaceGeometry kBox{SurfaceShape::box, {1, 2, 3}};
const SurfaceGeometry kCylinder{SurfaceShape::cylinder, {0.5, 0, 2}};
const SurfaceGeometry kTube{SurfaceShape::tube, {0.5, 0, 2}};

constexpr double kRoundOff = 8 * 0x1p-52 * 4; // a few operations on numbers up to 4

void expectGap(const SurfaceGeometry& surface, const Vec3d& p, double distance, const Vec3d& normal) {
  const SurfaceGap gap = gapTo(surface, p);
  EXPECT_NEAR(gap.distance, distance, kRoundOff) << p.x << " " << p.y << " " << p.z;
  EXPECT_LT(norm(gap.normal - normal), kRoundOff) << p.x << " " << p.y << " " << p.z;
}

TEST(RigidSurface, PlaneIsItsHeight) {
  expectGap(kPlane, {7, -3, 0.25}, 0.25, {0, 0, 1});
  expectGap(kPlane, {7, -3, -0.25}, -0.25, {0, 0, 1});
}

TEST(RigidSurface, BoxHasFacesEdgesAndCorners) {
  expectGap(kBox, {1.5, 0.3, -0.2}, 0.5, {1, 0, 0});
  expectGap(kBox, {0.3, -2.25, 1}, 0.25, {0, -1, 0});
  expectGap(kBox, {1.3, 2.4, 0}, 0.5, {0.6, 0.8, 0});               // an edge, 3-4-5
  expectGap(kBox, {-2, -4, -5}, 3, {-1.0 / 3, -2.0 / 3, -2.0 / 3}); // a corner, 1-2-2
  expectGap(kBox, {0.9, 0, 0}, -0.1, {1, 0, 0});                    // inside: out by the nearest face
  expectGap(kBox, {0.1, -1.95, 2.9}, -0.05, {0, -1, 0});
}

TEST(RigidSurface, CylinderHasAWallEndsAndRims) {
  expectGap(kCylinder, {0.6, 0.8, 1}, 0.5, {0.6, 0.8, 0});
  expectGap(kCylinder, {0.1, 0.2, -2.75}, 0.75, {0, 0, -1});
  expectGap(kCylinder, {0, 0.8, 2.4}, 0.5, {0, 0.6, 0.8}); // a rim
  expectGap(kCylinder, {0.4, 0, 0}, -0.1, {1, 0, 0});
  expectGap(kCylinder, {0.1, 0, 1.95}, -0.05, {0, 0, 1});
}

TEST(RigidSurface, TubeIsFeltFromBothSides) {
  expectGap(kTube, {0, 0.7, 1}, 0.2, {0, 1, 0});
  expectGap(kTube, {0, 0.3, 1}, 0.2, {0, -1, 0});
  expectGap(kTube, {0, 0.8, 2.4}, 0.5, {0, 0.6, 0.8});  // its rim, from outside
  expectGap(kTube, {0, 0.2, 2.4}, 0.5, {0, -0.6, 0.8}); // and from inside
}

/// A random number in [-1, 1).
double randomNumber(int i, int k) {
  return 2 * base::uniform(3, base::purpose("test.surface"), static_cast<std::uint64_t>(i),
                           static_cast<std::uint64_t>(k)) -
         1;
}

TEST(RigidSurface, NormalIsTheGradientOfTheDistance) {
  constexpr double kStep = 1e-6;
  for (const SurfaceGeometry& surface : {kPlane, kBox, kCylinder, kTube})
    for (int i = 0; i < 2000; ++i) {
      const Vec3d p{3 * randomNumber(i, 0), 3 * randomNumber(i, 1), 4 * randomNumber(i, 2)};
      const SurfaceGap gap = gapTo(surface, p);
      EXPECT_NEAR(norm(gap.normal), 1, kRoundOff);
      // Where the nearest point jumps, the distance has no gradient: nearby, both sides agree.
      const Vec3d towards = gap.normal * kStep;
      const double slope = (gapTo(surface, p + towards).distance - gapTo(surface, p - towards).distance) / (2 * kStep);
      if (std::fabs(gap.distance) > 2 * kStep) {
        EXPECT_LT(slope, 1 + 1e-8);
        if (gap.distance > 0 && surface.shape != SurfaceShape::tube) {
          EXPECT_GT(slope, 1 - 1e-8) << i;
        }
      }
    }
}

/// A surface rotated by `angle` about `axis` from its upright pose.
SurfacePose posed(const Vec3d& centre, const Vec3d& axis, double angle) {
  const Vec3d n = normalized(axis) * std::sin(0.5 * angle);
  SurfacePose pose;
  pose.motion.origin = pose.motion.centre = centre;
  pose.motion.rotation = base::Quat{std::cos(0.5 * angle), n.x, n.y, n.z}.matrix();
  return pose;
}

TEST(RigidSurface, NoPointsDistanceChangesByMoreThanTheTravel) {
  for (const SurfaceGeometry& surface : {kPlane, kBox, kCylinder, kTube}) {
    double closest = 0; // share of the bound
    for (int i = 0; i < 4000; ++i) {
      const auto r = [&](int k) { return randomNumber(i, k); };
      const SurfacePose a = posed({r(0), r(1), r(2)}, {r(3), r(4), r(5) + 1.5}, 3 * r(6));
      SurfacePose b = posed(a.motion.centre + Vec3d{r(7), r(8), r(9)} * 0.1, {r(10), r(11), r(12) + 1.5}, 0.1 * r(13));
      b.motion.rotation = b.motion.rotation * a.motion.rotation;
      const Vec3d p = a.motion.centre + Vec3d{r(14), r(15), r(16)} * 3.0;
      const double change =
          std::fabs(gapTo(surface, b.motion.toPart(p)).distance - gapTo(surface, a.motion.toPart(p)).distance);
      const SurfaceTravel travel = travelBetween(surface, a, b);
      const double bound = travel.way + travel.turn * norm(p - a.motion.centre);
      EXPECT_LE(change, bound + kRoundOff);
      closest = std::max(closest, change / bound);
    }
    EXPECT_GT(closest, 0.5) << "the bound is tight";
  }
}

TEST(RigidSurface, WhatLeavesASurfaceWhereItIsCountsAsNoTravel) {
  const SurfacePose at = posed({1, 2, 3}, {0, 0, 1}, 0);
  const SurfaceTravel slid = travelBetween(kPlane, at, posed({5, -1, 3}, {0, 0, 1}, 1.0)); // along itself
  EXPECT_EQ(slid.way, 0);
  EXPECT_EQ(slid.turn, 0);
  const SurfaceTravel spun = travelBetween(kCylinder, at, posed({1, 2, 3}, {0, 0, 1}, 1.0)); // about its axis
  EXPECT_EQ(spun.way, 0);
  EXPECT_EQ(spun.turn, 0);
  EXPECT_GT(travelBetween(kBox, at, posed({1, 2, 3}, {0, 0, 1}, 1.0)).turn, 0.9) << "a box has corners";
}

} // namespace
} // namespace grouser::terrain
