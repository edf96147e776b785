// SPDX-License-Identifier: BSD-3-Clause
// Series of rotations on both sides of the switch to closed forms, against the C library's functions in
// extended precision.
#include "multibody/detail/rotation.hpp"
#include "multibody/detail/rotation_simd.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace grouser::multibody::detail {
namespace {

constexpr double kEps = std::numeric_limits<double>::epsilon();
const Vec3d kAxis{2.0 / 7, -3.0 / 7, 6.0 / 7};

/// Just below, at and just above `at`, and farther on both sides.
std::vector<double> around(double at) {
  return {0.1 * at,        0.5 * at, at * (1 - 1e-9), std::nextafter(at, 0), at, std::nextafter(at, 1e9),
          at * (1 + 1e-9), 2 * at};
}

TEST(RotationSeries, QuaternionOfAVectorIsTheClosedFormAcrossTheSwitch) {
  // Angles to h = |angle| / 2 of 1/4, and tiny ones.
  std::vector<double> angles = around(0.5);
  angles.insert(angles.end(), {0, 1e-300, 1e-20, 1e-8, 1e-3, 0.1, 1.5, 3, 6});
  for (const double angle : angles) {
    const Quat q = rotationBy(kAxis * angle);
    const long double h = 0.5L * angle;
    // The closed forms of base/math.hpp are accurate to some units in the last place of 1.
    EXPECT_NEAR(q.w, static_cast<double>(std::cos(h)), 2 * kEps) << angle;
    for (int a = 0; a < 3; ++a) {
      const double part = (&q.x)[a], wanted = static_cast<double>(std::sin(h)) * kAxis[a];
      EXPECT_NEAR(part, wanted, 4 * kEps * std::fabs(angle < 2 ? wanted : kAxis[a])) << angle;
    }
  }
}

TEST(RotationSeries, RotationVectorIsTheInverseAcrossItsSwitches) {
  // From the series: r^2 = tan^2(angle / 2) = 4e-4; then w = 1/2; then half a turn.
  std::vector<double> angles = around(2 * std::atan(0.02));
  for (const double more : around(2 * std::acos(0.5))) angles.push_back(std::min(more, 3.1415));
  angles.insert(angles.end(), {0, 1e-300, 1e-12, 1e-5, 0.3, 1, 3.14159});
  for (const double angle : angles) {
    const long double h = 0.5L * angle;
    Quat q{static_cast<double>(std::cos(h)), static_cast<double>(std::sin(h)) * kAxis.x,
           static_cast<double>(std::sin(h)) * kAxis.y, static_cast<double>(std::sin(h)) * kAxis.z};
    for (const double sign : {1.0, -1.0}) { // q and -q are one rotation
      const Vec3d phi = rotationVector({sign * q.w, sign * q.x, sign * q.y, sign * q.z});
      for (int a = 0; a < 3; ++a)
        EXPECT_NEAR(phi[a], angle * kAxis[a], 8 * kEps * std::fabs(angle)) << angle << " " << sign;
    }
  }
  const Vec3d back = rotationVector({-0.8, 0.6, 0, 0});
  EXPECT_NEAR(back.x, -2 * std::acos(0.8), 4 * kEps) << "the short way round";
}

TEST(RotationSeries, FactorOfTheInverseTangentMapIsTheClosedFormAcrossItsSwitch) {
  std::vector<double> squares = around(0.01);
  squares.insert(squares.end(), {0, 1e-300, 1e-16, 1e-6, 1e-3, 0.1, 0.5, 1, 2});
  for (const double s : squares) {
    const long double h = std::sqrt(static_cast<long double>(s));
    // (1 - h cot h) / (4 h^2); for small h its first terms, since even long double loses digits there.
    const long double wanted = s < 1e-3 ? (1.0L / 3 + s * (1.0L / 45 + s * (2.0L / 945 + s / 4725.0L))) / 4
                                        : (1 - h * std::cos(h) / std::sin(h)) / (4 * static_cast<long double>(s));
    // The closed form subtracts: 1 - h cot h is h^2 / 3, so that it loses a factor of 3 / h^2 of its digits.
    const double tolerance = s < 0.01 ? 4 * kEps : 16 * kEps / s;
    EXPECT_NEAR(inverseTangentFactor(s) / static_cast<double>(wanted), 1, tolerance) << s;
  }
}

TEST(RotationSeries, OfFourBodiesIsThatOfEachAlone) {
  for (const double at : around(0.5)) {
    Vec3L angle{};
    const double sizes[] = {at, 0.3 * at, 1.7 * at, 0};
    for (int l = 0; l < kLanes; ++l) {
      const Vec3d v = kAxis * sizes[l % 4];
      angle.x[l] = v.x, angle.y[l] = v.y, angle.z[l] = v.z;
    }
    const QuatL q = rotationBy(angle);
    for (int l = 0; l < kLanes; ++l) {
      const Quat one = rotationBy(kAxis * sizes[l % 4]);
      EXPECT_NEAR(q.w[l], one.w, kEps);
      EXPECT_NEAR(q.x[l], one.x, kEps);
      EXPECT_NEAR(q.y[l], one.y, kEps);
      EXPECT_NEAR(q.z[l], one.z, kEps);
    }
  }
}

TEST(RotationSeries, AngleOfASineAndCosineIsThatOfTheArcTangent) {
  for (const double angle : {0.0, 1e-9, 1e-3, 0.0199, 0.02, 0.0201, 0.3, 2.0, 3.1, -0.0199, -0.0201, -1.0}) {
    const Lanes sine = all(std::sin(angle)), cosine = all(std::cos(angle));
    EXPECT_NEAR(angleIncrement(sine, cosine)[0], angle, 4 * kEps * std::max(1e-3, std::fabs(angle))) << angle;
  }
}

TEST(RotationSeries, QuaternionOfAMatrixIsRightInEachOfItsFourCases) {
  for (const Vec3d& phi : {Vec3d{0.1, 0.2, -0.3}, {3, 0.2, 0.1}, {0.1, -3, 0.2}, {0.2, 0.1, 3}, {-1.8, 1.7, 1.6}}) {
    const Quat q = rotationBy(phi);
    const Mat3d R = q.matrix();
    const Quat is = quaternionOf({R.m[0][0], R.m[1][0], R.m[2][0]}, {R.m[0][1], R.m[1][1], R.m[2][1]},
                                 {R.m[0][2], R.m[1][2], R.m[2][2]});
    const double sign = is.w * q.w + is.x * q.x + is.y * q.y + is.z * q.z;
    EXPECT_NEAR(std::fabs(sign), 1, 4 * kEps) << phi.x;
    const Vec3d columns = rotate(is, {1, 2, 3}) - R * Vec3d{1, 2, 3};
    EXPECT_NEAR(norm(columns), 0, 16 * kEps);
  }
}

TEST(RotationSeries, ATurnIsTheSameOnBothSidesOfTheSwitch) {
  // One rotation of h = 1/4 by the series, and two of half of it: exp is a homomorphism on one axis.
  const Quat half = rotationBy(kAxis * 0.25), whole = rotationBy(kAxis * 0.5), twice = half * half;
  EXPECT_NEAR(whole.w, twice.w, 2 * kEps);
  EXPECT_NEAR(whole.y, twice.y, 2 * kEps);
}

} // namespace
} // namespace grouser::multibody::detail
