// SPDX-License-Identifier: BSD-3-Clause
#include "terrain/feet_search.hpp"

#include "base/math.hpp"
#include "base/random.hpp"
#include "terrain/searched_height_field.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace {

using namespace grouser::terrain;
using grouser::base::dot;
using grouser::base::Exec;
using grouser::base::norm;
namespace base = grouser::base;

constexpr std::uint64_t kTest = base::purpose("terrain.feet-search-test");
constexpr Rectangle kArea{0, 2, -1, 1};
double random(int i, int k, double from, double to) { return from + (to - from) * base::uniform(3, kTest, i, k); }

template <class F> HeightField fieldOf(Interpolation how, int columns, int rows, F&& h) {
  const HeightField nodes = HeightField::sample(kArea, columns, rows, h);
  return HeightField(kArea, columns, rows, nodes.heights(), how);
}

Feet feetOf(const HeightField& field, const Vec3d& p, double radius) {
  const SearchedHeightField searched(Exec{}, field, radius);
  Feet feet;
  FeetSearch(searched.view(), p, radius).run(feet);
  return feet;
}

class OnEveryGround : public ::testing::TestWithParam<Interpolation> {};
INSTANTIATE_TEST_SUITE_P(Feet, OnEveryGround,
                         ::testing::Values(Interpolation::monotone, Interpolation::smooth, Interpolation::bilinear));

TEST_P(OnEveryGround, SphereInAValleyOf45Degrees_HasAFootOnEachFlank) {
  const HeightField valley = fieldOf(GetParam(), 41, 5, [](double x, double) { return std::fabs(x - 1); });
  const double radius = 0.1, depth = radius * std::sqrt(2.0);
  for (const double overlap : {1e-6, 1e-3, 1e-2}) {
    const Feet feet = feetOf(valley, {1, 0.1, depth - overlap * std::sqrt(2.0)}, radius);
    ASSERT_EQ(feet.count, 2);
    for (int k = 0; k < 2; ++k) {
      EXPECT_NEAR(radius - feet.foot[k].distance, overlap, 1e-12);
      EXPECT_NEAR(std::fabs(feet.foot[k].normal.x), std::sqrt(0.5), 1e-9);
    }
    EXPECT_LT(feet.foot[0].normal.x * feet.foot[1].normal.x, 0);
  }
}

TEST_P(OnEveryGround, SphereAtTheBorder_TouchesTheTangentBeyondIt) {
  const HeightField valley = fieldOf(GetParam(), 41, 5, [](double x, double) { return std::fabs(x - 0.1); });
  const Feet feet = feetOf(valley, {0.1, 0.99, 0.2 * std::sqrt(2.0) - 1e-3}, 0.2);
  ASSERT_EQ(feet.count, 2);
  for (int k = 0; k < 2; ++k) EXPECT_NEAR(0.2 - feet.foot[k].distance, 1e-3 / std::sqrt(2.0), 1e-12);
  EXPECT_LT(std::min(feet.foot[0].point.x, feet.foot[1].point.x), 0);
}

TEST_P(OnEveryGround, SphereBesideAWall_TouchesWallAndFloor) {
  // A step of two radii across one pixel of a fifth of a radius.
  const HeightField step = fieldOf(GetParam(), 101, 5, [](double x, double) { return x > 0.99 ? 0.2 : 0.0; });
  for (const double away : {0.1, 0.095}) {
    const Feet feet = feetOf(step, {0.98 + 0.004 - away, 0.1, 0.0999}, 0.1);
    ASSERT_GE(feet.count, 1);
    EXPECT_NEAR(feet.foot[0].normal.z, 1, 0.02);
    EXPECT_LE(feet.count, 2);
  }
  EXPECT_EQ(feetOf(step, {0.89, 0.1, 0.0999}, 0.1).count, 2);
}

TEST_P(OnEveryGround, SphereInAPyramidsPit_HasAFootOnEachSide) {
  const HeightField four =
      fieldOf(GetParam(), 41, 41, [](double x, double y) { return std::max(std::fabs(x - 1), std::fabs(y)); });
  const double radius = 0.15;
  EXPECT_EQ(feetOf(four, {1, 0, radius * std::sqrt(2.0) - 1e-3}, radius).count, 4);
  const auto three = [](double x, double y) {
    double h = -1;
    for (int k = 0; k < 3; ++k)
      h = std::max(h, (x - 1) * base::cos(2 * base::kPi * k / 3 + 0.1) + y * base::sin(2 * base::kPi * k / 3 + 0.1));
    return h;
  };
  EXPECT_EQ(feetOf(fieldOf(GetParam(), 81, 81, three), {1, 0, radius * std::sqrt(2.0) - 2e-3}, radius).count, 3);
}

TEST_P(OnEveryGround, SphereOnARidgeOrAPeak_HasOneFoot) {
  const HeightField ridge = fieldOf(GetParam(), 41, 41, [](double x, double) { return -std::fabs(x - 1); });
  const HeightField peak =
      fieldOf(GetParam(), 41, 41, [](double x, double y) { return -std::max(std::fabs(x - 1), std::fabs(y)); });
  for (const HeightField* ground : {&ridge, &peak})
    for (const double off : {0.0, 1e-9, 0.001, 0.011}) {
      const Feet feet = feetOf(*ground, {1 + off, 0, 0.095}, 0.1);
      ASSERT_EQ(feet.count, 1) << off;
      EXPECT_NEAR(norm(feet.foot[0].normal), 1, 1e-12);
    }
}

TEST_P(OnEveryGround, PlaneInAnyCell_HasOneFootAtItsDistance) {
  // A hollow elsewhere requires a search in all cells within a radius.
  const HeightField field = fieldOf(GetParam(), 41, 41, [](double x, double) { return std::max(0.5 * (x - 1), 0.0); });
  for (int i = 0; i < 200; ++i) {
    const Vec3d p{random(i, 0, 0.3, 0.9), random(i, 1, -0.8, 0.8), 0.0999};
    const Feet feet = feetOf(field, p, 0.1);
    ASSERT_EQ(feet.count, 1) << p.x;
    EXPECT_NEAR(feet.foot[0].distance, 0.0999, 1e-12);
  }
}

/// Local minima of the distance on a dense lattice about `p`, within `radius`; lower than all within two nodes.
std::vector<double> denseMinima(const HeightFieldView& view, const Vec3d& p, double radius, int n) {
  const int size = 2 * n + 1;
  std::vector<double> d(static_cast<std::size_t>(size) * size);
  const auto x = [&](int i) { return p.x + radius * (i - n) / n; };
  const auto y = [&](int j) { return p.y + radius * (j - n) / n; };
  for (int j = 0; j < size; ++j)
    for (int i = 0; i < size; ++i)
      d[static_cast<std::size_t>(j) * size + i] = norm(Vec3d{x(i), y(j), view.height(x(i), y(j))} - p);
  std::vector<double> minima;
  for (int j = 2; j < size - 2; ++j)
    for (int i = 2; i < size - 2; ++i) {
      const double here = d[static_cast<std::size_t>(j) * size + i];
      bool lowest = here < radius;
      for (int b = -2; lowest && b <= 2; ++b)
        for (int a = -2; a <= 2; ++a)
          if ((a || b) && d[static_cast<std::size_t>(j + b) * size + i + a] <= here) lowest = false;
      if (lowest) minima.push_back(here);
    }
  return minima;
}

TEST_P(OnEveryGround, OnNoise_FindsWhatADenseSearchFinds) {
  int missed = 0, extra = 0, total = 0, wrongNearest = 0;
  for (const double radius : {0.06, 0.2}) {
    int i = 0;
    // Cells of 0.1 m, slopes up to 2.
    const HeightField field = fieldOf(GetParam(), 21, 21, [&](double, double) { return random(i++, 7, 0, 0.1); });
    const SearchedHeightField searched(Exec{}, field, radius);
    for (int k = 0; k < 50; ++k) {
      // Typical depths of grains in the ground: the deepest overlap is 0 to 0.1 radii.
      Vec3d p{random(k, 0, 0.3, 1.7), random(k, 1, -0.7, 0.7), 0.5};
      const double overlap = radius * random(k, 2, 0, 0.1);
      double low = 0, high = 0.5;
      for (int b = 0; b < 40; ++b) {
        p.z = 0.5 * (low + high);
        FootPoint foot;
        const bool touches = deepestFoot(searched.view(), p, radius, foot) && radius - foot.distance > overlap;
        (touches ? low : high) = p.z;
      }
      Feet feet;
      FeetSearch(searched.view(), p, radius).run(feet);
      const std::vector<double> dense = denseMinima(field.view(), p, radius, 100);
      ASSERT_GT(feet.count, 0);
      for (const double d : dense) {
        bool found = false;
        // The lattice's spacing squared over twice the radius, times a curvature of ten radii; at creases the spacing.
        for (int f = 0; f < feet.count; ++f) found = found || std::fabs(feet.foot[f].distance - d) < 0.02 * radius;
        missed += !found, ++total;
      }
      extra += feet.count > static_cast<int>(dense.size());
      if (!dense.empty() && feet.nearest().distance > *std::min_element(dense.begin(), dense.end()) + 1e-9)
        ++wrongNearest;
    }
  }
  EXPECT_LE(missed, total / 100); // minima with a rise of 1e-4 radii around them
  EXPECT_EQ(wrongNearest, 0);
  EXPECT_LE(extra, total / 50);
}

TEST(Feet, InAHollowWiderThanTheSphere_AreOne) {
  const HeightField bowl = fieldOf(Interpolation::smooth, 81, 81, [](double x, double y) {
    return -std::sqrt(std::max(0.04, 1 - (x - 1) * (x - 1) - y * y));
  });
  EXPECT_EQ(feetOf(bowl, {1, 0, -0.1 - 1e-3}, 0.9).count, 1);
}

TEST(Feet, OfACentreBelowTheGround_AreTheNearestAlone) {
  const HeightField valley = fieldOf(Interpolation::monotone, 41, 5, [](double x, double) { return std::fabs(x - 1); });
  const Feet feet = feetOf(valley, {1.03, 0, -0.01}, 0.1);
  ASSERT_EQ(feet.count, 1);
  EXPECT_LT(feet.foot[0].distance, 0);
}

TEST_P(OnEveryGround, CentreDeepBelowTheGround_IsStillFelt) {
  // The run must stop there; the grain must not keep falling.
  int i = 0;
  const HeightField rough = fieldOf(GetParam(), 21, 21, [&](double, double) { return random(i++, 7, 0, 0.1); });
  for (int k = 0; k < 50; ++k) {
    const Feet feet = feetOf(rough, {random(k, 0, 0.3, 1.7), random(k, 1, -0.7, 0.7), random(k, 2, -0.5, -0.05)}, 0.06);
    ASSERT_EQ(feet.count, 1);
    EXPECT_LT(feet.foot[0].distance, 0);
  }
}

/// Feet on flanks of slope 1 that meet in a crease, the centre `off` beside its plane of symmetry.
Feet feetInCrease(double radius, double overlap, double off, double slope) {
  const HeightField valley =
      fieldOf(Interpolation::bilinear, 41, 5, [&](double x, double) { return slope * std::fabs(x - 1); });
  const double along = std::sqrt(1 + slope * slope);
  return feetOf(valley, {1 + off, 0.1, (radius - overlap) * along}, radius);
}

TEST(FeetLoads, OfFeetApart_AreThoseOfTheirOverlaps) {
  const Feet feet = feetInCrease(0.1, 1e-3, 0, 1);
  for (const bool hertz : {false, true}) {
    const FeetLoads loads(feet, 0.1, hertz);
    EXPECT_EQ(loads.merges(), 0);
    for (int k = 0; k < 2; ++k) {
      EXPECT_EQ(loads.share(k), 1);
      EXPECT_NEAR(loads.overlap(k), 1e-3, 1e-12);
    }
  }
}

TEST(FeetLoads, InAGentleCrease_AreTheSlopeOfTheirEnergy) {
  // The bottom of the crease is 4e-4 of 1e-3 m overlap above both feet's depth: two feet of one contact.
  const double radius = 0.1, slope = std::sqrt(8e-3), rise = 1e-5, step = 2e-4;
  for (const bool hertz : {false, true})
    for (const double off : {0.0, 1e-3, 4e-3, 7e-3, 8.5e-3}) {
      const auto energy = [&](double x, double overlap) {
        const Feet feet = feetInCrease(radius, overlap, x, slope);
        const FeetLoads loads(feet, radius, hertz);
        const auto u = [&](double depth) {
          return hertz ? 0.4 * depth * depth * std::sqrt(depth) : 0.5 * depth * depth;
        };
        double sum = 0;
        for (int k = 0; k < feet.count; ++k) sum += u(radius - feet.foot[k].distance);
        for (int m = 0; m < loads.merges(); ++m) sum -= u(loads.merged(m));
        return sum;
      };
      const Feet feet = feetInCrease(radius, 1e-3, off, slope);
      ASSERT_EQ(feet.count, 2) << off;
      const FeetLoads loads(feet, radius, hertz);
      EXPECT_EQ(loads.merges(), 1);
      Vec3d force;
      for (int k = 0; k < 2; ++k) {
        const double depth = loads.overlap(k);
        force += feet.foot[k].normal * (hertz ? depth * std::sqrt(depth) : depth);
      }
      const double along = std::sqrt(1 + slope * slope);
      const double up = (energy(off, 1e-3 + rise) - energy(off, 1e-3 - rise)) / (2 * rise * along);
      const double aside = -(energy(off + step, 1e-3) - energy(off - step, 1e-3)) / (2 * step);
      // The direction of the crease's bottom is between the normals, to the square of their angle.
      EXPECT_NEAR(force.z, up, 3e-3 * up) << off << (hertz ? " hertz" : "");
      EXPECT_NEAR(force.x, aside, 3e-3 * up) << off << (hertz ? " hertz" : "");
    }
}

TEST(FeetLoads, OnTheStepsOfAnEightBitMap_AreThoseOfOneContact) {
  // A dish of 10 m radius in steps of 0.4 mm, 30 pixels on the sphere's radius.
  const double radius = 0.3, steps = 0.1 / 255;
  const HeightField dish = fieldOf(Interpolation::monotone, 201, 201, [&](double x, double y) {
    return std::floor(((x - 1) * (x - 1) + y * y) / 20 / steps + 0.5) * steps;
  });
  const SearchedHeightField searched(Exec{}, dish, radius);
  int several = 0;
  for (int k = 0; k < 200; ++k) {
    Vec3d p{random(k, 0, 0.3, 1.7), random(k, 1, -0.7, 0.7), 0};
    double low = 0, high = 1;
    const double overlap = 1e-2 * radius;
    for (int b = 0; b < 40; ++b) {
      p.z = 0.5 * (low + high);
      FootPoint foot;
      (deepestFoot(searched.view(), p, radius, foot) && radius - foot.distance > overlap ? low : high) = p.z;
    }
    Feet feet;
    FeetSearch(searched.view(), p, radius).run(feet);
    const FeetLoads loads(feet, radius, false);
    double up = 0;
    for (int f = 0; f < feet.count; ++f) up += loads.overlap(f) * feet.foot[f].normal.z;
    several += feet.count > 1;
    EXPECT_GT(up, 0.97 * overlap) << feet.count << " feet";
    EXPECT_LT(up, 1.05 * overlap) << feet.count << " feet"; // the steps' edges are apart by their kink
  }
  EXPECT_GT(several, 50);
}

TEST_P(OnEveryGround, SphereInACone_TouchesAllAround) {
  // A ring with more minima than slots.
  const double radius = 0.15;
  const HeightField cone = fieldOf(GetParam(), 201, 201, [](double x, double y) { return std::hypot(x - 1, y); });
  for (const double overlap : {1e-3, 1e-2}) {
    const Feet feet = feetOf(cone, {1, 0, radius * std::sqrt(2.0) - overlap}, radius);
    EXPECT_GE(feet.count, 4);
    const FeetLoads loads(feet, radius, false);
    Vec3d sum;
    for (int k = 0; k < feet.count; ++k) sum += feet.foot[k].normal * loads.overlap(k);
    EXPECT_LT(std::hypot(sum.x, sum.y), 0.25 * sum.z) << overlap;
  }
}

TEST(FeetPlaces, GoToTheFootWhoseNormalIsNearest) {
  Feet feet;
  feet.count = 3;
  feet.foot[0].normal = base::normalized(Vec3d{0.7, 0, 0.7}),
  feet.foot[1].normal = base::normalized(Vec3d{-0.7, 0, 0.7});
  feet.foot[2].normal = base::normalized(Vec3d{0, 0.9, 0.4});
  float normals[24] = {};
  const Vec3d before = base::normalized(Vec3d{-0.69, 0.01, 0.7});
  normals[6] = float(before.x), normals[7] = float(before.y), normals[8] = float(before.z);
  int place[Feet::kMax];
  EXPECT_EQ(takePlaces(feet, 1u << 2, normals, place), 1u << 2);
  EXPECT_EQ(place[1], 2);
  EXPECT_EQ(place[0], 0);
  EXPECT_EQ(place[2], 1);
  EXPECT_EQ(takePlaces(feet, 7, nullptr, place), 0u);
  EXPECT_EQ(place[2], 2);
}

} // namespace
