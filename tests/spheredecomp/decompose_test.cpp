// SPDX-License-Identifier: BSD-3-Clause
#include "spheredecomp/decompose.hpp"

#include "base/error.hpp"
#include "shapes.hpp"
#include "spheredecomp/detail/rounded_disc.hpp"
#include "spheredecomp/mesh.hpp"
#include "spheredecomp/quality.hpp"

#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace grouser::spheredecomp {
namespace {

using base::SetSphere;
using base::Vec3d;

const Vec3d kHalf{0.1, 0.08, 0.06};
TriangleMesh testBox() { return shapes::box(-kHalf, kHalf); }

double areaOf(const SphereSet& set) {
  double sum = 0;
  for (const SetSphere& s : set.spheres) sum += s.area;
  return sum;
}

TEST(Decompose, Box_NormalsAndPlanesAreExact) {
  const SphereSet set = shapes::cut(testBox(), 0.01);
  ASSERT_GT(set.surfaceCount, 0u);
  for (std::size_t i = 0; i < set.surfaceCount; ++i) {
    const SetSphere& s = set.spheres[i];
    const Vec3d n = s.normal;
    ASSERT_EQ(std::abs(n.x) + std::abs(n.y) + std::abs(n.z), 1.0);
    ASSERT_DOUBLE_EQ(s.offset, std::abs(n.x) * kHalf.x + std::abs(n.y) * kHalf.y + std::abs(n.z) * kHalf.z);
    // A fitted sphere may protrude by kFitTolerance; lattice spheres are exact.
    ASSERT_LE(dot(n, s.centre) + s.radius, s.offset + 1e-15);
    ASSERT_EQ(s.radius, 0.01);
  }
  for (std::size_t i = set.surfaceCount; i < set.spheres.size(); ++i) ASSERT_FALSE(set.spheres[i].surface());
}

TEST(Decompose, Box_DiscsStayInsideAndEdgesHaveNone) {
  const double r = 0.01;
  const SphereSet set = shapes::cut(testBox(), r);
  std::size_t edge = 0, face = 0;
  for (std::size_t i = 0; i < set.surfaceCount; ++i) {
    const SetSphere& s = set.spheres[i];
    int facesTouched = 0;
    for (int k = 0; k < 3; ++k) {
      const double depth = kHalf[k] - std::abs(s.centre[k]);
      facesTouched += depth < 1.01 * r;
      // Extent of a disc along axis k; 1 % of the radius is DecompositionOptions::flatTolerance.
      const double across = s.flat * std::sqrt(std::max(0.0, 1 - s.normal[k] * s.normal[k]));
      EXPECT_GE(depth - across, 0.99 * r - 1e-12);
    }
    if (facesTouched > 1) {
      ++edge;
      EXPECT_LT(s.flat, 0.02 * r);
    }
    if (s.flat > 0.7 * r) ++face;
  }
  EXPECT_GT(edge, 50u);
  EXPECT_GT(face, 200u);
}

TEST(Decompose, Box_SurfaceAboveAFaceIsThePlaneWithoutBumps) {
  const double r = 0.01;
  const SphereSet set = shapes::cut(testBox(), r);
  // A probe slides over the top face, farther than 2 r from its edges: the nearest rounded disc is the plane.
  for (double x = -0.08; x <= 0.08; x += 0.0013)
    for (double y = -0.06; y <= 0.06; y += 0.0017) {
      double nearest = 1;
      for (std::size_t i = 0; i < set.surfaceCount; ++i)
        nearest = std::min(nearest, detail::discDistance(set.spheres[i], {x, y, kHalf.z + 0.02}));
      ASSERT_NEAR(nearest, 0.02, 1e-15) << x << " " << y;
    }
}

TEST(Decompose, AreasAddUpToTheMeshArea) {
  for (const TriangleMesh& mesh : {testBox(), shapes::ball(0.1, 64), shapes::cylinder(0.1, 0.1, 64)}) {
    const SphereSet set = shapes::cut(mesh, 0.012);
    // Round-off of a sum of 1e5 terms.
    EXPECT_NEAR(areaOf(set), area(mesh), 1e-12);
    EXPECT_NEAR(set.meshArea, area(mesh), 1e-12);
    EXPECT_NEAR(set.meshVolume, signedVolume(mesh), 1e-15);
  }
}

TEST(Decompose, Count_GrowsAsVolumeOverSpacingCubed) {
  const TriangleMesh mesh = shapes::ball(0.1, 64);
  for (const double r : {0.016, 0.008}) {
    const double lattice = signedVolume(mesh) / (r * r * r);
    // The shell has one layer instead of 1.5, and holes are closed: within a share that decreases with r.
    EXPECT_NEAR(static_cast<double>(shapes::cut(mesh, r).spheres.size()) / lattice, 1, 3 * r / 0.1) << r;
  }
}

TEST(Decompose, TargetCount_IsMetWithinAFewPerCent) {
  DecompositionOptions options;
  options.targetCount = 4000;
  const std::size_t count = decompose(shapes::cylinder(0.1, 0.15, 48), "part", options).spheres.size();
  EXPECT_GE(count, 4000u);
  EXPECT_LE(count, 4200u);
}

TEST(Decompose, HausdorffDistance_ShrinksWithTheSpacing) {
  // A box corner lies (sqrt 3 - 1) r off the sphere that rounds it; 3 % of r more for corner spheres fitted beside the
  // diagonal.
  double before = 1;
  for (const double r : {0.02, 0.01, 0.005}) {
    const Quality q = measure(testBox(), shapes::cut(testBox(), r));
    EXPECT_LT(q.discs.hausdorff(), (std::sqrt(3.0) - 1 + 0.03) * r);
    EXPECT_LT(q.discs.hausdorff(), 0.6 * before);
    EXPECT_LT(q.discs.protrusion, 0.01 * r);
    EXPECT_LT(q.discs.rms, q.spheres.rms);
    before = q.discs.hausdorff();
  }
}

TEST(Decompose, RoundParts_AreSmoothToTheDipAsked) {
  DecompositionOptions options;
  options.radius = 0.01;
  const TriangleMesh mesh = shapes::ball(0.1, 96);
  for (const double dip : {0.1, 0.03}) {
    options.maxDip = dip;
    const Quality q = measure(mesh, decompose(mesh, "ball", options));
    // Between the tested samples, 0.33 r apart, the surface may be lower: see DecompositionOptions::maxDip.
    const double farthest = std::sqrt(2 * dip) + 0.165;
    EXPECT_LT(q.discs.meshToSet, 0.5 * farthest * farthest * options.radius);
    EXPECT_LT(q.discs.protrusion, 0.015 * options.radius);
    EXPECT_GT(q.volumeRatio, 0.95);
    EXPECT_LT(q.volumeRatio, 1.01);
  }
}

TEST(Decompose, ThinPlate_GetsSpheresOfHalfItsThickness) {
  const TriangleMesh mesh = shapes::box({0, 0, 0}, {0.2, 0.2, 0.012});
  const SphereSet set = shapes::cut(mesh, 0.01);
  for (const SetSphere& s : set.spheres) {
    EXPECT_LE(s.radius, 0.00605);
    EXPECT_GE(s.radius, 0.0055);
  }
  // Half the thickness of error at most, at the plate's edges.
  EXPECT_LT(measure(mesh, set).discs.hausdorff(), 0.006);
}

TEST(Decompose, OverlappingShells_HaveNoSurfaceInsideTheUnion) {
  TriangleMesh mesh = shapes::box({-0.1, -0.1, -0.1}, {0.1, 0.1, 0.1});
  mesh = shapes::box({-0.03, -0.03, 0.05}, {0.03, 0.03, 0.2}, mesh); // a post inside the block
  const SphereSet set = shapes::cut(mesh, 0.01);
  for (std::size_t i = 0; i < set.surfaceCount; ++i) {
    const Vec3d p = set.spheres[i].centre;
    const bool deep = p.z < 0.08 && p.z > -0.08 && std::abs(p.x) < 0.08 && std::abs(p.y) < 0.08;
    EXPECT_FALSE(deep) << p.x << " " << p.y << " " << p.z;
  }
  // Outer area: both boxes without the post's foot and contact area; pieces along the seam are up to spacing / 6 wide.
  EXPECT_NEAR(set.meshArea, 6 * 0.04 + 4 * 0.06 * 0.1, 0.24 * 0.01 / 6);
  EXPECT_NEAR(areaOf(set), set.meshArea, 1e-12);
}

TEST(Decompose, AnyNumberOfThreads_GivesTheSameBits) {
  const TriangleMesh mesh = shapes::cylinder(0.1, 0.1, 48);
  const int threads = omp_get_max_threads();
  omp_set_num_threads(1);
  const SphereSet a = shapes::cut(mesh, 0.01);
  omp_set_num_threads(3);
  const SphereSet b = shapes::cut(mesh, 0.01);
  omp_set_num_threads(threads);
  ASSERT_EQ(a.spheres.size(), b.spheres.size());
  EXPECT_EQ(std::memcmp(a.spheres.data(), b.spheres.data(), a.spheres.size() * sizeof(SetSphere)), 0);
}

TEST(Decompose, BadOptions_AreInputErrors) {
  DecompositionOptions options;
  EXPECT_THROW(decompose(testBox(), "part", options), base::InputError);
  options.radius = -0.01;
  EXPECT_THROW(decompose(testBox(), "part", options), base::InputError);
  options.radius = 1e-5; // 7.7e12 lattice points
  EXPECT_THROW(decompose(testBox(), "part", options), base::InputError);
  const auto [low, high] = bounds(testBox());
  const double half = 0.5 * std::max({high.x - low.x, high.y - low.y, high.z - low.z});
  options.radius = 1.01 * half;
  EXPECT_THROW(decompose(testBox(), "part", options), base::InputError);
  options.radius = half;
  EXPECT_NO_THROW(decompose(testBox(), "part", options));
  options.radius = 0.01;
  options.spacingRatio = 3;
  EXPECT_THROW(decompose(testBox(), "part", options), base::InputError);
  TriangleMesh open = testBox();
  open.indices.resize(open.indices.size() - 3);
  EXPECT_THROW(decompose(open, "part", {.radius = 0.01}), base::InputError);
}

} // namespace
} // namespace grouser::spheredecomp
