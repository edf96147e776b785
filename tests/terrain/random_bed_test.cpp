// SPDX-License-Identifier: BSD-3-Clause
// Random beds, and fixed grains on their floors, before settling.
#include "terrain/bed.hpp"

#include "base/error.hpp"
#include "base/sphere.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace grouser::terrain {

namespace {

constexpr Rectangle kArea{0, 0.8, -0.3, 0.3};

RandomBedOptions options() {
  RandomBedOptions o;
  o.radii = {RadiusLaw::uniform, 0.02, 0.25, {}, {}};
  o.depth = 0.3, o.porosity = 0.42, o.seed = 5;
  return o;
}

HeightField level() { return HeightField::flat(kArea, 0.1); }
HeightField hilly() {
  return HeightField::sample(kArea, 33, 25, [](double x, double y) { return 0.1 * std::sin(5 * x) + 0.05 * y; });
}

/// The deepest overlap of two grains, not both fixed, over the smaller radius; periods along x and y or 0.
double deepestOverlap(const std::vector<Seed>& grains, double periodX = 0, double periodY = 0) {
  double deepest = -1;
  for (std::size_t a = 0; a < grains.size(); ++a)
    for (std::size_t b = a + 1; b < grains.size(); ++b) {
      if (grains[a].fixed && grains[b].fixed) continue;
      Vec3d d = grains[a].centre - grains[b].centre;
      if (periodX > 0) d.x -= periodX * std::round(d.x / periodX);
      if (periodY > 0) d.y -= periodY * std::round(d.y / periodY);
      deepest = std::max(deepest, (grains[a].radius + grains[b].radius - norm(d)) /
                                      std::min(grains[a].radius, grains[b].radius));
    }
  return deepest;
}

double solidVolume(const std::vector<Seed>& grains) {
  double volume = 0;
  for (const Seed& s : grains) volume += s.fixed ? 0 : base::sphereVolume(s.radius);
  return volume;
}

} // namespace

TEST(RandomBed, HasTheVolumeThatTheDepthNeedsAndTheNumberThatIsPlanned) {
  const std::vector<Seed> grains = layGrains(level(), options());
  const double wanted = 0.8 * 0.6 * (0.3 - 1.15 * 0.02) * 0.58;
  EXPECT_NEAR(solidVolume(grains), wanted, base::sphereVolume(0.025));
  // A grain volume scatters by 0.43 of its mean, their sum by 0.43 sqrt(number).
  const auto planned = static_cast<double>(planBed(level(), options()).grains);
  EXPECT_NEAR(static_cast<double>(grains.size()), planned, 3 * 0.43 * std::sqrt(planned));
}

TEST(RandomBed, NoTwoGrainsTouchNorFloorNorWalls) {
  for (const HeightField& surface : {level(), hilly()})
    for (const FloorShape floor : {FloorShape::follow, FloorShape::flat}) {
      RandomBedOptions o = options();
      o.floor = floor;
      const std::vector<Seed> grains = layGrains(surface, o);
      EXPECT_LT(deepestOverlap(grains), 0);
      const BedPlan plan = planBed(surface, o);
      for (const Seed& s : grains) {
        EXPECT_GT(plan.floor.closestPoint(s.centre).distance, s.radius);
        EXPECT_TRUE(s.centre.x > kArea.xMin + s.radius && s.centre.x < kArea.xMax - s.radius);
        EXPECT_TRUE(s.centre.y > kArea.yMin + s.radius && s.centre.y < kArea.yMax - s.radius);
      }
    }
}

TEST(RandomBed, PeriodicBedsDoNotTouchAcrossTheirSides) {
  RandomBedOptions o = options();
  o.periodic = {true, true};
  const std::vector<Seed> grains = layGrains(level(), o);
  EXPECT_LT(deepestOverlap(grains, 0.8, 0.6), 0);
  EXPECT_TRUE(std::any_of(grains.begin(), grains.end(), [](const Seed& s) { return s.centre.x < s.radius; }))
      << "and reach through them";
}

TEST(RandomBed, IsDisorderedAndEven) {
  // Layers of a lattice have peaks of height 1 in the Fourier sum over x, random positions do not.
  const std::vector<Seed> grains = layGrains(level(), options());
  for (const double pitch : {0.04, 0.042, 0.05}) {
    double c = 0, s = 0;
    for (const Seed& g : grains)
      c += std::cos(2 * M_PI * g.centre.x / pitch), s += std::sin(2 * M_PI * g.centre.x / pitch);
    EXPECT_LT(std::hypot(c, s) / static_cast<double>(grains.size()), 5 / std::sqrt(double(grains.size())));
  }
  // The column is evenly filled: half of the volume is below half of its height.
  const double top = (0.3 - 1.15 * 0.02) * 0.58 / 0.28;
  double below = 0;
  for (const Seed& g : grains) below += g.centre.z - g.radius + 0.2 < 0.5 * top ? base::sphereVolume(g.radius) : 0;
  EXPECT_NEAR(below / solidVolume(grains), 0.5, 0.05);
}

TEST(RandomBed, AnotherSeedMakesAnotherBedAndTheSameSeedTheSame) {
  RandomBedOptions other = options();
  other.seed = 6;
  const std::vector<Seed> a = layGrains(level(), options()), b = layGrains(level(), options()),
                          c = layGrains(level(), other);
  ASSERT_EQ(a.size(), b.size());
  EXPECT_EQ(a[100].centre.x, b[100].centre.x);
  EXPECT_NE(a[100].centre.x, c[100].centre.x);
}

TEST(RandomBed, GradedBedIsCoarseBelowAndTakesFarFewerGrains) {
  RandomBedOptions fine = options(), graded = options();
  fine.radii.radius = graded.radii.radius = 0.01;
  graded.grading = {0.08, 0.08, 0.025};
  const std::vector<Seed> some = layGrains(level(), graded);
  const double all = static_cast<double>(planBed(level(), fine).grains);
  EXPECT_LT(static_cast<double>(some.size()), 0.6 * all);
  EXPECT_NEAR(solidVolume(some), 0.8 * 0.6 * (0.3 - 1.15 * 0.01) * 0.58, 2 * base::sphereVolume(largestRadius(graded)));
  // Radii follow the initial height of the grain, within the window of its cell.
  double low = 0, high = 0;
  int lows = 0, highs = 0;
  for (const Seed& s : some) {
    if (s.centre.z < -0.1) low += s.radius, ++lows;
    if (s.centre.z > 0.25) high += s.radius, ++highs;
  }
  ASSERT_TRUE(lows > 10 && highs > 100);
  EXPECT_GT(low / lows, 1.8 * high / highs);
  EXPECT_NEAR(high / highs, 0.01, 5e-4);
}

TEST(FloorGrains, CoverTheFloorAndStayWhereGrainsMayLieOnThem) {
  BedOptions o;
  o.grains = options();
  o.floorGrains = FloorGrainOptions{options().radii, 1, {}, 5};
  for (const HeightField& surface : {level(), hilly()}) {
    const std::vector<Seed> grains = layBed(surface, o);
    const BedPlan plan = planBed(surface, o);
    const auto fixed = std::count_if(grains.begin(), grains.end(), [](const Seed& s) { return s.fixed; });
    EXPECT_EQ(fixed, fixedGrains(plan, o));
    EXPECT_NEAR(static_cast<double>(fixed), 0.48 / (0.04 * 0.04), 1);
    EXPECT_LT(deepestOverlap(grains), 0);
    for (std::size_t g = 0; g < grains.size(); ++g) {
      EXPECT_EQ(grains[g].fixed, static_cast<std::int64_t>(g) < fixed) << "grains of the floor come first";
      if (!grains[g].fixed) continue;
      const double up = grains[g].centre.z - plan.floor.height(grains[g].centre.x, grains[g].centre.y);
      EXPECT_LE(up, 0);
      EXPECT_GE(up, -0.5 * grains[g].radius);
    }
    // No grain of the smallest radius fits between them down to the floor without contact.
    int free = 0, looked = 0;
    for (double x = 0.1; x < 0.7; x += 0.013)
      for (double y = -0.2; y < 0.2; y += 0.013, ++looked) {
        const Vec3d p{x, y, plan.floor.height(x, y) + 0.016};
        free += std::none_of(grains.begin(), grains.begin() + fixed,
                             [&](const Seed& s) { return norm(s.centre - p) < s.radius + 0.015; });
      }
    EXPECT_LT(free, 0.05 * looked);
  }
}

TEST(FloorGrains, LayersLieAboveThem) {
  BedOptions o;
  LayerOptions layers;
  layers.radius = 0.03, layers.layers = 3;
  o.grains = layers;
  o.floorGrains = FloorGrainOptions{{RadiusLaw::single, 0.03, 0, {}, {}}, 1, {}, 5};
  for (const HeightField& surface : {level(), hilly()}) EXPECT_LT(deepestOverlap(layBed(surface, o)), 0);
}

TEST(RandomBed, RefusesWhatCannotBe) {
  RandomBedOptions o = options();
  o.depth = 0;
  EXPECT_THROW(planBed(level(), o), base::InputError);
  o = options(), o.porosity = 0.1;
  EXPECT_THROW(planBed(level(), o), base::InputError);
  o = options(), o.radii.radius = 0.4;
  EXPECT_THROW(layGrains(level(), o), base::InputError);
}

} // namespace grouser::terrain
