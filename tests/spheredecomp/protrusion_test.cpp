// SPDX-License-Identifier: BSD-3-Clause
// Thin and pointed parts: protrusion of their spheres, and the default conversion keeps it within the limit.
#include "spheredecomp/protrusion.hpp"

#include "base/error.hpp"
#include "base/math.hpp"
#include "spheredecomp/mesh.hpp"
#include "tests/spheredecomp/shapes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace grouser::spheredecomp {
namespace {

using base::Vec3d;

TriangleMesh sheet(double thickness) { return shapes::box({-0.1, -0.1, -thickness}, {0.1, 0.1, 0}); }

double diagonal(const TriangleMesh& mesh) {
  const auto [low, high] = bounds(mesh);
  return norm(high - low);
}

struct Cut {
  SphereSet set;
  Protrusion protrusion;
};
/// Conversion with the default radius, a fortieth of the diagonal, for grains of 10 mm.
Cut cutFor(const TriangleMesh& mesh, double grain = 0.01, double permitted = 0.02) {
  Cut cut;
  cut.set = decomposeWithin(mesh, "part", {.radius = diagonal(mesh) / 40, .interior = false},
                            {permitted * grain, grain, permitted * grain, true}, cut.protrusion);
  return cut;
}

/// Height at which a ball of `radius` rests on the rounded discs above (x, y), approached from above.
double restingHeight(const SphereSet& set, double x, double y, double radius) {
  double height = -1;
  for (const base::SetSphere& s : set.spheres) {
    if (std::hypot(s.centre.x - x, s.centre.y - y) > s.flat + s.radius + radius) continue;
    // The ball touches where its distance to the disc's core is the sum of both radii: bisection from above.
    const auto gap = [&](double z) {
      const Vec3d apart = Vec3d{x, y, z} - s.centre;
      const Vec3d along = apart - s.normal * dot(apart, s.normal);
      const double size = norm(along);
      return norm(size <= s.flat ? apart - along : apart - along * (s.flat / size)) - s.radius - radius;
    };
    double high = s.centre.z + s.flat + s.radius + radius, low = s.centre.z;
    if (gap(low) > 0) continue;
    for (int i = 0; i < 40; ++i) (gap(0.5 * (low + high)) > 0 ? high : low) = 0.5 * (low + high);
    height = std::max(height, high);
  }
  return height;
}

// A hole between discs may be a fifth of their radius wide; a ball of their radius sinks into it by 2 %.
constexpr double kSinks = 0.02;

TEST(ThinPart, ABallRestsOnASheetOfAnyThickness) {
  for (const double thickness : {1e-4, 1e-3, 2.6e-3, 8e-3}) {
    const Cut cut = cutFor(sheet(thickness));
    EXPECT_LE(cut.protrusion.distance, 2e-4) << thickness;
    EXPECT_LE(cut.set.spheres.size(), 2e4) << thickness;
    for (int i = 0; i < 40; ++i) {
      const double x = 0.09 * std::sin(1.0 + 7 * i), y = 0.09 * std::sin(2.0 + 11 * i);
      EXPECT_NEAR(restingHeight(cut.set, x, y, 0.01), 0.01, 2e-4) << thickness << " at " << x << ", " << y;
    }
  }
}

TEST(ThinPart, NeitherItsTurnNorTheOrderOfItsTrianglesMatters) {
  TriangleMesh turned = sheet(1e-3);
  const double angle = 0.5;
  const base::Quat q{base::cos(angle / 2), base::sin(angle / 2) * 0.6, base::sin(angle / 2) * 0.8, 0};
  for (Vec3d& v : turned.vertices) v = base::rotate(q, v);
  TriangleMesh permuted = sheet(1e-3);
  std::rotate(permuted.indices.begin(), permuted.indices.begin() + 15, permuted.indices.end());
  for (const TriangleMesh& mesh : {turned, permuted}) {
    Cut cut = cutFor(mesh);
    EXPECT_LE(cut.protrusion.distance, 2e-4);
    if (&mesh != &permuted && mesh.vertices[0].z != permuted.vertices[0].z)
      for (base::SetSphere& s : cut.set.spheres)
        s.centre = base::rotate(q.conjugate(), s.centre), s.normal = base::rotate(q.conjugate(), s.normal);
    for (int i = 0; i < 40; ++i) {
      const double x = 0.09 * std::sin(1.0 + 7 * i), y = 0.09 * std::sin(2.0 + 11 * i);
      EXPECT_NEAR(restingHeight(cut.set, x, y, 0.01), 0.01, kSinks * 0.01) << x << ", " << y;
    }
  }
}

TEST(ThinPart, WedgesTipsAndThinWallsDoNotStandOut) {
  const auto wedge = [](double height) {
    TriangleMesh m;
    m.vertices = {{0, 0, 0}, {0.15, 0, 0}, {0.15, 0, height}, {0, 0.1, 0}, {0.15, 0.1, 0}, {0.15, 0.1, height}};
    m.indices = {0, 1, 2, 3, 5, 4, 0, 3, 4, 0, 4, 1, 1, 4, 5, 1, 5, 2, 0, 2, 5, 0, 5, 3};
    return m;
  };
  TriangleMesh hollow = shapes::box({0, 0, 0}, {0.12, 0.1, 0.08});
  const TriangleMesh inner = shapes::box({0.001, 0.001, 0.001}, {0.119, 0.099, 0.079});
  for (std::size_t i = 0; i < inner.indices.size(); i += 3)
    for (const std::size_t k : {0u, 2u, 1u}) hollow.indices.push_back(8 + inner.indices[i + k]);
  hollow.vertices.insert(hollow.vertices.end(), inner.vertices.begin(), inner.vertices.end());
  const TriangleMesh cone = shapes::turned({{0, 0}, {0.02, 0}, {0, 0.15}}, 12);
  const TriangleMesh needle = shapes::turned({{0, 0}, {0.0005, 0.02}, {0.0005, 0.1}, {0, 0.12}}, 8);
  for (const auto& [name, mesh] : {std::pair{"wedge", wedge(0.03)},
                                   {"knife", wedge(0.003)},
                                   {"hollow box", hollow},
                                   {"cone", cone},
                                   {"needle", needle}}) {
    const Cut cut = cutFor(mesh);
    EXPECT_LE(cut.protrusion.distance, 2e-4) << name;
    EXPECT_LE(cut.set.spheres.size(), 3e4) << name;
    // The plain conversion with the same radius, to test the measure.
    const SphereSet plain = decompose(mesh, name, {.radius = diagonal(mesh) / 40, .interior = false});
    EXPECT_GT(largestProtrusion(mesh, plain).distance, 2e-4) << name;
  }
}

TEST(ThinPart, BeyondTheBudgetAnErrorNamesPlaceAndRemedy) {
  try {
    cutFor(sheet(1e-4), 2e-4);
    FAIL() << "accepted";
  } catch (const base::InputError& error) {
    const std::string said = error.what();
    for (const char* word : {"part: the mesh is thin or pointed at (", "more than the permitted 4e-06 m",
                             "requires more than 100000 spheres", "set the sphere radius to "})
      EXPECT_NE(said.find(word), std::string::npos) << said;
    // The remedy has the error that the message states, less than that of the default radius.
    double radius = 0, protrusion = 0;
    std::size_t spheres = 0;
    const std::string remedy = said.substr(said.find("set the sphere radius to "));
    ASSERT_EQ(std::sscanf(remedy.c_str(), "set the sphere radius to %lf m: %zu spheres that protrude by %lf m", &radius,
                          &spheres, &protrusion),
              3)
        << said;
    const SphereSet set = decompose(sheet(1e-4), "part", {.radius = radius, .interior = false});
    EXPECT_EQ(set.spheres.size(), spheres);
    EXPECT_NEAR(largestProtrusion(sheet(1e-4), set).distance, protrusion, 0.05 * protrusion) << "two digits";
    const SphereSet plain = decompose(sheet(1e-4), "part", {.radius = diagonal(sheet(1e-4)) / 40, .interior = false});
    EXPECT_LT(protrusion, 0.5 * largestProtrusion(sheet(1e-4), plain).distance);
  }
}

// A lens has few spheres by area, but they shrink at its rim: ten times the budget and a minute without the limit.
TEST(ThinPart, SpheresThatShrinkAtEdgesCountAsWell) {
  const TriangleMesh lens = shapes::turned({{0, -0.0005}, {0.1, 0}, {0, 0.0005}}, 64);
  try {
    const Cut cut = cutFor(lens, 0.003);
    EXPECT_LE(cut.set.spheres.size(), kSphereBudget);
  } catch (const base::InputError& error) {
    EXPECT_NE(std::string(error.what()).find("more than 100000 spheres"), std::string::npos) << error.what();
  }
}

TEST(ThinPart, ARefusalForItsDipSaysSo) {
  Protrusion protrusion;
  const TriangleMesh mesh = sheet(2e-3);
  try {
    decomposeWithin(mesh, "part", {.radius = diagonal(mesh) / 40, .interior = false}, {1, 2e-4, 4e-6, true},
                    protrusion);
    FAIL() << "accepted";
  } catch (const base::InputError& error) {
    EXPECT_NE(std::string(error.what()).find("shrink there and leave dips of up to"), std::string::npos)
        << error.what();
  }
}

TEST(ThinPart, AWarningAdvisesToRemoveTheKeyAlone) {
  CutReport report{"part", "mesh.0.sphere_radius", 0.01, 100, {1e-3, {}}, {1e-4, 0.005, 1e-4, false}};
  const std::string said = protrusionWarning(report);
  EXPECT_NE(said.find("remove mesh.0.sphere_radius to choose"), std::string::npos) << said;
  EXPECT_EQ(said.find("lower"), std::string::npos) << "a smaller radius may protrude more: " << said;
}

TEST(ThinPart, AMeshWithinTheLimitKeepsItsCut) {
  const TriangleMesh cube = shapes::box({0, 0, 0}, {0.2, 0.2, 0.2});
  const Cut cut = cutFor(cube);
  const SphereSet plain = decompose(cube, "part", {.radius = diagonal(cube) / 40, .interior = false});
  EXPECT_EQ(cut.set.radius, plain.radius);
  EXPECT_EQ(cut.set.spheres.size(), plain.spheres.size());
}

} // namespace
} // namespace grouser::spheredecomp
