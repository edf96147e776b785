// SPDX-License-Identifier: BSD-3-Clause
// Height fields with oblong cells: the cubic is exact for quadratics, so all values are in closed form.
#include "terrain/height_field.hpp"

#include "base/math.hpp"
#include "base/random.hpp"
#include "tests/rounding.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace grouser::terrain {
namespace {

using base::Vec3d;

using grouser::test::kEps;
constexpr std::uint64_t kCellsTest = base::purpose("terrain.unequal-cells-test");
/// 16 columns of 0.25 m, 25 rows of 0.05 m; the corner is not the origin.
constexpr Rectangle kCellsArea{-1.5, 2.25, 3, 4.2};
constexpr int kColumns = 16, kRows = 25;

double randomOf(int i, int k, double from, double to) {
  return from +
         (to - from) * base::uniform(5, kCellsTest, static_cast<std::uint64_t>(i), static_cast<std::uint64_t>(k));
}

double bowl(double x, double y) {
  const double v = y - 3.6;
  return 0.2 + 0.1 * x - 0.3 * v + 0.4 * x * x - 0.25 * x * v + 0.7 * v * v;
}
HeightField bowlField() { return HeightField::sample(kCellsArea, kColumns, kRows, bowl); }

TEST(UnequalCells, AQuadraticHasItsOwnHeightsSlopesAndCurvatures) {
  const HeightField field = bowlField();
  const HeightFieldView view = field.view();
  EXPECT_NEAR(view.dx, 0.25, kEps);
  EXPECT_NEAR(view.dy, 0.05, kEps);
  for (int i = 0; i < 500; ++i) {
    // A cell beyond the border, where the curve continues along its tangent.
    const double x = randomOf(i, 0, -1.25, 2.0), y = randomOf(i, 1, 3.05, 4.15), v = y - 3.6;
    const SurfaceJet s = view.jet(x, y);
    // Round-off of heights up to 3 m; over one cell for a slope, over two for a curvature.
    EXPECT_NEAR(s.h, bowl(x, y), 40 * kEps);
    EXPECT_EQ(view.height(x, y), s.h);
    EXPECT_NEAR(s.hx, 0.1 + 0.8 * x - 0.25 * v, 100 * kEps / 0.25);
    EXPECT_NEAR(s.hy, -0.3 - 0.25 * x + 1.4 * v, 100 * kEps / 0.05);
    EXPECT_NEAR(s.hxx, 0.8, 400 * kEps / (0.25 * 0.25));
    EXPECT_NEAR(s.hxy, -0.25, 400 * kEps / (0.25 * 0.05));
    EXPECT_NEAR(s.hyy, 1.4, 400 * kEps / (0.05 * 0.05));
  }
}

TEST(UnequalCells, AStepAcrossIsFeltInItsOwnDirectionOnly) {
  // Only one column, or one row, is raised.
  for (const bool column : {true, false}) {
    std::vector<double> heights;
    for (int j = 0; j < kRows; ++j)
      for (int i = 0; i < kColumns; ++i) heights.push_back((column ? i == 6 : j == 6) ? 0.1 : 0.0);
    const HeightField field(kCellsArea, kColumns, kRows, heights);
    const double x = column ? -1.5 + 6 * 0.25 : 0.3, y = column ? 3.7 : 3 + 6 * 0.05;
    EXPECT_NEAR(field.height(x, y), 0.1, 10 * kEps);
    EXPECT_NEAR(field.height(x + (column ? 0.5 : 0), y + (column ? 0 : 0.1)), 0, 10 * kEps) << "two nodes away";
    // Half-way to the next node a Catmull-Rom cubic has 9/16 of it.
    EXPECT_NEAR(field.height(x + (column ? 0.125 : 0), y + (column ? 0 : 0.025)), 0.1 * 9 / 16, 100 * kEps);
    EXPECT_NEAR(field.height(x + (column ? 0 : 0.31), y + (column ? 0.17 : 0)), 0.1, 10 * kEps) << "along the row";
  }
}

TEST(UnequalCells, ClosestPointIsTheFootOfTheNormal) {
  const HeightField field = bowlField();
  // Sharpest hollow: the larger principal curvature is below hxx + hyy = 2.2 / m.
  for (int i = 0; i < 500; ++i) {
    const double x = randomOf(i, 0, -1.0, 1.75), y = randomOf(i, 1, 3.2, 4.0), v = y - 3.6,
                 d = randomOf(i, 2, -0.2, 0.2);
    const Vec3d n = base::normalized(Vec3d{-(0.1 + 0.8 * x - 0.25 * v), -(-0.3 - 0.25 * x + 1.4 * v), 1.0});
    const Vec3d foot{x, y, bowl(x, y)};
    const FootPoint is = field.closestPoint(foot + n * d);
    EXPECT_NEAR(is.distance, d, 1e-13) << i;
    EXPECT_NEAR(norm(is.normal - n), 0, 1e-10) << i;
    EXPECT_NEAR(norm(is.point - foot), 0, 1e-10) << i;
  }
}

TEST(UnequalCells, ClosestPointOnAPlaneIsExact) {
  const HeightField plane =
      HeightField::sample(kCellsArea, kColumns, kRows, [](double x, double y) { return 0.3 * x - 1.2 * y + 2; });
  const Vec3d n = base::normalized(Vec3d{-0.3, 1.2, 1.0});
  for (int i = 0; i < 200; ++i) {
    const Vec3d p{randomOf(i, 0, -1.5, 2.25), randomOf(i, 1, 3, 4.2), randomOf(i, 2, -4, 1)};
    const FootPoint foot = plane.closestPoint(p);
    EXPECT_NEAR(foot.distance, (p.z - (0.3 * p.x - 1.2 * p.y + 2)) * n.z, 1e-12);
    EXPECT_NEAR(norm(foot.normal - n), 0, 1e-12);
  }
  EXPECT_NEAR(plane.bounds().slope, std::sqrt(0.3 * 0.3 + 1.2 * 1.2), 1e-12);
  EXPECT_NEAR(plane.bounds().valleyCurvature, 0, 1e-9);
}

TEST(UnequalCells, BoundsOfAQuadraticAreItsOwn) {
  // Along y only, and along x only: the control net of a quadratic has its slope at the ends and constant curvature,
  // except for the outermost cells, where the surface continues along its tangent.
  const Rectangle inner{-1.2, 1.9, 3.07, 4.12};
  const HeightField alongY =
      HeightField::sample(kCellsArea, kColumns, kRows, [](double, double y) { return y * y / 2; });
  EXPECT_NEAR(alongY.boundsOver(inner).valleyCurvature, 1, 1e-9);
  EXPECT_NEAR(alongY.boundsOver(inner).slope, 4.15, 1e-12);
  const HeightField alongX =
      HeightField::sample(kCellsArea, kColumns, kRows, [](double x, double) { return x * x / 2; });
  EXPECT_NEAR(alongX.boundsOver(inner).valleyCurvature, 1, 1e-9);
  EXPECT_NEAR(alongX.boundsOver(inner).slope, 2, 1e-12);
  const HeightField twist =
      HeightField::sample(kCellsArea, kColumns, kRows, [](double x, double y) { return 0.5 * x * y; });
  EXPECT_NEAR(twist.bounds().valleyCurvature, 0.5, 1e-9);
}

TEST(UnequalCells, BoundsOverAPartTakeTheCellsOfThatPart) {
  const HeightField field = HeightField::sample(
      kCellsArea, kColumns, kRows, [](double x, double y) { return (x > 1.1 ? 1 : 0) + (y > 4.05 ? 2 : 0); });
  EXPECT_EQ(field.boundsOver({-1, 0.2, 3.2, 3.7}).highest, 0);
  EXPECT_NEAR(field.boundsOver({1.6, 1.9, 3.2, 3.7}).lowest, 1, 1e-12);
  EXPECT_NEAR(field.boundsOver({-1, 0.2, 4.16, 4.19}).highest, 2, 0.2);
}

TEST(UnequalCells, ClearOfUsesTheSteepestSlope) {
  const HeightField plane = HeightField::sample(kCellsArea, kColumns, kRows, [](double, double y) { return 2 * y; });
  // A ball of 0.1 m touches a slope of 2 when it is less than 0.1 sqrt(5) above it.
  const double root = std::sqrt(5.0);
  EXPECT_FALSE(plane.view().clearOf({0.3, 3.6, 7.2 + 0.1 * root * (1 - 1e-9)}, 0.1));
  EXPECT_TRUE(plane.view().clearOf({0.3, 3.6, 7.2 + 0.1 * root * (1 + 1e-9)}, 0.1));
}

} // namespace
} // namespace grouser::terrain
