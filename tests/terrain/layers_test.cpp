// SPDX-License-Identifier: BSD-3-Clause
#include "terrain/layers.hpp"

#include "base/error.hpp"
#include "base/math.hpp"
#include "base/random.hpp"
#include "tests/rounding.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <map>
#include <string>
#include <tuple>

namespace {

using namespace grouser::terrain;
namespace base = grouser::base;

using grouser::test::kEps;
constexpr double kRadius = 0.03;
constexpr Rectangle kLayersArea{0, 2, -0.5, 0.5};

HeightField level() { return HeightField::flat(kLayersArea, 0.5); }
HeightField steep() { return HeightField::plane(kLayersArea, 0, 0.7, -0.4); }
HeightField hills() {
  return HeightField::sample(kLayersArea, 81, 41, [](double x, double y) {
    return 0.1 * base::sin(2 * base::kPi * x / 0.8) * base::cos(2 * base::kPi * y / 0.7);
  });
}
/// A wall half a metre high across the path, over one spacing of 5 cm.
HeightField cliff() {
  return HeightField::sample(kLayersArea, 41, 21, [](double x, double) { return x < 1.01 ? 0.0 : 0.5; });
}
/// Spikes closer than a grain's diameter, slopes of 10 and more.
HeightField spikes() {
  std::uint64_t i = 0;
  return HeightField::sample(kLayersArea, 61, 31, [&](double, double) { return 0.3 * base::uniform(3, 1, i++); });
}

LayerOptions options(FloorShape floor = FloorShape::follow) {
  LayerOptions o;
  o.radius = kRadius, o.layers = 5, o.floor = floor, o.seed = 11;
  return o;
}

/// Smallest distance of two centres, by cells of one diameter.
double minDistance(const std::vector<Seed>& grains) {
  std::map<std::tuple<int, int, int>, std::vector<int>> cells;
  const auto cell = [](double v) { return static_cast<int>(std::floor(v / (2 * kRadius))); };
  double least = 1e9;
  for (int g = 0; g < static_cast<int>(grains.size()); ++g) {
    const Vec3d& c = grains[g].centre;
    const int i = cell(c.x), j = cell(c.y), k = cell(c.z);
    for (int a = -1; a <= 1; ++a)
      for (int b = -1; b <= 1; ++b)
        for (int d = -1; d <= 1; ++d)
          if (const auto near = cells.find({i + a, j + b, k + d}); near != cells.end())
            for (const int other : near->second) least = std::min(least, base::norm(grains[other].centre - c));
    cells[{i, j, k}].push_back(g);
  }
  return least;
}

/// Smallest distance between a grain and the floor points beneath its disc, on a grid; negative below the floor.
double minClearance(const HeightField& floor, const Seed& g) {
  double least = 1e9;
  const int n = 6;
  for (int b = -n; b <= n; ++b)
    for (int a = -n; a <= n; ++a) {
      const double x = g.centre.x + g.radius * a / n, y = g.centre.y + g.radius * b / n, z = floor.height(x, y);
      const double d = base::norm(Vec3d{x, y, z} - g.centre);
      least = std::min(least, (g.centre.z < z ? -d : d) - g.radius);
    }
  return least;
}

class LayersOnAnyGround : public ::testing::TestWithParam<std::tuple<HeightField (*)(), FloorShape, double, double>> {};

TEST_P(LayersOnAnyGround, NoGrainTouchesAnotherTheFloorOrAWall_AndThePlanCountsThem) {
  const auto [ground, floor, jitter, spacing] = GetParam();
  const HeightField surface = ground();
  LayerOptions o = options(floor);
  o.jitter = jitter, o.spacingInRadii = spacing, o.wallMargin = 0.05;
  const BedPlan plan = planBed(surface, o);
  const std::vector<Seed> grains = layGrains(surface, o);
  EXPECT_EQ(plan.grains, static_cast<std::int64_t>(grains.size()));
  ASSERT_GT(grains.size(), 1000u);
  EXPECT_GT(minDistance(grains), 2 * kRadius);
  for (const Seed& g : grains) {
    ASSERT_EQ(g.radius, kRadius);
    ASSERT_GT(minClearance(plan.floor, g), 0);
    ASSERT_GE(g.centre.x - kRadius, 0.05);
    ASSERT_LE(g.centre.x + kRadius, 1.95);
    ASSERT_GE(g.centre.y - kRadius, -0.45);
    ASSERT_LE(g.centre.y + kRadius, 0.45);
  }
}

INSTANTIATE_TEST_SUITE_P(All, LayersOnAnyGround,
                         ::testing::Combine(::testing::Values(level, steep, hills, cliff, spikes),
                                            ::testing::Values(FloorShape::follow, FloorShape::flat),
                                            ::testing::Values(0.0, 1.0), ::testing::Values(2.05, 2.6)));

TEST(Layers, WithoutJitterOnLevelGround_AreALatticeOneSpacingApart) {
  LayerOptions o = options();
  o.jitter = 0;
  const BedPlan plan = planBed(level(), o);
  const std::vector<Seed> grains = layGrains(level(), o);
  const double s = 2.1 * kRadius, floor = 0.5 - plan.thickness;
  ASSERT_EQ(plan.layers, 5);
  std::vector<double> z;
  for (const Seed& g : grains) z.push_back(g.centre.z);
  EXPECT_TRUE(std::is_sorted(z.begin(), z.end(), [](double a, double b) { return a < b - 1e-12; }));
  // Round-off of a few sums of 0.5 m; square roots of differences lose a digit.
  EXPECT_NEAR(z.front(), floor + 1.05 * kRadius, 10 * kEps);
  EXPECT_NEAR(z.back(), floor + 1.05 * kRadius + 4 * s, 100 * kEps);
  EXPECT_NEAR(grains[1].centre.x - grains[0].centre.x, s, 10 * kEps);
}

TEST(Layers, SecondLayer_IsOffsetByHalfASpacing) {
  LayerOptions o = options();
  o.jitter = 0;
  const std::vector<Seed> grains = layGrains(level(), o);
  const auto second = std::find_if(grains.begin(), grains.end(),
                                   [&](const Seed& g) { return g.centre.z > grains[0].centre.z + kRadius; });
  ASSERT_NE(second, grains.end());
  EXPECT_NEAR(second->centre.x - grains[0].centre.x, 1.05 * kRadius, 10 * kEps);
  EXPECT_NEAR(second->centre.y - grains[0].centre.y, 1.05 * kRadius, 10 * kEps);
}

TEST(Layers, ThicknessHoldsTheGrainsVolumeAtTheExpectedPacking) {
  for (const HeightField& surface : {level(), steep(), hills()}) {
    LayerOptions o = options();
    o.layers = 6; // an even number: odd and even layers may differ in count
    const BedPlan plan = planBed(surface, o);
    const double volume = static_cast<double>(plan.grains) * 4.0 / 3.0 * base::kPi * kRadius * kRadius * kRadius;
    EXPECT_NEAR(plan.thickness, volume / (0.6 * 2.0 * 1.0), 20 * kEps);
    EXPECT_NEAR(plan.floor.height(0.7, 0.1), surface.height(0.7, 0.1) - plan.thickness, 20 * kEps);
  }
}

TEST(Layers, DepthGivesTheNearestNumberOfLayers) {
  LayerOptions o = options();
  o.layers = 0;
  double before = 0;
  for (const double depth : {0.001, 0.1, 0.2, 0.3, 0.5}) {
    o.depth = depth;
    const BedPlan plan = planBed(level(), o);
    const double one = plan.thickness / plan.layers;
    EXPECT_GE(plan.layers, 1);
    if (depth > one) {
      EXPECT_LE(std::fabs(plan.thickness - depth), one / 2 + 1e-12);
    }
    EXPECT_GT(plan.thickness + 1e-12, before);
    before = plan.thickness;
  }
}

TEST(Layers, FlatFloor_IsOneBedBelowTheLowestPoint_AndFillsTheHills) {
  const HeightField surface = hills();
  const LayerOptions o = options(FloorShape::flat);
  const BedPlan plan = planBed(surface, o);
  const double lowest = *std::min_element(surface.heights().begin(), surface.heights().end());
  EXPECT_EQ(plan.floor.bounds().slope, 0.0);
  EXPECT_NEAR(plan.floor.height(0.3, 0.2), lowest - plan.thickness, 10 * kEps);
  EXPECT_GT(plan.layers, o.layers);

  // The grains' volume is that between floor and surface, at the expected packing: columns have whole numbers of layers
  // and no layer may overhang its supports; 5 % in total.
  const double volume =
      static_cast<double>(plan.grains) * 4.0 / 3.0 * base::kPi * kRadius * kRadius * kRadius / o.packing;
  double mean = 0;
  for (int j = 0; j < 100; ++j)
    for (int i = 0; i < 200; ++i) mean += surface.height(0.01 * (i + 0.5), -0.5 + 0.01 * (j + 0.5)) / 20000;
  const double space = (mean - lowest + plan.thickness) * 2.0 * 1.0;
  EXPECT_NEAR(volume, space, 0.05 * space);
}

TEST(Layers, OnASlope_FollowItEvenly) {
  // Mean height above the floor of each layer, on level ground and on a slope of 39 degrees: equal numbers of grains,
  // and no layer rises by more than the slope requires (half a spacing in x and y times the slopes).
  LayerOptions o = options();
  o.jitter = 0;
  const HeightField slope = steep();
  const BedPlan plan = planBed(slope, o);
  EXPECT_EQ(plan.grains, planBed(level(), o).grains);
  const double s = 2.1 * kRadius;
  for (const Seed& g : layGrains(slope, o)) {
    const double above = g.centre.z - plan.floor.height(g.centre.x, g.centre.y);
    EXPECT_LE(above, 1.05 * kRadius * std::sqrt(1 + 0.49 + 0.16) + 4 * s * (1 + (0.7 + 0.4) / 2) + 1e-12);
  }
}

TEST(Layers, SameSeed_SameBits_OtherSeed_OtherGrains) {
  LayerOptions o = options();
  const auto a = layGrains(hills(), o), b = layGrains(hills(), o);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t g = 0; g < a.size(); ++g) ASSERT_EQ(a[g].centre, b[g].centre);
  o.seed = 12;
  const auto c = layGrains(hills(), o);
  ASSERT_EQ(a.size(), c.size());
  int same = 0;
  for (std::size_t g = 0; g < a.size(); ++g) same += a[g].centre.x == c[g].centre.x;
  EXPECT_LE(same, 2);
}

TEST(Layers, MoreLayers_LeaveTheFirstOnesInPlace) {
  // Ids and random numbers of a grain depend only on the layers below. The floor sinks with the bed's thickness.
  LayerOptions o = options();
  const auto few = layGrains(level(), o);
  o.layers = 7;
  const auto many = layGrains(level(), o);
  ASSERT_GT(many.size(), few.size());
  for (std::size_t g = 0; g < few.size(); ++g) {
    ASSERT_EQ(few[g].centre.x, many[g].centre.x);
    ASSERT_EQ(few[g].centre.y, many[g].centre.y);
  }
}

TEST(Layers, JitterUsesItsShareOfTheGap) {
  LayerOptions o = options();
  o.jitter = 0;
  const auto still = layGrains(level(), o);
  for (const double share : {0.3, 1.0}) {
    o.jitter = share;
    // The lattice keeps the jitter's reach from the walls: compare distances of neighbours.
    const auto moved = layGrains(level(), o);
    double largest = 0;
    for (std::size_t g = 0; g + 1 < 30; ++g)
      largest = std::max(largest, std::fabs(moved[g + 1].centre.x - moved[g].centre.x - 2.1 * kRadius));
    const double gap = 0.1 * kRadius;
    EXPECT_LE(largest, share * gap);
    EXPECT_GT(largest, 0.5 * share * gap);
  }
  EXPECT_NEAR(still[1].centre.x - still[0].centre.x, 2.1 * kRadius, 10 * kEps);
}

TEST(Layers, ASingleColumnFits) {
  const HeightField narrow = HeightField::flat({0, 2.2 * kRadius, 0, 2.2 * kRadius}, 0);
  LayerOptions o = options();
  o.jitter = 0;
  const auto grains = layGrains(narrow, o);
  ASSERT_EQ(grains.size(), 5u);
  EXPECT_GT(minDistance(grains), 2 * kRadius);
}

TEST(Layers, BrokenOptions_GiveAnErrorThatNamesTheOption) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto errorOf = [](auto&& change) -> std::string {
    LayerOptions o = options();
    change(o);
    try {
      planBed(level(), o);
    } catch (const base::InputError& error) {
      return error.what();
    }
    return "no error";
  };
  using O = LayerOptions;
  const std::vector<std::pair<std::string, std::string>> cases{
      {errorOf([](O& o) { o.radius = 0; }), "radius"},
      {errorOf([=](O& o) { o.radius = nan; }), "radius"},
      {errorOf([](O& o) { o.radius = 0.6; }), "no grain of radius"},
      {errorOf([](O& o) { o.layers = -1; }), "layers"},
      {errorOf([](O& o) { o.layers = 0; }), "depth"},
      {errorOf([](O& o) { o.layers = 0, o.depth = 1e9; }), "layers"},
      {errorOf([](O& o) { o.spacingInRadii = 2; }), "spacing"},
      {errorOf([](O& o) { o.jitter = 1.5; }), "jitter"},
      {errorOf([](O& o) { o.packing = 0.9; }), "packing"},
      {errorOf([](O& o) { o.wallMargin = -1; }), "wall margin"},
      {errorOf([](O& o) { o.wallMargin = 0.5; }), "no grain of radius"},
  };
  for (const auto& [message, cause] : cases) EXPECT_NE(message.find(cause), std::string::npos) << message;
}

} // namespace
