// SPDX-License-Identifier: BSD-3-Clause
// A part on planes, boxes, cylinders and meshes: force by closed form, friction by Coulomb, opposite loads, one answer
// with the height-field.
#include "terrain/surface_contacts.hpp"

#include "terrain/ground_contacts.hpp"
#include "tests/contact/part_fixture.hpp"
#include "tests/device_under_test.hpp"

#include <gtest/gtest.h>

namespace grouser::terrain {
namespace {

using base::Vec3d;
using contact::PartLoad;
using contact::PartMotion;
using Surface = SurfaceContacts::Surface;
using contact::testing::atRest;
using contact::testing::plate;

constexpr double kModulus = 1e9, kSpacing = 0.005, kStep = 1e-4;
/// A quarter turn about y, that takes z to x.
const base::Quat kTurned{std::sqrt(0.5), 0, std::sqrt(0.5), 0};

contact::PatchQuanta quanta() {
  contact::PatchQuanta q;
  q.force = q.torque = q.moment = q.energy = base::fixedPointFor(1e6, 44);
  q.area = base::fixedPointFor(1, 40);
  return q;
}

/// A plate of which a face lies 30 mm below its origin, and one surface.
struct Bench {
  base::Exec exec = testExec();
  SurfaceContacts::Model model{{kModulus, 0, 0, 0.8}, quanta(), kStep, 0.003};
  base::SphereSet part = plate(0.05, 0.005, kSpacing), other = plate(0.2, 0.005, 0.008);
  PartMotion at; ///< of the surface
  std::unique_ptr<SurfaceContacts> contacts;
  base::Array<PartMotion> motion;
  base::Array<PartLoad> loads;

  Bench(Surface surface, const PartMotion& place) : at(place) {
    surface.motion = 1;
    contacts = std::make_unique<SurfaceContacts>(exec, model, std::vector<const base::SphereSet*>{&part, &other},
                                                 std::vector<int>{0}, std::vector<Surface>{surface},
                                                 std::vector<SurfaceContacts::Pair>{{0, 0}}, nullptr);
    loads = base::Array<PartLoad>(exec, 2);
  }
  void step(const Vec3d& origin, const base::Quat& turn = {1, 0, 0, 0}, const Vec3d& velocity = {}) {
    PartMotion a = atRest(origin, turn);
    a.velocity = velocity;
    motion = base::Array<PartMotion>(exec, std::vector<PartMotion>{a, at});
    if (contacts->samplesListed() == 0) contacts->refresh(motion);
    loads.zero();
    const base::Array<double> travelled(exec, std::vector<double>{model.margin});
    contacts->compute(motion, travelled.data(), loads.data());
  }
  Vec3d force(std::size_t i) const { return model.quanta.force.value(loads.at(i).force); }
  Vec3d torque(std::size_t i) const { return model.quanta.torque.value(loads.at(i).torque); }
  double area() const {
    double sum = 0;
    for (const base::SetSphere& s : part.spheres)
      if (s.normal.z < 0) sum += s.area;
    return sum;
  }
};

Surface shapeOf(SurfaceShape shape, const Vec3d& half, double friction = 0) {
  return {Surface::Kind::shape, {shape, half}, -1, 1, friction};
}

constexpr double kOverlap = 1e-4;

TEST(SurfaceContacts, AFaceOnPlaneBoxAndEndOfACylinderIsPressedByModulusTimesVolume) {
  for (const Surface& s : {shapeOf(SurfaceShape::plane, {}), shapeOf(SurfaceShape::box, {0.3, 0.3, 0.1}),
                           shapeOf(SurfaceShape::cylinder, {0.3, 0, 0.1})}) {
    const double top = s.geometry.shape == SurfaceShape::plane ? 0 : 0.1;
    Bench bench(s, atRest({0, 0, 0.5}));
    bench.step({0.0123, 0.0071, 0.5 + top + 0.03 - kOverlap});
    const double expected = kModulus * bench.area() * kOverlap;
    EXPECT_NEAR(bench.force(0).z, expected, 2e-5 * expected) << "single precision, 1e-9 m of 1e-4 m";
    EXPECT_EQ(bench.force(0).x, 0);
    EXPECT_EQ(bench.force(0) + bench.force(1), Vec3d{}) << "exact opposites";
    EXPECT_NEAR(bench.contacts->ledger().elastic, 0.5 * expected * kOverlap, 4e-5 * expected * kOverlap);
  }
}

TEST(SurfaceContacts, AMeshIsFeltAsItsFaces) {
  Bench bench({Surface::Kind::mesh, {}, 1, 1, 0}, atRest({}));
  bench.step({0.0123, 0.0071, 0.03 - kOverlap}); // that plate's upper face lies at 0
  const double expected = kModulus * bench.area() * kOverlap;
  EXPECT_NEAR(bench.force(0).z, expected, 2e-4 * expected) << "float distances, 1e-8 m of 1e-4 m";
  EXPECT_EQ(bench.force(0) + bench.force(1), Vec3d{});
}

TEST(SurfaceContacts, ATurnedSurfaceTurnsTheForce) {
  // The wall x = 0.5, solid behind; the plate's face looks to -x.
  Bench bench(shapeOf(SurfaceShape::plane, {}), atRest({0.5, 0, 0}, kTurned));
  bench.step({0.53 - kOverlap, 0.02, 0.1}, kTurned);
  const double expected = kModulus * bench.area() * kOverlap;
  EXPECT_NEAR(bench.force(0).x, expected, 2e-5 * expected);
  EXPECT_NEAR(bench.force(0).z, 0, 1e-9 * expected);
  const Vec3d origin{0.53 - kOverlap, 0.02, 0.1};
  const Vec3d total =
      bench.torque(0) + cross(origin, bench.force(0)) + bench.torque(1) + cross(Vec3d{0.5, 0, 0}, bench.force(1));
  EXPECT_LT(norm(total), 1e-6 * norm(cross(origin, bench.force(0)))) << "about one point, quanta";
}

TEST(SurfaceContacts, AFaceAlongAWallSticksOnItsSpringThenSlidesAtCoulombsLimit) {
  const double friction = 0.5, speed = 0.01;
  Bench bench(shapeOf(SurfaceShape::box, {0.1, 1, 1}, friction), atRest({-0.1, 0, 0}));
  const double normal = kModulus * bench.area() * kOverlap, kt = 0.8 * kModulus * bench.area();
  double z = 0;
  for (int k = 1; k <= 100; ++k) {
    bench.step({0.03 - kOverlap, 0, z}, kTurned, {0, 0, speed});
    const double held = std::min(kt * speed * kStep * k, friction * normal);
    EXPECT_NEAR(bench.force(0).x, normal, 2e-5 * normal);
    EXPECT_NEAR(bench.force(0).z, -held, 2e-5 * friction * normal);
    EXPECT_EQ(bench.force(1), -bench.force(0));
    z += speed * kStep;
  }
  EXPECT_GT(bench.contacts->ledger().dissipated, 0);
}

TEST(SurfaceContacts, APlaneIsLevelGround_ToTheLastBit) {
  Bench bench(shapeOf(SurfaceShape::plane, {}, 0.5), atRest({}));
  const HeightField level({-1, 1, -1, 1}, 3, 3, std::vector<double>(9, 0.0));
  contact::PatchLaw law = bench.model.law;
  law.friction = 0.5;
  GroundContacts ground(bench.exec, {law, quanta(), kStep, 0.003}, level, {&bench.part}, {0}, {0});
  base::Array<PartLoad> loads(bench.exec, 1);
  for (int k = 0; k < 20; ++k) {
    bench.step({1e-6 * k, 0, 0.03 - kOverlap}, {1, 0, 0, 0}, {0.01, 0, 0});
    if (k == 0) ground.refresh(bench.motion);
    loads.zero();
    const base::Array<double> travelled(bench.exec, std::vector<double>{0.003});
    ground.compute(bench.motion, travelled.data(), loads.data());
    EXPECT_EQ(bench.loads.at(0).force, loads.at(0).force) << k;
    EXPECT_EQ(bench.loads.at(0).torque, loads.at(0).torque) << k;
  }
}

TEST(SurfaceContacts, NothingTouchesBesideABox) {
  Bench bench(shapeOf(SurfaceShape::box, {0.1, 0.1, 0.1}), atRest({}));
  bench.step({0.2, 0, 0.13 - kOverlap});
  EXPECT_EQ(bench.force(0), Vec3d{});
  EXPECT_EQ(bench.contacts->samplesListed(), 0u);
}

} // namespace
} // namespace grouser::terrain
