// SPDX-License-Identifier: BSD-3-Clause
// Properties of a sphere set: scaling, and separate areas of each face of a box.
#include "spheredecomp/quality.hpp"

#include "shapes.hpp"
#include "spheredecomp/decompose.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace grouser::spheredecomp {
namespace {

using base::Vec3d;

TEST(Quality, DistancesAreLengthsAndRatiosHaveNone) {
  const TriangleMesh small = shapes::cylinder(0.03, 0.04, 48);
  TriangleMesh large = small;
  for (Vec3d& v : large.vertices) v *= 2;
  const Quality a = measure(small, shapes::cut(small, 0.006)), b = measure(large, shapes::cut(large, 0.012));
  ASSERT_EQ(a.surfaceCount, b.surfaceCount);
  // Doubling is exact in binary, but not in the angles and roots between: round-off.
  for (const auto& [one, two] : {std::pair{a.spheres, b.spheres}, {a.discs, b.discs}}) {
    EXPECT_NEAR(two.rms / one.rms, 2, 1e-6);
    EXPECT_NEAR(two.meshToSet / one.meshToSet, 2, 1e-6);
    EXPECT_NEAR(two.setToMesh / one.setToMesh, 2, 1e-6);
    EXPECT_LT(one.rms, one.meshToSet);
    EXPECT_GT(one.rms, 0.02 * one.meshToSet);
  }
  EXPECT_NEAR(b.volumeRatio, a.volumeRatio, 1e-6);
  EXPECT_NEAR(b.areaRatio, a.areaRatio, 1e-6);
}

TEST(Quality, EachFaceOfABoxHasItsOwnArea) {
  const Vec3d size{0.2, 0.12, 0.08};
  const SphereSet set = shapes::cut(shapes::box({0, 0, 0}, size), 0.01);
  const double faces[3] = {size.y * size.z, size.x * size.z, size.x * size.y};
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {1.0, -1.0}) {
      double area = 0;
      for (std::size_t i = 0; i < set.surfaceCount; ++i)
        if (set.spheres[i].normal[axis] * side > 0.9) area += set.spheres[i].area;
      EXPECT_NEAR(area, faces[axis], 1e-9) << axis << " " << side;
    }
}

} // namespace
} // namespace grouser::spheredecomp
