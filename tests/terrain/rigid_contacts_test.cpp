// SPDX-License-Identifier: BSD-3-Clause
// A part on planes, boxes, cylinders and meshes: normal force in closed form, Coulomb friction, opposite loads, and
// results equal to the height-field's.
#include "terrain/rigid_contacts.hpp"

#include "base/hash.hpp"
#include "base/random.hpp"
#include "terrain/feet_search.hpp"
#include "tests/contact/part_fixture.hpp"

#include <gtest/gtest.h>

#include <memory>

namespace grouser::terrain {
namespace {

using base::Vec3d;
using contact::PartLoad;
using contact::PartMotion;
/// A surface with its friction against the plate.
struct Surface {
  using Kind = RigidContacts::Surface::Kind;
  Kind kind{};
  SurfaceGeometry geometry;
  int set{-1}, motion{-1};
  double friction{};
};
using contact::testing::atRest;
using contact::testing::plate;

constexpr double kModulus = 1e9, kSpacing = 0.005, kStep = 1e-4;
/// A quarter turn about y, from z to x.
const base::Quat kTurned{std::sqrt(0.5), 0, std::sqrt(0.5), 0};

contact::PatchQuanta quanta() {
  contact::PatchQuanta q;
  q.force = q.torque = q.moment = q.energy = base::fixedPointFor(1e6, 44);
  q.area = base::fixedPointFor(1, 40);
  return q;
}

/// A plate with one face 30 mm below its origin, and one surface.
struct Bench {
  RigidContacts::Model model{quanta(), kStep};
  base::SphereSet part = plate(0.05, 0.005, kSpacing), other = plate(0.2, 0.005, 0.008);
  PartMotion at; ///< motion of the surface
  std::unique_ptr<RigidContacts> contacts;
  std::vector<PartLoad> loads{2};

  Bench(const Surface& surface, const PartMotion& place, const HeightField* field = nullptr, double relaxation = 0)
      : at(place) {
    const contact::PatchLaw law{kModulus, relaxation, surface.friction, 0.8};
    std::vector<contact::PointTree> points;
    points.emplace_back(contact::surfaceSamplesOf(part));
    contacts = std::make_unique<RigidContacts>(
        model, std::move(points), std::vector<int>{0},
        std::vector<RigidContacts::Surface>{{surface.kind, surface.geometry, surface.set, 1}},
        std::vector<RigidContacts::Pair>{{0, 0, law}}, std::vector<const base::SphereSet*>{&other}, field);
  }
  void step(const Vec3d& origin, const base::Quat& turn = {1, 0, 0, 0}, const Vec3d& velocity = {}) {
    PartMotion a = atRest(origin, turn);
    a.velocity = velocity;
    const PartMotion motion[] = {a, at};
    loads.assign(2, {});
    contacts->compute(motion, loads.data());
  }
  Vec3d force(std::size_t i) const { return model.quanta.force.value(loads[i].force); }
  Vec3d torque(std::size_t i) const { return model.quanta.torque.value(loads[i].torque); }
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

TEST(RigidContacts, AFaceOnPlaneBoxAndEndOfACylinderIsPressedByModulusTimesVolume) {
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

TEST(RigidContacts, AMeshIsFeltAsItsFaces) {
  Bench bench({Surface::Kind::mesh, {}, 0, 1, 0}, atRest({}));
  bench.step({0.0123, 0.0071, 0.03 - kOverlap}); // that plate's upper face is at 0
  const double expected = kModulus * bench.area() * kOverlap;
  EXPECT_NEAR(bench.force(0).z, expected, 2e-4 * expected) << "float distances, 1e-8 m of 1e-4 m";
  EXPECT_EQ(bench.force(0) + bench.force(1), Vec3d{});
}

TEST(RigidContacts, ATurnedSurfaceTurnsTheForce) {
  // The wall x = 0.5, solid behind, as a plane and as the top of a box; the plate's face points to -x.
  const std::pair<Surface, double> walls[] = {{shapeOf(SurfaceShape::plane, {}), 0.5},
                                              {shapeOf(SurfaceShape::box, {0.3, 0.2, 0.1}), 0.4}};
  for (const auto& [surface, x] : walls) {
    Bench bench(surface, atRest({x, 0, 0}, kTurned));
    const Vec3d origin{0.53 - kOverlap, 0.02, 0.1};
    bench.step(origin, kTurned);
    const double expected = kModulus * bench.area() * kOverlap;
    EXPECT_NEAR(bench.force(0).x, expected, 2e-5 * expected);
    EXPECT_NEAR(bench.force(0).z, 0, 1e-9 * expected);
    const Vec3d total =
        bench.torque(0) + cross(origin, bench.force(0)) + bench.torque(1) + cross(Vec3d{x, 0, 0}, bench.force(1));
    EXPECT_LT(norm(total), 1e-6 * norm(cross(origin, bench.force(0)))) << "about one point, quanta";
  }
}

TEST(RigidContacts, AFaceAlongAWallSticksOnItsSpringThenSlidesAtCoulombsLimit) {
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

/// An inclined plate above an equal slope: 1 in 10 along x.
const base::Quat kSlope = base::Quat{1, 0, -0.5 * 0.0996686, 0}.normalized();

TEST(RigidContacts, APlaneIsAPlaneWhateverItIsGivenAs) {
  // Three representations: plane, planar height-field, and a height-field with a distant step.
  const Rectangle area{-1, 1, -1, 1};
  const HeightField level = HeightField::sample(area, 3, 3, [](double, double) { return 0.0; });
  const HeightField stepped =
      HeightField::sample(area, 201, 201, [](double x, double) { return x > 0.9 ? 0.05 : 0.0; });
  Bench plane(shapeOf(SurfaceShape::plane, {}, 0.5), atRest({}));
  Bench flat({Surface::Kind::field, {}, -1, 1, 0.5}, atRest({}), &level);
  Bench searched({Surface::Kind::field, {}, -1, 1, 0.5}, atRest({}), &stepped);
  ASSERT_TRUE(level.isPlane());
  ASSERT_FALSE(stepped.isPlane());
  for (int k = 0; k < 20; ++k) {
    for (Bench* b : {&plane, &flat, &searched}) b->step({1e-6 * k, 0, 0.03 - kOverlap}, {1, 0, 0, 0}, {0.01, 0, 0});
    EXPECT_EQ(plane.loads[0].force, flat.loads[0].force) << k;
    EXPECT_EQ(plane.loads[0].torque, flat.loads[0].torque) << k;
    EXPECT_LT(norm(searched.force(0) - plane.force(0)), 1e-9 * norm(plane.force(0))) << k;
  }
}

TEST(RigidContacts, OnASlopeTheForceIsSquareToIt) {
  const Rectangle area{-1, 1, -1, 1};
  const HeightField slope = HeightField::plane(area, 0, 0.1, 0);
  const Vec3d normal = base::normalized(Vec3d{-0.1, 0, 1});
  Bench bench({Surface::Kind::field, {}, -1, 1, 0}, atRest({}), &slope);
  bench.step(normal * (0.03 - kOverlap), kSlope);
  const double expected = kModulus * bench.area() * kOverlap;
  EXPECT_LT(norm(bench.force(0) - normal * expected), 2e-3 * expected);
}

TEST(RigidContacts, WhatBoxesLeaveOutDoesNotTouch) {
  // Every point separately, on a box with an edge and a corner in contact.
  const Surface box = shapeOf(SurfaceShape::box, {0.04, 0.03, 0.1});
  const base::Quat turn = base::Quat{1, 0.02, -0.03, 0.1}.normalized();
  Bench bench(box, atRest({0.03, 0.02, 0}));
  const Vec3d origin{0, 0, 0.1 + 0.03 - 5e-4};
  bench.step(origin, turn);
  Vec3d expected;
  const base::Pose pose{origin, turn};
  for (const contact::SurfaceSample& s : contact::surfaceSamplesOf(bench.part)) {
    const SurfaceGap gap = gapTo(box.geometry, pose.toWorld(s.centre.as<double>()) - bench.at.origin);
    const double overlap = static_cast<double>(s.radius) - gap.distance;
    if (overlap > 0) expected += gap.normal * (kModulus * static_cast<double>(s.area) * overlap);
  }
  ASSERT_GT(norm(expected), 10);
  EXPECT_LT(norm(bench.force(0) - expected), 1e-9 * norm(expected));
}

/// Force on the bench's part, point by point with `gap`.
template <class Gap> Vec3d forceByPoints(const Bench& bench, const base::Pose& pose, Gap&& gap) {
  Vec3d force;
  for (const contact::SurfaceSample& s : contact::surfaceSamplesOf(bench.part)) {
    const auto [distance, normal] = gap(pose.toWorld(s.centre.as<double>()), static_cast<double>(s.radius));
    const double overlap = static_cast<double>(s.radius) - distance;
    if (overlap > 0) force += normal * (kModulus * static_cast<double>(s.area) * overlap);
  }
  return force;
}

/// A pose within some centimetres of a point, slightly rotated.
base::Pose poseNear(const Vec3d& place, int k, double tilt) {
  const auto within = [k](int i, double size) { return size * (2 * base::uniform(5, 0, i, k) - 1); };
  return {place + Vec3d{within(0, 0.15), within(1, 0.05), within(2, 4e-4)},
          base::Quat{1, within(3, tilt), within(4, tilt), within(5, 1)}.normalized()};
}

TEST(RigidContacts, ForcesOfABoxMatchASumOverPoints) {
  int touching = 0;
  for (const double half : {0.1, 0.005})    // [m] the second is a thin slab
    for (const double depth : {3e-4, 7e-3}) // [m] the second is more than the slab's half
      for (int k = 0; k < 40; ++k) {
        const Surface box = shapeOf(SurfaceShape::box, {0.12, 0.3, half});
        Bench bench(box, atRest({0.03, 0.02, 0}, base::Quat{1, 0.02, -0.01, 0.1}.normalized()));
        const base::Pose pose = poseNear({0, 0, half + 0.03 - depth}, k, 0.01);
        bench.step(pose.position, pose.orientation);
        const Vec3d expected = forceByPoints(bench, pose, [&](const Vec3d& x, double) {
          const SurfaceGap gap = gapTo(box.geometry, bench.at.toPart(x));
          return std::pair(gap.distance, bench.at.rotation * gap.normal);
        });
        touching += norm(expected) > 10;
        EXPECT_LT(norm(bench.force(0) - expected), 1e-7 * norm(expected) + 1e-6) << half << ' ' << depth << ' ' << k;
      }
  EXPECT_GT(touching, 100);
}

constexpr Rectangle kField{-1, 1, -1, 1};

HeightField ditchOrHills(bool hills, Interpolation how) {
  const HeightField nodes = HeightField::sample(kField, 81, 81, [hills](double x, double y) {
    return hills ? 0.02 * std::sin(9 * x) * std::cos(7 * y) : std::fabs(x) < 0.06 ? -0.03 : 0.0;
  });
  return HeightField(kField, 81, 81, nodes.heights(), how);
}

/// A pose of the plate on the ground of ditchOrHills(), for every third `k` deep inside.
base::Pose poseOn(const HeightField& field, bool hills, int k) {
  base::Pose pose = poseNear({0, 0, 0}, k, 0.01);
  const double ground = hills ? field.height(pose.position.x, pose.position.y) + 1e-3 : 0;
  pose.position.z += 0.03 - 5e-4 + ground - (k % 3 == 0 ? (hills ? 0.012 : 0.016) : 0);
  return pose;
}

TEST(RigidContacts, ForcesOfAHeightFieldMatchASumOverPoints) {
  for (const Interpolation how : {Interpolation::monotone, Interpolation::smooth, Interpolation::bilinear})
    for (const bool hills : {false, true}) {
      const HeightField field = ditchOrHills(hills, how);
      const SearchedHeightField searched(base::cpuExec(1), field, 0.01);
      Bench bench({Surface::Kind::field, {}, -1, 1, 0}, atRest({}), &field);
      int touching = 0;
      for (int k = 0; k < 45; ++k) {
        const base::Pose pose = poseOn(field, hills, k);
        bench.step(pose.position, pose.orientation);
        const Vec3d expected = forceByPoints(bench, pose, [&](const Vec3d& x, double radius) {
          FootPoint foot;
          return deepestFoot(searched.view(), x, radius, foot) ? std::pair(foot.distance, foot.normal)
                                                               : std::pair(radius, Vec3d{});
        });
        touching += norm(expected) > 10;
        EXPECT_LT(norm(bench.force(0) - expected), 1e-6 * norm(expected) + 1e-5) << hills << ' ' << k;
      }
      EXPECT_GT(touching, 25) << hills;
    }
}

TEST(RigidContacts, HaveTheSameBitsOnEveryProcessor) {
  base::StateHash hash;
  const auto add = [&hash](const Bench& bench) {
    for (const PartLoad& load : bench.loads)
      for (const std::int64_t x :
           {load.force.x, load.force.y, load.force.z, load.torque.x, load.torque.y, load.torque.z})
        hash.add(static_cast<std::uint64_t>(x));
  };
  for (const bool hills : {false, true}) {
    const HeightField field = ditchOrHills(hills, Interpolation::monotone);
    Bench bench({Surface::Kind::field, {}, -1, 1, 0.5}, atRest({}), &field, 2e-4);
    for (int k = 0; k < 30; ++k) {
      const base::Pose pose = poseOn(field, hills, k);
      bench.step(pose.position, pose.orientation, {0.1, 0.2, -0.3});
      add(bench);
    }
  }
  Bench bench(shapeOf(SurfaceShape::box, {0.12, 0.3, 0.1}, 0.5), atRest({0.03, 0.02, 0}));
  for (int k = 0; k < 30; ++k) {
    const base::Pose pose = poseNear({0, 0, 0.13 - 3e-4}, k, 0.01);
    bench.step(pose.position, pose.orientation, {0.1, 0.2, -0.3});
    add(bench);
  }
  EXPECT_EQ(hash.hex(), "a4cdad3a012bf595");
}

TEST(RigidContacts, APatchGoesOnFromWhatWasSaved) {
  const Surface wall = shapeOf(SurfaceShape::plane, {}, 0.5);
  Bench bench(wall, atRest({})), resumed(wall, atRest({}));
  const auto go = [](Bench& b, int k) { b.step({1e-6 * k, 0, 0.03 - kOverlap}, {1, 0, 0, 0}, {0.01, 0, 0}); };
  for (int k = 0; k < 5; ++k) go(bench, k);
  resumed.contacts->restore(bench.contacts->save());
  EXPECT_EQ(resumed.contacts->ledger().elastic, bench.contacts->ledger().elastic);
  EXPECT_EQ(resumed.contacts->ledger().patches, 1);
  for (int k = 5; k < 10; ++k) go(bench, k), go(resumed, k);
  EXPECT_EQ(resumed.loads[0].force, bench.loads[0].force);
  // After lift-off, its spring is dissipated, also if it was loaded before a resume.
  resumed.contacts->restore(bench.contacts->save());
  const double held = resumed.contacts->ledger().elastic, before = resumed.contacts->ledger().dissipated;
  resumed.step({0, 0, 0.04});
  EXPECT_EQ(resumed.contacts->ledger().elastic, 0);
  EXPECT_EQ(resumed.contacts->ledger().patches, 0);
  const double pressed = 0.5 * kModulus * bench.area() * kOverlap * kOverlap;
  EXPECT_NEAR(resumed.contacts->ledger().dissipated - before, held - pressed, 1e-3 * (held - pressed));
}

TEST(RigidContacts, APatchThatLeavesFastLosesWhatItHeldAndBooksIt) {
  Bench bench(shapeOf(SurfaceShape::plane, {}), atRest({}), nullptr, 2e-4);
  // Separating at 1 m/s: the foundation recovers at overlap over relaxation time, half a metre per second.
  const double speed = 1, held = 0.5 * kModulus * bench.area() * kOverlap * kOverlap;
  bench.step({0, 0, 0.03 - kOverlap}, {1, 0, 0, 0}, {0, 0, speed});
  EXPECT_EQ(bench.force(0), Vec3d{});
  EXPECT_NEAR(bench.contacts->ledger().elastic, held, 1e-3 * held);
  EXPECT_NEAR(bench.contacts->ledger().dissipated, kModulus * bench.area() * kOverlap * speed * kStep, 1e-3 * held);
}

TEST(RigidContacts, AHollowCylinderIsFeltFromBothSides) {
  for (const double side : {-1.0, 1.0}) {
    // The wall is vertical at x = 0.5; the plate's face points to it.
    Bench bench(shapeOf(SurfaceShape::tube, {5, 0, 1}), atRest({-4.5, 0, 0}));
    const base::Quat turn = side < 0 ? base::Quat{std::sqrt(0.5), 0, -std::sqrt(0.5), 0} : kTurned;
    bench.step({0.5 + side * (0.03 - 5e-4), 0, 0}, turn);
    EXPECT_GT(side * bench.force(0).x, 100) << side;
  }
}

TEST(RigidContacts, NothingTouchesBesideABox) {
  Bench bench(shapeOf(SurfaceShape::box, {0.1, 0.1, 0.1}), atRest({}));
  bench.step({0.2, 0, 0.13 - kOverlap});
  EXPECT_EQ(bench.force(0), Vec3d{});
}

} // namespace
} // namespace grouser::terrain
