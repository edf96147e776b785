// SPDX-License-Identifier: BSD-3-Clause
// Meshes that are exactly boxes, and meshes that are not.
#include "spheredecomp/mesh_box.hpp"

#include "spheredecomp/mesh.hpp"
#include "tests/spheredecomp/shapes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

namespace grouser::spheredecomp {
namespace {

/// Single precision of coordinates up to 1 m, plus six digits of a text file.
constexpr double kSinglePrecision = 1e-7, kSixDigits = 2e-6;

/// Turned about a skew axis, moved, and rounded to single precision, as a mesh file is read.
TriangleMesh placed(TriangleMesh mesh, const base::Quat& turn, const Vec3d& shift) {
  for (Vec3d& v : mesh.vertices) v = (rotate(turn, v) + shift).as<float>().as<double>();
  return mesh;
}

TriangleMesh rounded(TriangleMesh mesh) {
  for (Vec3d& v : mesh.vertices)
    for (int k = 0; k < 3; ++k) v[k] = std::round(v[k] * 1e6) * 1e-6;
  return mesh;
}

/// Every triangle cut into four; corners of edges are not shared.
TriangleMesh refined(const TriangleMesh& mesh) {
  TriangleMesh fine;
  for (std::size_t t = 0; t + 2 < mesh.indices.size(); t += 3) {
    const auto at = [&](std::size_t k) { return mesh.vertices[mesh.indices[t + k]]; };
    const auto first = static_cast<std::uint32_t>(fine.vertices.size());
    fine.vertices.insert(fine.vertices.end(),
                         {at(0), at(1), at(2), (at(0) + at(1)) * 0.5, (at(1) + at(2)) * 0.5, (at(2) + at(0)) * 0.5});
    for (const std::uint32_t i : {0, 3, 5, 3, 1, 4, 5, 4, 2, 3, 4, 5}) fine.indices.push_back(first + i);
  }
  return fine;
}

/// Largest distance of a corner of the box from the given point set.
double farthestCorner(const MeshBox& box, const std::vector<Vec3d>& points) {
  double most = 0;
  for (int c = 0; c < 8; ++c) {
    const Vec3d p{c & 1 ? box.half.x : -box.half.x, c & 2 ? box.half.y : -box.half.y, c & 4 ? box.half.z : -box.half.z};
    double nearest = base::kInfinity;
    for (const Vec3d& v : points) nearest = std::min(nearest, norm(box.centre + rotate(box.orientation, p) - v));
    most = std::max(most, nearest);
  }
  return most;
}

const Vec3d kLow{-0.2, -0.2, -0.001}, kHigh{0.2, 0.2, 0};
const base::Quat kSkew = base::Quat{0.9, 0.3, -0.2, 0.25}.normalized();

TEST(ExactBox, AnAlignedSheetHasExactlyItsEdges) {
  const TriangleMesh sheet = shapes::box(kLow, kHigh);
  for (const TriangleMesh& mesh : {sheet, refined(sheet), refined(refined(sheet))}) {
    const auto box = exactBox(mesh);
    ASSERT_TRUE(box);
    EXPECT_EQ(box->half, (Vec3d{0.2, 0.2, 0.0005}));
    EXPECT_EQ(box->centre, (Vec3d{0, 0, -0.0005}));
    EXPECT_EQ(box->orientation.w, 1);
  }
}

TEST(ExactBox, TurnedBoxesHaveTheCornersOfTheMesh) {
  for (const TriangleMesh& mesh : {shapes::box(kLow, kHigh), shapes::box({-0.1, 0, 0.3}, {0.1, 0.3, 0.4}),
                                   shapes::box({-0.05, -0.05, -0.05}, {0.05, 0.05, 0.05})}) {
    const TriangleMesh turned = placed(mesh, kSkew, {0.3, -0.1, 0.2});
    for (const TriangleMesh& each :
         {turned, rounded(turned), placed(refined(refined(mesh)), kSkew, {0.3, -0.1, 0.2})}) {
      const auto box = exactBox(each);
      ASSERT_TRUE(box);
      EXPECT_LT(farthestCorner(*box, each.vertices), kSixDigits);
      EXPECT_NEAR(norm(rotate(box->orientation, {1, 1, 1})), std::sqrt(3.0), 1e-12);
    }
    EXPECT_LT(farthestCorner(*exactBox(turned), turned.vertices), 3 * kSinglePrecision);
  }
}

TEST(ExactBox, OtherMeshesAreNone) {
  const TriangleMesh cube = shapes::box({-0.05, -0.05, -0.05}, {0.05, 0.05, 0.05});
  const auto moved = [&](std::size_t vertex, const Vec3d& by) {
    TriangleMesh mesh = cube;
    mesh.vertices[vertex] += by;
    return mesh;
  };
  EXPECT_TRUE(exactBox(moved(7, {1e-8, 0, 0}))) << "rounding";
  EXPECT_FALSE(exactBox(moved(7, {1e-5, 0, 0})));
  EXPECT_FALSE(exactBox(moved(7, {1e-5, 1e-5, 1e-5})));
  EXPECT_FALSE(exactBox(shapes::box({-0.04, -0.04, -0.04}, {0.04, 0.04, 0.04}, cube))) << "nested";
  EXPECT_FALSE(exactBox(shapes::box({-0.05, -0.05, -0.05}, {0.05, 0.05, 0.05}, cube))) << "volume counted twice";
  EXPECT_FALSE(exactBox(shapes::box({-0.05, -0.05, 0.05}, {0.05, 0.04, 0.1}, cube))) << "a step";
  EXPECT_FALSE(exactBox(shapes::ball(0.1, 24)));
  EXPECT_FALSE(exactBox(shapes::cylinder(0.1, 0.2, 24)));
  TriangleMesh leaning = cube; // a parallelepiped
  for (Vec3d& v : leaning.vertices) v.x += 0.01 * v.z;
  EXPECT_FALSE(exactBox(leaning));
  // Split along a plane without a gap: two shells, which together are the box.
  EXPECT_FALSE(exactBox(
      shapes::box({-0.05, -0.05, 0}, {0.05, 0.05, 0.05}, shapes::box({-0.05, -0.05, -0.05}, {0.05, 0.05, 0}))));
  EXPECT_FALSE(exactBox({}));
}

} // namespace
} // namespace grouser::spheredecomp
