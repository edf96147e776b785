// SPDX-License-Identifier: BSD-3-Clause
#include "terrain/bed_surface.hpp"

#include "base/error.hpp"
#include "base/math.hpp"
#include "base/random.hpp"
#include "tests/rounding.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

namespace {

using namespace grouser::terrain;
namespace base = grouser::base;

using grouser::test::kEps;
constexpr double kRadius = 0.03;
constexpr Rectangle kArea{0, 3, -1, 1};
constexpr std::uint64_t kTest = base::purpose("terrain.bed-surface-test");

/// Touching grains in a square lattice, several layers thick, with tops at top(x, y, i).
template <class F> std::vector<Seed> lattice(F&& top, int layers = 3) {
  std::vector<Seed> grains;
  for (int layer = 0; layer < layers; ++layer)
    for (double y = kArea.yMin + kRadius; y < kArea.yMax; y += 2.05 * kRadius)
      for (double x = kArea.xMin + kRadius; x < kArea.xMax; x += 2.05 * kRadius)
        grains.push_back({{x, y, top(x, y, grains.size()) - kRadius * (1 + 2 * layer)}, kRadius});
  return grains;
}

BedSurface surfaceOf(const std::vector<Seed>& grains, double floor = -1) {
  return BedSurface(grains, HeightField::flat(kArea, floor).view(), kArea, 2 * kRadius);
}

struct Bias {
  double mean{}, least{1e9}, most{-1e9};
};
/// Surface minus reference, over the area.
template <class F> Bias biasOf(const BedSurface& surface, F&& reference) {
  Bias bias;
  const int n = 150;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) {
      const double x = kArea.xMin + kArea.width() * i / n, y = kArea.yMin + kArea.length() * j / n;
      const double d = surface.height(x, y) - reference(x, y);
      bias.mean += d / ((n + 1) * (n + 1));
      bias.least = std::min(bias.least, d), bias.most = std::max(bias.most, d);
    }
  return bias;
}

TEST(BedSurface, OfALevelLattice_IsThePlaneOnItsTops) {
  const BedSurface surface = surfaceOf(lattice([](double, double, std::size_t) { return 0.25; }));
  const Bias bias = biasOf(surface, [](double, double) { return 0.25; });
  EXPECT_NEAR(bias.least, 0, 10 * kEps);
  EXPECT_NEAR(bias.most, 0, 10 * kEps);
}

TEST(BedSurface, OfAnInclinedLattice_StaysNearThePlaneOnItsTops) {
  // Bias in radii times the slope. Measured: mean -0.14, from -0.79 to 1.00; the highest top within a diameter
  // would have a bias of 0.9 on average.
  for (const double slope : {0.1, 0.36}) {
    const BedSurface surface = surfaceOf(lattice([=](double x, double, std::size_t) { return slope * x; }));
    const Bias bias = biasOf(surface, [=](double x, double) { return slope * x; });
    EXPECT_NEAR(bias.mean, 0, 0.2 * kRadius * slope);
    EXPECT_GT(bias.least, -kRadius * slope);
    EXPECT_LT(bias.most, 1.05 * kRadius * slope);
  }
}

TEST(BedSurface, OfAScatteredBed_LiesAboveTheMeanOfItsTopsByLessThanTheirScatter) {
  // Tops scatter uniformly by +- half a radius (standard deviation 0.29), centres by +- 0.4 radii in the plane.
  // Measured mean bias 0.07 radii; the highest top within a diameter would have 0.4 radii.
  std::vector<Seed> grains =
      lattice([](double, double, std::size_t g) { return kRadius * (base::uniform(2, kTest, g) - 0.5); });
  for (std::size_t g = 0; g < grains.size(); ++g) {
    grains[g].centre.x += 0.8 * kRadius * (base::uniform(2, kTest, g, 1) - 0.5);
    grains[g].centre.y += 0.8 * kRadius * (base::uniform(2, kTest, g, 2) - 0.5);
  }
  const Bias bias = biasOf(surfaceOf(grains), [](double, double) { return 0.0; });
  EXPECT_GT(bias.mean, 0.0);
  EXPECT_LT(bias.mean, 0.15 * kRadius);
  EXPECT_GE(bias.least, -0.5 * kRadius);
  EXPECT_LE(bias.most, 0.5 * kRadius);
}

TEST(BedSurface, TreatsXAndYAlike) {
  std::vector<Seed> grains =
      lattice([](double, double, std::size_t g) { return kRadius * (base::uniform(2, kTest, g) - 0.5); });
  const BedSurface surface = surfaceOf(grains);
  for (Seed& g : grains) std::swap(g.centre.x, g.centre.y);
  const Rectangle turned{kArea.yMin, kArea.yMax, kArea.xMin, kArea.xMax};
  const BedSurface mirrored(grains, HeightField::flat(turned, -1).view(), turned, 2 * kRadius);
  // Round-off of the smoothing: its two passes are interchanged.
  for (double x = 0; x < 3; x += 0.017)
    for (double y = -1; y < 1; y += 0.19) ASSERT_NEAR(surface.height(x, y), mirrored.height(y, x), 10 * kEps);
}

TEST(BedSurface, FollowsARut) {
  // Ruts of 0.6 m (ten diameters) and 0.1 m: bottom and banks are exact.
  const auto rut = [](double x, double, std::size_t) { return x > 1.2 && x < 1.8 ? -0.1 : 0.0; };
  const BedSurface surface = surfaceOf(lattice(rut));
  EXPECT_NEAR(surface.height(1.5, 0), -0.1, 10 * kEps);
  EXPECT_NEAR(surface.height(0.8, 0), 0, 10 * kEps);
  EXPECT_NEAR(surface.height(2.2, 0), 0, 10 * kEps);
}

TEST(BedSurface, WithoutGrains_IsTheFloor) {
  const HeightField floor = HeightField::plane(kArea, 0.1, 0.2, -0.1);
  const BedSurface surface({}, floor.view(), kArea, 2 * kRadius);
  // Lowest within a diameter: at most slope times diameter below the floor. Never above.
  const Bias bias = biasOf(surface, [&](double x, double y) { return floor.height(x, y); });
  EXPECT_GE(bias.least, -2 * kRadius * std::sqrt(0.05) - 10 * kEps);
  EXPECT_LE(bias.most, 10 * kEps);
}

TEST(BedSurface, WhereGrainsEnd_GoesDownToTheFloor) {
  std::vector<Seed> grains = lattice([](double, double, std::size_t) { return 0.25; });
  std::erase_if(grains, [](const Seed& g) { return g.centre.x > 1.5; });
  const BedSurface surface = surfaceOf(grains, 0.05);
  EXPECT_NEAR(surface.height(1.4, 0), 0.25, 10 * kEps);
  EXPECT_NEAR(surface.height(1.6 + 2 * kRadius, 0), 0.05, 10 * kEps);
}

TEST(BedSurface, DoesNotDependOnTheOrderOfGrains) {
  std::vector<Seed> grains =
      lattice([](double x, double y, std::size_t g) { return 0.1 * x * y + 0.01 * base::uniform(2, kTest, g); });
  const BedSurface a = surfaceOf(grains);
  std::reverse(grains.begin(), grains.end());
  for (std::size_t g = 0; g < grains.size(); ++g) std::swap(grains[g], grains[base::hash(1, kTest, g) % grains.size()]);
  EXPECT_EQ(a.heights(), surfaceOf(grains).heights());
}

TEST(BedSurface, OutsideItsArea_TakesTheNearestBorderPoint_AndIsNeverNaN) {
  const BedSurface surface = surfaceOf(lattice([](double x, double y, std::size_t) { return 0.1 * x + 0.2 * y; }));
  EXPECT_EQ(surface.height(-5, 0.3), surface.height(0, 0.3));
  EXPECT_EQ(surface.height(9, 7), surface.height(3, 1));
  EXPECT_TRUE(std::isfinite(surface.height(std::numeric_limits<double>::quiet_NaN(), 1e300)));
}

TEST(BedSurface, BrokenInput_IsAnError) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const HeightField floor = HeightField::flat(kArea, 0);
  EXPECT_THROW(BedSurface({}, floor.view(), kArea, 0), base::InputError);
  const std::vector<Seed> lost{{{nan, 0, 0}, kRadius}};
  EXPECT_THROW(BedSurface(lost, floor.view(), kArea, 2 * kRadius), base::InputError);
}

} // namespace
