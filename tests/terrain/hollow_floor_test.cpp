// SPDX-License-Identifier: BSD-3-Clause
// Grains on floors with hollows tighter than the grains: several contacts with one floor.
#include "base/random.hpp"
#include "grain_fixture.hpp"
#include "terrain/grain_kernel_data.cuh"
#include "tests/device_under_test.hpp"

#include <gtest/gtest.h>

namespace grouser::terrain::testing {
namespace {

using base::Vec3d;

constexpr Rectangle kArea{-0.05, 0.05, -0.05, 0.05};

template <class F> HeightField groundOf(Interpolation how, F&& h, int nodes = 41) {
  return {kArea, nodes, nodes, HeightField::sample(kArea, nodes, nodes, h).heights(), how};
}
double valley(double x, double) { return std::fabs(x); }
double pit(double x, double y) { return std::max(std::fabs(x), std::fabs(y)); }

Grains ballOn(const HeightField& floor, GrainModel m, const Vec3d& at, const Vec3d& velocity = {}) {
  m.floorLaw = m.law;
  Boundaries ground;
  ground.floor = floor;
  return {testExec(1), m, ground, {{at, velocity, {}}}};
}

class HollowFloor : public ::testing::TestWithParam<std::tuple<Interpolation, Precision>> {};
INSTANTIATE_TEST_SUITE_P(All, HollowFloor,
                         ::testing::Combine(::testing::Values(Interpolation::monotone, Interpolation::smooth,
                                                              Interpolation::bilinear),
                                            ::testing::Values(Precision::single, Precision::double_)));

TEST_P(HollowFloor, SphereInAValleyOf45Degrees_RestsOnBothFlanks) {
  GrainModel m = roughBall(1e-5, 0.3, 0.3);
  m.precision = std::get<1>(GetParam());
  Grains grains = ballOn(groundOf(std::get<0>(GetParam()), valley), m, {0.001, 0.0013, 0.0085});
  advance(grains, 10000);
  // Both springs together carry the weight; friction may carry up to its limit of that.
  const double overlap = m.mass * 9.81 / (std::sqrt(2.0) * m.law.stiffness);
  const Vec3d x = grains.snapshot().position.front();
  EXPECT_NEAR(x.z, std::sqrt(2.0) * m.radius, 2 * overlap);
  EXPECT_NEAR(x.x, 0, 2 * overlap);
  EXPECT_EQ(grains.ledger().boundaryContacts, 2);
  // Units of length: 1e-8 of a diameter.
  EXPECT_NEAR(grains.ledger().deepestOverlap, overlap, overlap);
  EXPECT_LT(grains.ledger().fastest, 1e-5);
}

TEST_P(HollowFloor, SphereInAPyramidsPit_RestsOnFourSides) {
  GrainModel m = roughBall(1e-5, 0.0, 0.3);
  m.precision = std::get<1>(GetParam());
  Grains grains = ballOn(groundOf(std::get<0>(GetParam()), pit), m, {0.0006, 0.0004, 0.0085});
  advance(grains, 10000);
  const double overlap = m.mass * 9.81 / (4 * std::sqrt(0.5) * m.law.stiffness);
  EXPECT_NEAR(grains.snapshot().position.front().z, std::sqrt(2.0) * (m.radius - overlap), 0.1 * overlap);
  EXPECT_EQ(grains.ledger().boundaryContacts, 4);
}

TEST_P(HollowFloor, SphereRollsDownAGroove_WithItsArmToBothContacts) {
  // Rolling on contacts R / sqrt(2) from the axis: a = g sin(slope) / (1 + 2/5 R^2 / (R^2 / 2)).
  GrainModel m = roughBall(1e-5, 0.8, 0.3);
  m.precision = std::get<1>(GetParam());
  const double lean = 0.1;
  m.gravity = {0, 9.81 * lean, -9.81 * std::sqrt(1 - lean * lean)};
  Grains grains = ballOn(groundOf(std::get<0>(GetParam()), valley), m, {0, -0.04, std::sqrt(2.0) * m.radius});
  advance(grains, 2000);
  const double from = static_cast<double>(grains.snapshot().velocity.front().y);
  advance(grains, 10000);
  const double gained = static_cast<double>(grains.snapshot().velocity.front().y) - from;
  EXPECT_NEAR(gained, 9.81 * lean / 1.8 * 0.1, 1e-4 * gained); // the spring oscillations decay in the first part
  const GrainLedger l = grains.ledger();
  EXPECT_LT(std::fabs(l.rubbed), 1e-9);
}

TEST_P(HollowFloor, ElasticBounceInAPit_KeepsItsEnergy) {
  GrainModel m = ball(2e-6);
  m.gravity = {0, 0, -9.81};
  m.precision = std::get<1>(GetParam());
  Grains grains = ballOn(groundOf(std::get<0>(GetParam()), pit), m, {0.002, 0.0013, 0.012});
  const auto energy = [&] {
    const GrainLedger l = grains.ledger();
    return l.kinetic + l.rotational + l.potential + l.elastic;
  };
  const double before = energy(), height = m.mass * 9.81 * 0.005;
  double worst = 0;
  for (int k = 0; k < 60; ++k) {
    advance(grains, 500);
    worst = std::max(worst, std::fabs(energy() - before));
  }
  // Symplectic Euler at 180 steps per contact: the energy oscillates in the contacts by their share of a step.
  EXPECT_LT(worst, 0.03 * height);
  EXPECT_NEAR(grains.ledger().dissipated(), 0, 1e-12 * height);
}

/// Pebbles thrown onto ground of equal roughness: cells of a radius, up to a radius high.
Grains pebbles(const base::Exec& exec, Interpolation how, double skin = 0.3) {
  GrainModel m = gravel(skin);
  m.floorLaw = m.law;
  m.floorLaw.rollingFriction = m.law.rollingFriction = 0.1;
  const Rectangle area{-0.6, 0.9, -0.6, 0.9};
  int i = 0;
  const auto noise = [&](double, double) { return 0.02 * base::uniform(1, 2, i++, 0) - 0.02; };
  Boundaries ground;
  ground.floor = HeightField(area, 51, 51, HeightField::sample(area, 51, 51, noise).heights(), how);
  ground.walls.push_back({{1, 0, 0}, -0.1, m.law});
  return {exec, m, ground, gravelBlock(4, 4, 1, {-0.3, 0.2, -0.5}, {1, 2, 0})};
}

class RoughGround : public ::testing::TestWithParam<Interpolation> {};
INSTANTIATE_TEST_SUITE_P(All, RoughGround,
                         ::testing::Values(Interpolation::monotone, Interpolation::smooth, Interpolation::bilinear));

TEST_P(RoughGround, PebblesComeToRestOnIt_AndTheLedgerCloses) {
  Grains grains = pebbles(testExec(2), GetParam());
  const auto total = [](const GrainLedger& l) {
    return l.kinetic + l.rotational + l.potential + l.elastic + l.dissipated();
  };
  const GrainLedger start = grains.ledger();
  advance(grains, 6000);
  const GrainLedger end = grains.ledger();
  EXPECT_GT(end.boundaryContacts, 16) << "more than one each";
  EXPECT_LT(end.kinetic, 0.1 * start.kinetic);
  // Contacts that start between two others, and symplectic Euler.
  EXPECT_NEAR(total(end), total(start), 0.02 * end.dissipated());
}

TEST_P(RoughGround, PebblesGoOnToTheSameBits_OnOtherThreadsSkinsAndWhenResumed) {
  Grains whole = pebbles(base::cpuExec(1), GetParam());
  advance(whole, 700);
  ASSERT_GT(whole.state().floorNormal.size(), 0u);
  Grains threads = pebbles(base::cpuExec(2), GetParam(), 0.5);
  advance(threads, 700);
  EXPECT_EQ(threads.state().words(), whole.state().words());
  for (const int step : {250, 500}) {
    Grains first = pebbles(base::cpuExec(1), GetParam());
    advance(first, step);
    const GrainState saved = first.state();
    Grains second = pebbles(base::cpuExec(2), GetParam());
    second.restore(saved);
    EXPECT_EQ(second.state().words(), saved.words());
    advance(second, 700 - step);
    EXPECT_EQ(second.state().words(), whole.state().words()) << "stopped at step " << step;
  }
  if (!base::cudaAvailable()) GTEST_SKIP() << "no CUDA device";
  Grains device = pebbles(base::cudaExec(), GetParam());
  advance(device, 700);
  EXPECT_EQ(device.state().words(), whole.state().words());
}

TEST(HollowFloor, AllPlacesHaveTheFloorsLaw) {
  // Two walls, floor, three surfaces: laws 0 to 5.
  GrainKernelData d{};
  d.wallCount = 2;
  const auto laws = [&d](int boundaries) {
    std::vector<int> all;
    for (int b = 0; b < boundaries; ++b) all.push_back(d.lawOf(b));
    return all;
  };
  d.floorPlaces = 1;
  EXPECT_EQ(laws(6), (std::vector<int>{0, 1, 2, 3, 4, 5}));
  d.floorPlaces = 8;
  EXPECT_EQ(laws(13), (std::vector<int>{0, 1, 2, 2, 2, 2, 2, 2, 2, 2, 3, 4, 5}));
  d.floorPlaces = 0; // no floor: surfaces follow the walls
  EXPECT_EQ(laws(5), (std::vector<int>{0, 1, 2, 3, 4}));
}

TEST(HollowFloor, SceneWithoutTightHollows_HasOneContactAndNoNormals) {
  GrainModel m = roughBall(1e-5, 0.3, 0.3);
  Grains grains = ballOn(groundOf(
                             Interpolation::monotone, [](double x, double) { return 4 * x * x; }, 101),
                         m, {0.001, 0.0013, 0.006});
  EXPECT_EQ(grains.system().constants.floorPlaces, 1);
  EXPECT_TRUE(grains.state().floorNormal.empty());
}

TEST(HollowFloor, MoreNailsThanPlaces_PushTheSphereUp) {
  // Spikes a fifth of a radius apart, all of equal height: the sphere is pressed onto a dozen of them at once.
  GrainModel m = ball(1e-5);
  Grains grains = ballOn(groundOf(
                             Interpolation::bilinear,
                             [k = 0](double, double) mutable {
                               const int i = k % 201, j = k / 201;
                               ++k;
                               return i % 2 == 0 && j % 2 == 0 ? 0.0 : -0.002;
                             },
                             201),
                         m, {0, 0, 0.0045});
  advance(grains, 1);
  const base::Vec3f v = grains.snapshot().velocity.front();
  EXPECT_GT(v.z, 0);
  EXPECT_LT(std::hypot(v.x, v.y), 0.3 * v.z);
  EXPECT_NEAR(grains.ledger().deepestOverlap, m.radius - grains.snapshot().position.front().z, 1e-6 * m.radius);
}

} // namespace
} // namespace grouser::terrain::testing
