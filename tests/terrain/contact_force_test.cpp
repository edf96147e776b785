// SPDX-License-Identifier: BSD-3-Clause
// The resultant of the contact forces on each grain, as snapshots give it on request.
#include "grain_fixture.hpp"
#include "terrain/grain_forces.hpp"

#include <gtest/gtest.h>
#include <stdexcept>

namespace grouser::terrain::testing {
namespace {

using base::Vec3d;
using base::Vec3f;

std::vector<Vec3f> forces(const Grains& grains) { return grains.snapshot({.contactForces = true}).contactForce; }

/// Resolution of contact forces from float velocities [N]: half a last place at speeds below `most` [m/s].
double openForce(const GrainModel& m, double most) { return 0.5 * m.mass * 0x1p-23 * most / m.timeStep; }

TEST(ContactForce, FreeFall_IsZero) {
  GrainModel m = ball(1e-5);
  m.gravity = {0, 0, -9.81};
  Grains grains(base::cpuExec(2), m, {}, {{{0, 0, 1}, {}, {}}, {{1, 0, 1}, {1, -0.5, 0}, {}}});
  advance(grains, 30);
  for (const Vec3f& f : forces(grains)) EXPECT_LT(norm(f.as<double>()), std::sqrt(3.0) * openForce(m, 1.0));
  EXPECT_TRUE(grains.snapshot().contactForce.empty()) << "only on request";
}

TEST(ContactForce, OfTwoSpringsInTouch_IsTheLaw) {
  GrainModel m = ball(1e-6);
  const double overlap = 1e-3 * m.radius;
  Grains grains(base::cpuExec(1), m, {}, {{{0, 0, 0}, {}, {}}, {{2 * m.radius - overlap, 0, 0}, {}, {}}});
  advance(grains, 1);
  const std::vector<Vec3f> f = forces(grains);
  const double expected = static_cast<double>(m.law.stiffness) * overlap;
  // Both positions are whole units; the velocity before was exactly 0.
  const double tolerance = static_cast<double>(m.law.stiffness) * grains.scale().unit + 1e-6 * expected;
  EXPECT_NEAR(f[0].x, -expected, tolerance);
  EXPECT_NEAR(f[1].x, expected, tolerance);
  EXPECT_NEAR(f[0].y, 0, tolerance);
}

TEST(ContactForce, HeapAtRest_CarriesItsWeight) {
  const GrainModel m = gravel();
  const Vec3d weight = m.gravity * m.mass;
  Boundaries box{{floorPlane(m.law),
                  {{1, 0, 0}, -0.035, m.law},
                  {{-1, 0, 0}, -0.16, m.law},
                  {{0, 1, 0}, -0.045, m.law},
                  {{0, -1, 0}, -0.15, m.law}},
                 {}};
  Grains grains(base::cpuExec(2), m, box, gravelBlock(3, 3, 3, {}));
  // All velocities are zeroed at intervals; the rest is the residual motion.
  double left = 1; // mean force imbalance over the weight
  for (int k = 0; k < 300 && left > 1e-4; ++k) {
    grains.stop();
    advance(grains, 500);
    left = forceRatio(grains.system());
  }
  ASSERT_LT(left, 1e-3) << "the heap is at rest";
  Vec3d sum;
  for (const Vec3f& f : forces(grains)) {
    EXPECT_LT(norm(f.as<double>() + weight), 27 * left * norm(weight) + openForce(m, 1e-3));
    sum += f.as<double>();
  }
  EXPECT_LT(norm(sum * (1.0 / 27) + weight), left * norm(weight) + openForce(m, 1e-3));
}

TEST(ContactForce, OfGrainsOfManyRadii_TakesEachMass) {
  GrainModel m = ball(1e-5);
  m.gravity = {0, 0, -9.81};
  m.law.damping = 500;
  const double small = 0.5 * m.radius;
  Grains grains(base::cpuExec(1), m, {{floorPlane(m.law)}, {}},
                {{{0, 0, m.radius}, {}, {}, m.radius}, {{1, 0, small}, {}, {}, small}});
  advance(grains, 20000); // 0.2 s: both rest
  const std::vector<Vec3f> f = forces(grains);
  EXPECT_NEAR(f[0].z, m.mass * 9.81, 1e-3 * m.mass * 9.81);
  EXPECT_NEAR(f[1].z, m.mass / 8 * 9.81, 1e-3 * m.mass * 9.81) << "springs are accurate to one unit of position";
}

TEST(ContactForce, OutlivesARowOfResultsAndGrainsThatEnter) {
  const GrainModel m = gravel();
  Grains grains(base::cpuExec(2), m, {{floorPlane(m.law)}, {}}, gravelBlock(4, 4, 2, {1, 0.3, -1}));
  advance(grains, 200);
  const std::vector<Vec3f> before = forces(grains);
  double largest = 0;
  for (const Vec3f& f : before) largest = std::max(largest, norm(f.as<double>()));
  ASSERT_GT(largest, m.mass * 9.81) << "some grains touch";
  const std::int64_t rebuilds = grains.system().rebuilds;
  grains.invalidateNeighbours();
  grains.ledger();
  ASSERT_EQ(grains.system().rebuilds, rebuilds + 1) << "the slots have changed";
  EXPECT_EQ(forces(grains), before);
  grains.add({{{0, 0, 1}, {0, 0.5, -1}, {}}});
  grains.ledger();
  std::vector<Vec3f> after = forces(grains);
  EXPECT_LT(norm(after.back().as<double>()), openForce(m, 2.0)) << "it has no contact yet";
  after.pop_back();
  EXPECT_EQ(after, before);
}

TEST(ContactForce, AfterStepsThatGoAsOne_IsThatOfTheLast) {
  GrainModel m = gravel();
  m.maxSimdLanes = 1; // so that a CPU batches steps as well
  Grains batched(base::cpuExec(1), m, {{floorPlane(m.law)}, {}}, gravelBlock(3, 3, 2, {0, 0, -1}));
  Grains single(base::cpuExec(1), m, {{floorPlane(m.law)}, {}}, gravelBlock(3, 3, 2, {0, 0, -1}));
  while (batched.steps() < 200) {
    const std::int64_t taken = batched.advance(200 - batched.steps());
    advance(single, taken);
    ASSERT_EQ(forces(batched), forces(single)) << "after " << taken << " at once";
  }
}

TEST(ContactForce, WhereNoStepCameLast_IsRefused) {
  const GrainModel m = ball(1e-5);
  Grains grains(base::cpuExec(1), m, {}, {{{0, 0, 1}, {}, {}}});
  EXPECT_THROW(forces(grains), std::logic_error);
  advance(grains, 1);
  EXPECT_NO_THROW(forces(grains));
  grains.stop();
  EXPECT_THROW(forces(grains), std::logic_error);
  advance(grains, 1);
  grains.restore(grains.state());
  EXPECT_THROW(forces(grains), std::logic_error);
}

} // namespace
} // namespace grouser::terrain::testing
