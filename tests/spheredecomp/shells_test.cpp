// SPDX-License-Identifier: BSD-3-Clause
// Overlapping, nested, repeated and inverted shells of a mesh.
#include "spheredecomp/shells.hpp"

#include "tests/spheredecomp/shapes.hpp"

#include <gtest/gtest.h>

#include <array>
#include <utility>

namespace grouser::spheredecomp {
namespace {

/// Appends a second mesh, moved; `inverted`: with its faces reversed.
TriangleMesh joined(TriangleMesh mesh, const TriangleMesh& other, const Vec3d& shift, bool inverted = false) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const Vec3d& v : other.vertices) mesh.vertices.push_back(v + shift);
  for (std::size_t t = 0; t + 2 < other.indices.size(); t += 3)
    for (const std::size_t k : inverted ? std::array<std::size_t, 3>{0, 2, 1} : std::array<std::size_t, 3>{0, 1, 2})
      mesh.indices.push_back(first + other.indices[t + k]);
  return mesh;
}

std::optional<ShellFault> faultOf(const TriangleMesh& mesh) { return shellFault(MeshQuery(mesh)); }
bool overlaps(const TriangleMesh& mesh) {
  const auto fault = faultOf(mesh);
  return fault && fault->kind == ShellFault::Kind::overlap;
}

const TriangleMesh kCube = shapes::box({0, 0, 0}, {1, 1, 1});

TEST(ShellFault, ARepeatedShellOverlapsAtAnyOffset) {
  const TriangleMesh rod = shapes::box({0, 0, 0}, {1, 0.02, 0.02}), sheet = shapes::box({0, 0, 0}, {1, 1, 0.0025});
  const TriangleMesh ball = shapes::ball(0.5, 32), pipe = shapes::cylinder(0.1, 2, 48);
  for (const TriangleMesh& part : {kCube, rod, sheet, ball, pipe})
    for (const double shift : {0.0, 1e-7, 1e-5, 1e-4, 1e-3})
      for (const Vec3d& way : {Vec3d{1, 0, 0}, {0, 0, 1}, {0.6, 0.48, 0.64}})
        EXPECT_TRUE(overlaps(joined(part, part, way * shift))) << shift << " m along " << way.x;
  // Along the rod only its ends, 1/202 of its area, are inside the other one.
  EXPECT_TRUE(overlaps(joined(rod, rod, {0.01, 0, 0})));
}

TEST(ShellFault, NestedAndOverlappingShellsAreFoundWithTheirPlace) {
  const TriangleMesh inner = shapes::box({0.2, 0.2, 0.2}, {0.8, 0.8, 0.8});
  const auto nested = faultOf(joined(kCube, inner, {}));
  ASSERT_TRUE(nested);
  EXPECT_EQ(nested->kind, ShellFault::Kind::overlap);
  EXPECT_NEAR(nested->share, 0.36 / 1.36, 1e-9) << "the area of the inner cube";
  EXPECT_TRUE(nested->place.x >= 0.2 && nested->place.x <= 0.8);
  // Corners of 0.3 m overlap: three faces of 0.09 m2 of each cube, of 12 m2.
  const auto corner = faultOf(joined(kCube, kCube, {0.7, 0.7, 0.7}));
  ASSERT_TRUE(corner);
  EXPECT_NEAR(corner->share, 6 * 0.09 / 12, 0.1 * 6 * 0.09 / 12) << "pieces of a fortieth of the diagonal";
  for (int k = 0; k < 3; ++k) EXPECT_TRUE(corner->place[k] >= 0.7 && corner->place[k] <= 1);
}

TEST(ShellFault, HollowTouchingAndSeparateShellsPass) {
  const TriangleMesh inner = shapes::box({0.01, 0.01, 0.01}, {0.99, 0.99, 0.99});
  EXPECT_FALSE(faultOf(kCube));
  EXPECT_FALSE(faultOf(shapes::box({0, 0, 0}, {1, 1, 1e-5}))) << "thinner than the distance of the points";
  EXPECT_FALSE(faultOf(joined(kCube, inner, {}, true))) << "hollow";
  EXPECT_FALSE(faultOf(joined(joined(kCube, inner, {}, true), shapes::ball(0.2, 24), {0.5, 0.5, 0.5})))
      << "a ball in the hollow";
  EXPECT_FALSE(faultOf(joined(kCube, kCube, {1, 0, 0}))) << "one face in common";
  EXPECT_FALSE(faultOf(joined(kCube, kCube, {1 - 1e-7, 0, 0}))) << "one face in common, rounded";
  EXPECT_FALSE(faultOf(joined(kCube, kCube, {1.01, 0.3, 0})));
  EXPECT_FALSE(faultOf(shapes::ball(0.5, 48)));
}

TEST(ShellFault, AnInvertedShellOutsideTheOthersIsFound) {
  const TriangleMesh small = shapes::box({0, 0, 0}, {0.5, 0.5, 0.5});
  const auto fault = faultOf(joined(kCube, small, {1.5, 0, 0}, true));
  ASSERT_TRUE(fault);
  EXPECT_EQ(fault->kind, ShellFault::Kind::inverted);
  EXPECT_NEAR(fault->share, 1.5 / 7.5, 1e-9);
  EXPECT_GT(fault->place.x, 1.4);
}

} // namespace
} // namespace grouser::spheredecomp
