// SPDX-License-Identifier: BSD-3-Clause
// Boxes over the cells of a height-field: boxes near the ground, and boxes over one plane.
#include "terrain/height_field_cells.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace grouser::terrain {
namespace {

/// Level ground with a ditch along y, 30 mm deep, with planar facets; the ditch ends at y = 0.5 m.
HeightField ditch() {
  const Rectangle area{-1, 1, -1, 1};
  const HeightField nodes = HeightField::sample(
      area, 81, 81, [](double x, double y) { return std::fabs(x) < 0.06 && y < 0.5 ? -0.03 : 0.0; });
  return HeightField(area, 81, 81, nodes.heights(), Interpolation::bilinear);
}

HeightFieldCells::Under underOf(const HeightFieldCells& cells, double x0, double x1, double z) {
  return cells.under({x0, -0.01, z}, {x1, 0.01, z + 0.01});
}

TEST(HeightFieldCells, PlanarGroundIsFoundOnBothSidesOfADitch) {
  const HeightFieldCells cells(ditch());
  const Plane* right = underOf(cells, 0.08, 0.09, -0.001).plane;
  ASSERT_TRUE(right);
  EXPECT_EQ(right->normal, (Vec3d{0, 0, 1}));
  EXPECT_EQ(right->height, 0);
  EXPECT_EQ(underOf(cells, -0.09, -0.08, -0.001).plane, right) << "one plane";
  EXPECT_EQ(cells.under({-0.5, 0.6, -0.001}, {0.5, 0.65, 0}).plane, right) << "beyond the end of the ditch";
  const Plane* bottom = underOf(cells, -0.01, 0.01, -0.031).plane;
  ASSERT_TRUE(bottom);
  EXPECT_NEAR(bottom->height, -0.03, 1e-15);
  EXPECT_FALSE(underOf(cells, 0.04, 0.09, -0.001).plane) << "over the wall";
}

TEST(HeightFieldCells, DeepBoxesBesideAWallAreOverNoPlane) {
  const HeightFieldCells cells(ditch());
  EXPECT_TRUE(underOf(cells, 0.08, 0.09, -0.004).plane);
  EXPECT_FALSE(underOf(cells, 0.08, 0.09, -0.02).plane) << "the wall may be nearer than the ground above";
  EXPECT_TRUE(underOf(cells, 0.11, 0.12, -0.02).plane) << "too far from the wall";
}

TEST(HeightFieldCells, BoxesAreNearWhereACellUnderThemIsHighEnough) {
  const HeightFieldCells cells(ditch());
  EXPECT_TRUE(cells.near({-0.2, -0.01, -0.01}, {0.2, 0.01, 0}));
  EXPECT_FALSE(cells.near({-0.02, -0.01, -0.01}, {0.02, 0.01, 0})) << "in the ditch, above its bottom";
  EXPECT_FALSE(cells.near({-0.2, -0.01, 0.01}, {0.2, 0.01, 0.02})) << "above all ground";
  EXPECT_TRUE(cells.near({0.9, -0.01, 0.01}, {1.1, 0.01, 0.02})) << "beyond the border any ground is possible";
  EXPECT_FALSE(cells.under({0.9, -0.01, -0.01}, {1.1, 0.01, 0}).plane);
}

} // namespace
} // namespace grouser::terrain
