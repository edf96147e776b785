// SPDX-License-Identifier: BSD-3-Clause
// Sphere sets are cached under cutOrigin(): any change of the set must change the origin.
#include "base/bits.hpp"
#include "base/hash.hpp"
#include "spheredecomp/decompose.hpp"
#include "spheredecomp/mesh.hpp"
#include "tests/spheredecomp/shapes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace grouser::spheredecomp {
namespace {

using base::Vec3d;

std::string hashOf(const SphereSet& set) {
  base::StateHash hash;
  const auto add = [&](double v) { hash.add(base::bitsAs<std::uint64_t>(v)); };
  for (const base::SetSphere& s : set.spheres) {
    for (int k = 0; k < 3; ++k) add(s.centre[k]), add(s.normal[k]);
    for (const double v : {s.radius, s.offset, s.flat, s.area}) add(v);
  }
  hash.add(set.surfaceCount);
  for (const double v : {set.spacing, set.radius, set.meshVolume, set.meshArea}) add(v);
  return hash.hex();
}

SphereSet cutOf(const std::string& part, const DecompositionOptions& options) {
  return decompose(importMesh(std::string(GROUSER_SOURCE_DIR) + "/assets/meshes/" + part + ".obj"), part, options);
}

// If this fails, cached sets of earlier programs differ from new ones: increment kCutVersion, then store its
// new value and the new hashes here. Never update only the hashes.
TEST(CutVersion, IsRaisedWhenAnySphereChanges) {
  EXPECT_EQ(kCutVersion, 1);
  EXPECT_EQ(hashOf(cutOf("shoe", {.radius = 0.01})), "ff51723c3b65e918");
  EXPECT_EQ(hashOf(cutOf("sprocket", {.radius = 0.03})), "dbfc99cafa75cc9b"); // shells that overlap
  EXPECT_EQ(hashOf(cutOf("roller", {.targetCount = 300})), "f02c9ae3fe4050d6");
  EXPECT_EQ(hashOf(cutOf("idler", {.radius = 0.04, .spacingRatio = 0.8, .maxDip = 0.1, .flatTolerance = 0.05})),
            "2675b14d18272f65");
}

TEST(CutOrigin, DiffersWithEveryInput) {
  const TriangleMesh mesh = shapes::box({0, 0, 0}, {0.1, 0.2, 0.3});
  const DecompositionOptions plain{.radius = 0.01};
  std::set<std::string> origins{cutOrigin(mesh, plain)};
  const auto isNew = [&](const TriangleMesh& m, const DecompositionOptions& o) {
    return origins.insert(cutOrigin(m, o)).second;
  };
  EXPECT_FALSE(isNew(shapes::box({0, 0, 0}, {0.1, 0.2, 0.3}), {.radius = 0.01}));
  EXPECT_TRUE(isNew(mesh, {.radius = std::nextafter(0.01, 1)}));
  EXPECT_TRUE(isNew(mesh, {.radius = 0.01, .targetCount = 100}));
  EXPECT_TRUE(isNew(mesh, {.radius = 0.01, .spacingRatio = 0.9}));
  EXPECT_TRUE(isNew(mesh, {.radius = 0.01, .maxDip = 0.06}));
  EXPECT_TRUE(isNew(mesh, {.radius = 0.01, .flatTolerance = 0.02}));
  EXPECT_TRUE(isNew(mesh, {.radius = 0.01, .interior = false}));
  EXPECT_TRUE(isNew(shapes::box({0, 0, 0}, {0.1, 0.2, std::nextafter(0.3, 1)}), plain)) << "one bit of one coordinate";
  EXPECT_TRUE(isNew(shapes::box({0, 0, 0}, {0.2, 0.4, 0.6}), plain)) << "the mesh at another scale";
  TriangleMesh turned = mesh;
  std::swap(turned.indices[0], turned.indices[1]);
  EXPECT_TRUE(isNew(turned, plain)) << "the same corners with other connectivity";
  TriangleMesh more = shapes::box({1, 0, 0}, {1.1, 0.1, 0.1}, mesh);
  EXPECT_TRUE(isNew(more, plain));
}

} // namespace
} // namespace grouser::spheredecomp
