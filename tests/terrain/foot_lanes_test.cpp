// SPDX-License-Identifier: BSD-3-Clause
// Foot points of eight spheres at a time, against the scalar search.
#include "terrain/foot_lanes.hpp"

#include "base/random.hpp"
#include "terrain/feet_search.hpp"
#include "terrain/searched_height_field.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace grouser::terrain {
namespace {

constexpr Rectangle kArea{-1, 1, -1, 1};
constexpr double kRadius = 0.008;

double within(int i, int k, double size) { return size * (2 * base::uniform(9, 0, i, k) - 1); }

HeightField hills(Interpolation how, double height = 0.05) {
  const HeightField nodes = HeightField::sample(
      kArea, 101, 81, [height](double x, double y) { return height * std::sin(8 * x + 0.3) * std::cos(6 * y); });
  return HeightField(kArea, 101, 81, nodes.heights(), how);
}

class FootLanesOn : public ::testing::TestWithParam<Interpolation> {};
INSTANTIATE_TEST_SUITE_P(Ground, FootLanesOn, ::testing::Values(Interpolation::monotone, Interpolation::smooth));

TEST_P(FootLanesOn, MatchTheScalarSearch) {
  const HeightField field = hills(GetParam());
  const FootLanes feet(field.view());
  int found = 0, touching = 0;
  for (int k = 0; k < 500; ++k) {
    contact::Vec3P centre, normal;
    contact::PointLanes overlap;
    for (int l = 0; l < contact::kPointLanes; ++l) {
      const double x = within(0, 8 * k + l, 0.98), y = within(1, 8 * k + l, 0.98);
      centre.x[l] = x, centre.y[l] = y, centre.z[l] = field.height(x, y) + kRadius + within(2, 8 * k + l, 2e-3);
    }
    const unsigned lanes = feet.find(centre, contact::allLanes(kRadius), normal, overlap);
    for (int l = 0; l < contact::kPointLanes; ++l) {
      if (!(lanes >> l & 1u)) continue;
      ++found;
      const FootPoint foot = field.closestPoint({centre.x[l], centre.y[l], centre.z[l]});
      const double expected = kRadius - foot.distance;
      if (expected <= 0) {
        EXPECT_LE(overlap[l], 1e-12);
        continue;
      }
      ++touching;
      EXPECT_NEAR(overlap[l], expected, 1e-11);
      EXPECT_LT(norm(Vec3d{normal.x[l], normal.y[l], normal.z[l]} - foot.normal), 1e-6);
    }
  }
  EXPECT_GT(found, 3900) << "of 4000";
  EXPECT_GT(touching, 1500);
}

/// If the iteration jumps over a crest, the scalar search returns the nearest point found.
TEST_P(FootLanesOn, LeaveFeetOnTheOtherSideOfACrestToTheScalarSearch) {
  const HeightField nodes = HeightField::sample(kArea, 101, 101, [](double x, double y) {
    return 0.2 * base::uniform(9, 1, static_cast<int>(std::lround(1e3 * x)), static_cast<int>(std::lround(1e3 * y)));
  });
  const HeightField field(kArea, 101, 101, nodes.heights(), GetParam());
  const FootLanes feet(field.view());
  int found = 0;
  for (int k = 0; k < 20000; ++k) {
    contact::Vec3P centre, normal;
    contact::PointLanes overlap;
    for (int l = 0; l < contact::kPointLanes; ++l) {
      const double x = within(3, 8 * k + l, 0.9), y = within(4, 8 * k + l, 0.9);
      centre.x[l] = x, centre.y[l] = y, centre.z[l] = field.height(x, y) + within(5, 8 * k + l, 0.12);
    }
    const unsigned lanes = feet.find(centre, contact::allLanes(kRadius), normal, overlap);
    for (int l = 0; l < contact::kPointLanes; ++l) {
      if (!(lanes >> l & 1u)) continue;
      ++found;
      const Vec3d p{centre.x[l], centre.y[l], centre.z[l]};
      EXPECT_EQ(overlap[l] > kRadius, p.z < field.height(p.x, p.y)) << k << ' ' << l;
    }
  }
  EXPECT_GT(found, 20000);
}

TEST_P(FootLanesOn, LeaveBorderAndHollowsToTheScalarSearch) {
  const HeightField field = hills(GetParam());
  contact::Vec3P centre = contact::allLanes(Vec3d{0, 0, field.height(0, 0) + kRadius}), normal;
  contact::PointLanes overlap;
  centre.x[2] = 0.995, centre.y[5] = -1.2;
  EXPECT_EQ(FootLanes(field.view()).find(centre, contact::allLanes(kRadius), normal, overlap), 0xffu - 4 - 32);

  // Valleys of 45 degrees: a sphere has two feet there.
  const HeightField steep = HeightField(
      kArea, 201, 5, HeightField::sample(kArea, 201, 5, [](double x, double) { return std::fabs(x); }).heights(),
      GetParam());
  const SearchedHeightField searched(base::cpuExec(1), steep, kRadius);
  centre = contact::allLanes(Vec3d{0, 0, kRadius});
  centre.x[0] = 0.5, centre.z[0] = 0.5 + kRadius;
  EXPECT_EQ(FootLanes(searched.view()).find(centre, contact::allLanes(kRadius), normal, overlap), 1u);
}

TEST(FootLanes, DoNotServeBilinearGround) {
  const HeightField field = hills(Interpolation::bilinear);
  contact::Vec3P centre = contact::allLanes(Vec3d{0, 0, 0}), normal;
  contact::PointLanes overlap;
  EXPECT_EQ(FootLanes(field.view()).find(centre, contact::allLanes(kRadius), normal, overlap), 0u);
}

} // namespace
} // namespace grouser::terrain
