// SPDX-License-Identifier: BSD-3-Clause
#include "base/math.hpp"
#include "spheredecomp/decompose.hpp"
#include "spheredecomp/detail/outer_surface.hpp"
#include "spheredecomp/mesh.hpp"
#include "spheredecomp/mesh_query.hpp"
#include "spheredecomp/quality.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>

namespace grouser::spheredecomp {
namespace {

using base::Pose;

constexpr double kDegree = base::kPi / 180;
constexpr double kPitch = 0.154;
constexpr double kSprocketPinRadius = 0.249177;

TriangleMesh part(const std::string& name) {
  return importMesh(std::string(GROUSER_SOURCE_DIR) + "/assets/meshes/" + name + ".obj");
}

/// A rotation about y by `angle` [rad] and a translation.
Pose pose(double angle, const Vec3d& position) {
  return {position, {base::cos(angle / 2), 0, base::sin(angle / 2), 0}};
}

/// Depth of the deepest point of A's outer surface inside B [m], 0 without overlap; A is placed in B's frame.
double penetration(const std::vector<detail::SurfaceSample>& a, const Pose& pose_BA, const MeshQuery& b) {
  double deepest = 0;
  for (const auto& sample : a) {
    const Vec3d p = pose_BA.toWorld(sample.point);
    if (b.inside(p)) deepest = std::max(deepest, b.closest(p).distance);
  }
  return deepest;
}

std::vector<detail::SurfaceSample> samplesOf(const TriangleMesh& mesh) {
  return detail::OuterSurface(mesh, 0.004).samples(0.004);
}

/// The next shoe along +x, rotated about the common pin by `fold`: positive lifts its far end towards the wheels.
Pose nextShoe(double fold) {
  const Pose turn = pose(-fold, {});
  return {Vec3d{kPitch / 2, 0, 0} + base::rotate(turn.orientation, {kPitch / 2, 0, 0}), turn.orientation};
}

TEST(VehicleMesh, EveryPart_IsWatertightWithPositiveVolume) {
  for (const char* name : {"shoe", "road_wheel", "roller", "idler", "sprocket", "chassis"})
    EXPECT_GT(signedVolume(part(name)), 0) << name;
}

TEST(VehicleMesh, NeighbouringShoes_ClearEachOtherAtEveryFold) {
  const TriangleMesh mesh = part("shoe");
  const MeshQuery shoe(mesh);
  const auto samples = samplesOf(mesh);
  for (const double degrees : {-20.0, -10.0, 0.0, 10.4, 20.0, 36.0, 40.0}) {
    const Pose next = nextShoe(degrees * kDegree);
    EXPECT_EQ(penetration(samples, next, shoe), 0) << degrees;
    const Pose back{-base::rotate(next.orientation.conjugate(), next.position), next.orientation.conjugate()};
    EXPECT_EQ(penetration(samples, back, shoe), 0) << degrees;
  }
  // The check can detect a collision: folded outwards by 40 degrees the pads overlap.
  EXPECT_GT(penetration(samples, nextShoe(-40 * kDegree), shoe), 0.001);
}

TEST(VehicleMesh, SprocketSeat_HoldsThePinWithItsClearance) {
  const MeshQuery sprocket(part("sprocket"));
  for (int k = 0; k < 10; ++k) {
    const double angle = 36 * k * kDegree;
    const Vec3d pin{kSprocketPinRadius * base::cos(angle), 0.16, kSprocketPinRadius * base::sin(angle)};
    // Chords of the seat arc of 7.5 degrees are 0.04 mm inside it.
    EXPECT_NEAR(sprocket.signedDistance(pin), 0.0185, 5e-5) << k;
  }
}

TEST(VehicleMesh, ShoeOnSprocket_TouchesNothingButItsSeats) {
  const TriangleMesh mesh = part("shoe");
  const auto samples = samplesOf(mesh);
  const MeshQuery sprocket(part("sprocket"));
  // Middle of the shoe at 18 degrees, its z axis towards the axle: pins in gaps 0 and 1.
  const double middle = 18 * kDegree, height = kSprocketPinRadius * base::cos(middle);
  const Pose seated = pose(-middle - base::kPi / 2, {height * base::cos(middle), 0, height * base::sin(middle)});
  const Vec3d boss = seated.toWorld({kPitch / 2, 0.16, 0});
  ASSERT_NEAR(base::atan2(boss.z, boss.x), 36 * kDegree, 1e-6);
  ASSERT_NEAR(std::sqrt(boss.x * boss.x + boss.z * boss.z), kSprocketPinRadius, 1e-6);
  EXPECT_EQ(penetration(samples, seated, sprocket), 0);
  // All except the bosses stays more than 5 mm away, including hub and horn.
  double nearest = 1;
  for (const auto& sample : samples)
    if (std::abs(sample.point.y) < 0.1449)
      nearest = std::min(nearest, sprocket.closest(seated.toWorld(sample.point)).distance);
  EXPECT_GT(nearest, 0.005);
}

TEST(VehicleMesh, WheelsOnShoe_TouchThePlatesAndClearTheHorn) {
  const TriangleMesh mesh = part("shoe");
  const auto samples = samplesOf(mesh);
  for (const auto& [name, radius] : {std::pair{"road_wheel", 0.19}, {"roller", 0.09}, {"idler", 0.217}}) {
    const MeshQuery wheel(part(name));
    for (const double x : {-0.06, 0.0, 0.03}) {
      const Pose shoe{{x, 0, -radius - 0.020}, {}};
      // Rim corners protrude from the mean circle by at most radius (pi / 128)^2 / 3 = 0.04 mm.
      EXPECT_LT(penetration(samples, shoe, wheel), 5e-5) << name << x;
    }
  }
}

TEST(VehicleMesh, Decomposition_MeetsItsFigures) {
  for (const double radius : {0.010, 0.005})
    for (const char* name : {"shoe", "road_wheel", "roller", "idler", "sprocket"}) {
      // Wheels at 5 mm would dominate the test time of this folder and test nothing new.
      if (radius < 0.01 && std::string(name) != "shoe") continue;
      const TriangleMesh mesh = part(name);
      DecompositionOptions options;
      options.radius = radius;
      const SphereSet set = decompose(mesh, name, options);
      const Quality q = measure(mesh, set);
      std::cout << report(set, q);
      // Right-angled corners are rounded by (sqrt 3 - 1) r = 0.73 r; the feet of the shoe's plates are slightly
      // sharper.
      EXPECT_LT(q.discs.hausdorff(), 0.8 * radius) << name;
      // flatTolerance for discs, and the facets of rims.
      EXPECT_LT(q.discs.protrusion, 0.02 * radius) << name;
      EXPECT_NEAR(q.areaRatio, 1, 1e-9) << name;
      EXPECT_GT(q.volumeRatio, 0.85) << name;
      EXPECT_LT(q.volumeRatio, 1.0) << name;
    }
}

} // namespace
} // namespace grouser::spheredecomp
