// SPDX-License-Identifier: BSD-3-Clause
#include "terrain/height_field.hpp"

#include "base/error.hpp"
#include "base/math.hpp"
#include "base/random.hpp"
#include "tests/rounding.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>

namespace {

using namespace grouser::terrain;
using grouser::base::norm;
using grouser::base::uniform;
namespace base = grouser::base;

using grouser::test::kEps;
constexpr std::uint64_t kFieldTest = base::purpose("terrain.height-field-test");
constexpr Rectangle kFieldArea{0, 4, -1, 1};

double randomIn(int i, int k, double from, double to) { return from + (to - from) * uniform(5, kFieldTest, i, k); }

/// Waves of 1 m and 0.8 m, 3 cm high: smallest radius of curvature of the hollows about 0.3 m.
double waves(double x, double y) {
  return 0.03 * base::sin(2 * base::kPi * x) * base::cos(2 * base::kPi * y / 0.8) + 0.05 * x;
}
HeightField waveField(int n) { return HeightField::sample(kFieldArea, 2 * n + 1, n + 1, waves); }

/// Ground at the roughness limit of pictures: independent heights, slopes of about 10.
HeightField noiseField() {
  int i = 0;
  return HeightField::sample(kFieldArea, 41, 21, [&](double, double) { return randomIn(i++, 9, 0, 1); });
}

TEST(HeightField, Plane_HasExactHeightSlopeAndDistance) {
  const HeightField plane = HeightField::plane(kFieldArea, 0.3, 0.25, -0.125);
  const Vec3d n = base::normalized(Vec3d{-0.25, 0.125, 1.0});
  for (int i = 0; i < 200; ++i) {
    // Inside and up to twice the size outside.
    const Vec3d p{randomIn(i, 0, -8, 12), randomIn(i, 1, -4, 4), randomIn(i, 2, -2, 2)};
    const double h = 0.3 + 0.25 * p.x - 0.125 * p.y;
    const SurfaceJet jet = plane.view().jet(p.x, p.y);
    const FootPoint foot = plane.closestPoint(p);
    // Round-off: some ten operations on numbers up to 4 (heights) and 12 (coordinates).
    EXPECT_NEAR(jet.h, h, 10 * kEps * 4);
    EXPECT_NEAR(jet.hx, 0.25, 10 * kEps * 4);
    EXPECT_NEAR(jet.hy, -0.125, 10 * kEps * 4);
    EXPECT_NEAR(foot.distance, (p.z - h) * n.z, 10 * kEps * 12);
    EXPECT_NEAR(norm(foot.normal - n), 0, 10 * kEps * 4);
  }
  EXPECT_NEAR(plane.bounds().slope, std::sqrt(0.25 * 0.25 + 0.125 * 0.125), 10 * kEps);
  EXPECT_NEAR(plane.bounds().valleyCurvature, 0, 10 * kEps);
}

TEST(HeightField, FinePlane_IsAsExactAsACoarseOne) {
  const HeightField plane = HeightField::sample(kFieldArea, 201, 101, [](double x, double y) { return 0.5 * x + y; });
  const double spacing = 0.02;
  for (int i = 0; i < 200; ++i) {
    const double x = randomIn(i, 0, -1, 5), y = randomIn(i, 1, -2, 2);
    const SurfaceJet jet = plane.view().jet(x, y);
    // Round-off of the heights (up to 3 m), over the spacing for a slope, times the cells it is carried on outside.
    const double outX = std::max({0.0, -x, x - 4}) / spacing, outY = std::max(0.0, std::fabs(y) - 1) / spacing;
    const double round = 10 * kEps * 3 * (1 + outX) * (1 + outY);
    EXPECT_NEAR(jet.h, 0.5 * x + y, round);
    EXPECT_NEAR(jet.hx, 0.5, 10 * kEps * 3 * (1 + outY) / spacing);
    EXPECT_NEAR(jet.hy, 1.0, 10 * kEps * 3 * (1 + outX) / spacing);
  }
}

TEST(HeightField, PassesThroughItsNodes) {
  const HeightField field = noiseField();
  for (int j = 0; j < field.rows(); ++j)
    for (int i = 0; i < field.columns(); ++i) {
      const double x = kFieldArea.xMin + 4.0 * i / 40, y = kFieldArea.yMin + 2.0 * j / 20;
      // The node's coordinate is off by round-off; the slope is at most bounds().slope.
      EXPECT_NEAR(field.height(x, y), field.heights()[j * 41 + i], (2 + field.bounds().slope) * 4 * kEps * 4);
    }
}

TEST(HeightField, SlopeIsContinuousAcrossCellsAndTheBorder) {
  const HeightField field = noiseField();
  const HeightFieldView view = field.view();
  const double step = 1e-9, curvature = 1e4; // |second derivatives| of this noise are below 1e4 / m
  for (int i = 0; i <= 40; ++i)
    for (int s = 0; s < 20; ++s) {
      const double x = 0.1 * i, y = randomIn(s, i, -1.2, 1.2);
      const SurfaceJet a = view.jet(x - step, y), b = view.jet(x + step, y);
      EXPECT_NEAR(a.h, b.h, 2 * step * 100);
      EXPECT_NEAR(a.hx, b.hx, 2 * step * curvature);
      EXPECT_NEAR(a.hy, b.hy, 2 * step * curvature);
    }
}

/// Compares derivatives with differences of heights and slopes.
void expectDerivativesOfTheHeight(const HeightFieldView& view) {
  for (int i = 0; i < 300; ++i) {
    // Away from the cells' sides, where the second derivative jumps.
    const double x = 0.1 * (i % 40) + randomIn(i, 0, 0.01, 0.09), y = -1 + 0.1 * (i % 20) + randomIn(i, 1, 0.01, 0.09);
    const double d = 1e-5; // truncation d^2 h''' / 6 with h''' < 1e5, round-off eps / d
    const SurfaceJet s = view.jet(x, y), e = view.jet(x + d, y), w = view.jet(x - d, y), n = view.jet(x, y + d),
                     b = view.jet(x, y - d);
    EXPECT_NEAR(s.hx, (e.h - w.h) / (2 * d), 1e5 * d * d);
    EXPECT_NEAR(s.hy, (n.h - b.h) / (2 * d), 1e5 * d * d);
    EXPECT_NEAR(s.hxx, (e.hx - w.hx) / (2 * d), 1e6 * d * d);
    EXPECT_NEAR(s.hyy, (n.hy - b.hy) / (2 * d), 1e6 * d * d);
    EXPECT_NEAR(s.hxy, (n.hx - b.hx) / (2 * d), 1e6 * d * d);
    EXPECT_EQ(view.height(x, y), s.h);
  }
}

TEST(HeightField, DerivativesAreThoseOfTheHeight) {
  const HeightField field = noiseField();
  expectDerivativesOfTheHeight(field.view());
}

TEST(HeightField, ConvergesToASmoothSurfaceWithThirdOrder) {
  const auto error = [](int n) {
    const HeightField field = waveField(n);
    double worst = 0;
    // Away from the border, where the linear continuation costs one order.
    for (int i = 0; i < 2000; ++i) {
      const double x = randomIn(i, 0, 0.5, 3.5), y = randomIn(i, 1, -0.6, 0.6);
      worst = std::max(worst, std::fabs(field.height(x, y) - waves(x, y)));
    }
    return worst;
  };
  const double order = base::log(error(40) / error(160)) / base::log(4);
  EXPECT_GT(order, 2.8); // cubic Hermite with slopes of second order: third order
  EXPECT_LT(error(40), 0.03 * 1e-2);
}

TEST(ClosestPoint, AlongANormal_GivesBackFootDistanceAndNormal) {
  const HeightField field = waveField(40);
  const HeightFieldView view = field.view();
  const double hollow = 1 / field.bounds().valleyCurvature;
  ASSERT_GT(hollow, 0.2);
  for (int i = 0; i < 1000; ++i) {
    const double x = randomIn(i, 0, 0.2, 3.8), y = randomIn(i, 1, -0.8, 0.8);
    const double d = randomIn(i, 2, -0.5, 0.5) * hollow; // within half the radius of curvature, either side
    const SurfaceJet s = view.jet(x, y);
    const Vec3d n = base::normalized(Vec3d{-s.hx, -s.hy, 1.0});
    const FootPoint foot = view.closestPoint(Vec3d{x, y, s.h} + d * n);
    // The last step is below 1e-6 of a spacing (0.05 m), and the error after it of second order: 1e-12 times a third
    // derivative that the jumps between cells make large.
    EXPECT_NEAR(norm(foot.point - Vec3d{x, y, s.h}), 0, 1e-9 * 0.05) << i;
    EXPECT_NEAR(foot.distance, d, 100 * kEps)
        << i; // second order in the foot's error: round-off of coordinates up to 4 m
    EXPECT_NEAR(norm(foot.normal - n), 0, 1e-9) << i; // foot's error times curvature below 10 / m
  }
}

TEST(ClosestPoint, OfWaves_IsTheGlobalMinimumOfADenseSearch) {
  const HeightField field = waveField(40);
  const HeightFieldView view = field.view();
  for (int i = 0; i < 40; ++i) {
    const Vec3d p{randomIn(i, 0, 0.5, 3.5), randomIn(i, 1, -0.5, 0.5), randomIn(i, 2, 0.0, 0.3)};
    double x = p.x, y = p.y, best = 1e9;
    // Nested grids of 41 x 41 points, each a tenth of the one before: final spacing 0.2 m / 20 / 1e5 = 1e-7 m.
    double reach = 0.3;
    for (int level = 0; level < 6; ++level, reach *= 0.1) {
      const double cx = x, cy = y;
      for (int b = -20; b <= 20; ++b)
        for (int a = -20; a <= 20; ++a) {
          const double tx = cx + a * reach / 20, ty = cy + b * reach / 20;
          const double d = norm(Vec3d{tx, ty, view.height(tx, ty)} - p);
          if (d < best) best = d, x = tx, y = ty;
        }
    }
    const FootPoint foot = view.closestPoint(p);
    EXPECT_EQ(foot.distance > 0, p.z > view.height(p.x, p.y));
    // The search's spacing squared over twice a distance of at least 1e-3 m, or its spacing if nearer.
    EXPECT_NEAR(std::fabs(foot.distance), best, 1e-7) << i;
  }
}

TEST(ClosestPoint, SphereInAParabolicHollow_HasTheAnalyticOverlap) {
  // h = r^2 / (2 rho), rho = 0.5 m: quadratics are met exactly. On the axis the vertex is the foot up to z = rho.
  const double rho = 0.5;
  const HeightField bowl =
      HeightField::sample({-1, 1, -1, 1}, 41, 41, [=](double x, double y) { return (x * x + y * y) / (2 * rho); });
  const double radius = 0.03;
  const FootPoint foot = bowl.closestPoint({0, 0, radius - 1e-4});
  EXPECT_NEAR(radius - foot.distance, 1e-4, 10 * kEps);
  // Off the axis by x the nearest point solves t^3 + 2 rho (rho - z) t - 2 rho^2 x = 0 (Cardano's case with one real
  // root).
  const double x = 0.2, z = 0.1;
  double t = x;
  for (int k = 0; k < 60; ++k)
    t -= (t * t * t + 2 * rho * (rho - z) * t - 2 * rho * rho * x) / (3 * t * t + 2 * rho * (rho - z));
  const FootPoint off = bowl.closestPoint({x, 0, z});
  EXPECT_NEAR(off.point.x, t, 1e-12);
  EXPECT_NEAR(off.distance, norm(Vec3d{x - t, 0, z - t * t / (2 * rho)}) * (z > x * x / (2 * rho) ? 1 : -1), 10 * kEps);
}

TEST(ClosestPoint, OnTheRoughestGround_IsFiniteAndNeverFartherThanThePointBelow) {
  const HeightField field = noiseField();
  const HeightFieldView view = field.view();
  for (int i = 0; i < 5000; ++i) {
    const Vec3d p{randomIn(i, 0, -0.5, 4.5), randomIn(i, 1, -1.5, 1.5), randomIn(i, 2, -1, 2)};
    const FootPoint foot = view.closestPoint(p);
    ASSERT_TRUE(std::isfinite(foot.distance));
    EXPECT_NEAR(norm(foot.normal), 1, 4 * kEps);
    const double above = p.z - view.height(p.x, p.y);
    EXPECT_EQ(foot.distance > 0, above > 0);
    EXPECT_LE(std::fabs(foot.distance), std::fabs(above) * (1 + 4 * kEps));
    // The last step, below 1e-6 of a spacing of 0.1 m, follows the tangent.
    EXPECT_NEAR(foot.point.z, view.height(foot.point.x, foot.point.y), field.bounds().valleyCurvature * 1e-14);
  }
}

TEST(ClearOf, IsNeverTrueForASphereThatTouches_AndMostlyTrueForOneThatDoesNot) {
  const HeightField field = waveField(40);
  const HeightFieldView view = field.view();
  const double radius = 0.03;
  int clear = 0, apart = 0;
  for (int i = 0; i < 5000; ++i) {
    const Vec3d p{randomIn(i, 0, -0.1, 4.1), randomIn(i, 1, -1.1, 1.1), randomIn(i, 2, -0.1, 0.5)};
    const double distance = view.closestPoint(p).distance;
    const bool inside = p.x > 0.03 && p.x < 3.97 && p.y > -0.97 && p.y < 0.97;
    EXPECT_FALSE(view.clearOf(p, radius) && distance <= radius) << i;
    clear += inside && view.clearOf(p, radius), apart += inside && distance > radius;
  }
  EXPECT_GT(clear, 0.9 * apart);
}

TEST(HeightFieldBounds, ContainTheSurface_AndAreOfItsSize) {
  const HeightField field = noiseField();
  const HeightFieldView view = field.view();
  const auto& bound = field.bounds();
  double lowest = 1e9, highest = -1e9, slope = 0, curvature = 0;
  for (int j = 0; j <= 400; ++j)
    for (int i = 0; i <= 800; ++i) {
      const SurfaceJet s = view.jet(0.005 * i, -1 + 0.005 * j);
      lowest = std::min(lowest, s.h), highest = std::max(highest, s.h);
      slope = std::max(slope, std::sqrt(s.hx * s.hx + s.hy * s.hy));
      const double mean = 0.5 * (s.hxx + s.hyy), half = 0.5 * (s.hxx - s.hyy);
      curvature = std::max(curvature, mean + std::sqrt(half * half + s.hxy * s.hxy));
    }
  EXPECT_LE(bound.lowest, lowest);
  EXPECT_GE(bound.highest, highest);
  EXPECT_GE(bound.slope, slope);
  EXPECT_GE(bound.valleyCurvature, curvature);
  // Overestimate of the bounds: up to a factor of 2.4 on noise, the worst case; on waves a few per cent (slope) and
  // 20 per cent (curvature).
  EXPECT_LT(bound.slope, 3 * slope);
  EXPECT_LT(bound.valleyCurvature, 3 * curvature);
  const double k = 2 * base::kPi, a = 0.03; // steepest slope a k / 0.8, along y; sharpest hollow a (k / 0.8)^2
  const auto waved = waveField(80).bounds();
  EXPECT_NEAR(waved.slope, a * k / 0.8, 0.05 * a * k / 0.8);
  EXPECT_NEAR(waved.valleyCurvature, a * k * k / 0.64, 0.2 * a * k * k / 0.64);
}

TEST(HeightFieldBounds, OfASaddle_CountTheTwist) {
  // h = x y / 2 is straight along x and y, and a hollow of curvature 1/2 along the diagonal.
  const HeightField saddle = HeightField::sample(kFieldArea, 21, 11, [](double x, double y) { return 0.5 * x * y; });
  EXPECT_NEAR(saddle.bounds().valleyCurvature, 0.5, 100 * kEps / (0.2 * 0.2));
}

TEST(HeightFieldBounds, OverAPart_AreThoseOfThatPart) {
  const HeightField field =
      HeightField::sample(kFieldArea, 41, 21, [](double x, double) { return x < 2.01 ? 0.0 : x - 2; });
  const auto level = field.boundsOver({0.1, 1.5, -0.5, 0.5}), all = field.boundsOver({-9, 9, -9, 9});
  EXPECT_EQ(level.slope, 0.0);
  EXPECT_EQ(level.highest, 0.0);
  EXPECT_EQ(all.slope, field.bounds().slope);
  EXPECT_NEAR(all.highest, 2.0, 10 * kEps);
}

TEST(HeightField, Raised_IsTheSameSurfaceHigher) {
  const HeightField field = waveField(20), higher = field.raised(0.25);
  for (int i = 0; i < 50; ++i) {
    const double x = randomIn(i, 0, 0, 4), y = randomIn(i, 1, -1, 1);
    EXPECT_NEAR(higher.height(x, y), field.height(x, y) + 0.25, 10 * kEps);
  }
}

TEST(HeightField, BrokenInput_IsAnError) {
  using grouser::base::InputError;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(HeightField(kFieldArea, 1, 2, {0, 0}), InputError);
  EXPECT_THROW(HeightField(kFieldArea, 2, 2, {0, 0, 0}), InputError);
  EXPECT_THROW(HeightField(kFieldArea, 2, 2, {0, 0, 0, nan}), InputError);
  EXPECT_THROW(HeightField({0, 0, 0, 1}, 2, 2, {0, 0, 0, 0}), InputError);
  EXPECT_THROW(HeightField({0, nan, 0, 1}, 2, 2, {0, 0, 0, 0}), InputError);
}

HeightField with(Interpolation how, const HeightField& nodes) {
  return {nodes.area(), nodes.columns(), nodes.rows(), nodes.heights(), how};
}

TEST(Interpolation, MonotoneAndBilinear_StayBetweenTheNodesOfEachCell) {
  for (const Interpolation how : {Interpolation::monotone, Interpolation::bilinear}) {
    const HeightField field = with(how, noiseField());
    for (int j = 0; j + 1 < field.rows(); ++j)
      for (int i = 0; i + 1 < field.columns(); ++i) {
        const double* h = &field.heights()[static_cast<std::size_t>(j) * 41 + i];
        const auto [low, high] = std::minmax({h[0], h[1], h[41], h[42]});
        EXPECT_GE(field.boundsOfCell(i, j).lowest, low - 8 * kEps);
        EXPECT_LE(field.boundsOfCell(i, j).highest, high + 8 * kEps);
        // Between the cell's borders, where round-off does not decide which cell it is.
        for (int k = 0; k < 25; ++k) {
          const double z = field.height(0.1 * (i + 0.1 + 0.2 * (k % 5)), -1 + 0.1 * (j + 0.1 + 0.2 * (k / 5)));
          EXPECT_GE(z, low - 8 * kEps);
          EXPECT_LE(z, high + 8 * kEps);
        }
      }
  }
}

TEST(Interpolation, StepBetweenTwoColumns_HasNoLipAndNoTrench) {
  // White next to black at 0.3 m; Catmull-Rom rises to 0.322 m and falls to -0.022 m there.
  const HeightField step =
      HeightField::sample({0, 2, -0.1, 0.1}, 21, 3, [](double x, double) { return x > 0.95 ? 0.3 : 0.0; });
  const HeightField monotone = with(Interpolation::monotone, step);
  double low = 1, high = -1, smoothHigh = -1;
  for (int k = 0; k <= 2000; ++k) {
    const double z = monotone.height(0.001 * k, 0.03);
    low = std::min(low, z), high = std::max(high, z), smoothHigh = std::max(smoothHigh, step.height(0.001 * k, 0.03));
  }
  EXPECT_GE(low, -kEps);
  EXPECT_NEAR(high, 0.3, 2 * kEps);
  EXPECT_NEAR(monotone.height(1.025, 0), 0.3, 2 * kEps);
  EXPECT_NEAR(smoothHigh, 0.3222, 1e-4);
}

TEST(Interpolation, MonotoneAndBilinear_HaveTheDerivativesOfTheirHeight) {
  for (const Interpolation how : {Interpolation::monotone, Interpolation::bilinear}) {
    const HeightField field = with(how, noiseField());
    expectDerivativesOfTheHeight(field.view());
  }
}

TEST(Interpolation, Monotone_HasContinuousNormalsAcrossCellsAndTheBorder) {
  const HeightField field = with(Interpolation::monotone, noiseField());
  const HeightFieldView view = field.view();
  const double step = 1e-9, curvature = 1e4; // |second derivatives| of this noise are below 1e4 / m
  for (int i = 0; i <= 40; ++i)
    for (int s = 0; s < 20; ++s) {
      const double x = 0.1 * i, y = randomIn(s, i, -1.2, 1.2);
      const SurfaceJet a = view.jet(x - step, y), b = view.jet(x + step, y);
      EXPECT_NEAR(a.h, b.h, 2 * step * 100);
      EXPECT_NEAR(a.hx, b.hx, 2 * step * curvature);
      EXPECT_NEAR(a.hy, b.hy, 2 * step * curvature);
    }
}

TEST(Interpolation, OfAPlane_IsTheFormerSurfaceBitForBit) {
  const HeightField flat = HeightField::sample(kFieldArea, 41, 21, [](double, double) { return 0.037; });
  const HeightField leaning =
      HeightField::sample(kFieldArea, 41, 21, [](double x, double y) { return 0.5 * x - 0.2 * y; });
  for (const HeightField* plane : {&flat, &leaning})
    for (const Interpolation how : {Interpolation::monotone, Interpolation::bilinear})
      for (int i = 0; i < 100; ++i) {
        const double x = randomIn(i, 0, -1, 5), y = randomIn(i, 1, -2, 2);
        EXPECT_EQ(with(how, *plane).height(x, y), plane->height(x, y));
      }
}

TEST(Interpolation, Monotone_ConvergesWithOrder2_4InTheMeanAnd1_6AtExtrema) {
  const auto errors = [](int n) {
    const HeightField field = with(Interpolation::monotone, waveField(n));
    double worst = 0, sum = 0;
    for (int i = 0; i < 4000; ++i) {
      const double x = randomIn(i, 0, 0.5, 3.5), y = randomIn(i, 1, -0.6, 0.6);
      const double error = std::fabs(field.height(x, y) - waves(x, y));
      worst = std::max(worst, error), sum += error / 4000;
    }
    return std::array<double, 2>{sum, worst};
  };
  const auto coarse = errors(40), fine = errors(160);
  EXPECT_GT(base::log(coarse[0] / fine[0]) / base::log(4), 2.4);
  EXPECT_GT(base::log(coarse[1] / fine[1]) / base::log(4), 1.6);
}

TEST(Interpolation, RaisedGround_KeepsIts) {
  const HeightField field = with(Interpolation::monotone, noiseField());
  EXPECT_NEAR(field.raised(-2).height(1.234, 0.321), field.height(1.234, 0.321) - 2, 8 * kEps);
}

} // namespace
