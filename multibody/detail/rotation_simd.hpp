// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "multibody/detail/lanes.hpp"
#include "multibody/detail/rotation.hpp"

namespace grouser::multibody::detail {

/// Rotations of four bodies at a time, by the formulas of rotation.hpp for small angles; lanes with larger angles call
/// the functions of rotation.hpp.

struct QuatL {
  Lanes w, x, y, z;
};

GROUSER_SIMD QuatL rotationBy(const Vec3L& angle) {
  const Lanes s = 0.25 * norm2(angle);
  const Lanes c = 1.0 + s * (-1.0 / 2 + s * (1.0 / 24 + s * (-1.0 / 720 + s * (1.0 / 40320 + s * (-1.0 / 3628800)))));
  const Lanes f =
      0.5 * (1.0 + s * (-1.0 / 6 + s * (1.0 / 120 + s * (-1.0 / 5040 + s * (1.0 / 362880 + s * (-1.0 / 39916800))))));
  QuatL q{c, f * angle.x, f * angle.y, f * angle.z};
  const LaneMask large = s >= 0.0625;
  if (__builtin_expect(base::any(large), 0))
    for (int l = 0; l < kLanes; ++l)
      if (large[l]) {
        const Quat one = rotationBy(Vec3d{angle.x[l], angle.y[l], angle.z[l]});
        q.w[l] = one.w, q.x[l] = one.x, q.y[l] = one.y, q.z[l] = one.z;
      }
  return q;
}

/// Quaternion product a b, normalised.
GROUSER_SIMD QuatL turned(const QuatL& a, const QuatL& b) {
  const QuatL q{a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z, a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
                a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x, a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w};
  const Lanes s = 1.0 / squareRoot(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
  return {q.w * s, q.x * s, q.y * s, q.z * s};
}

GROUSER_SIMD Mat3L matrixOf(const QuatL& q) {
  const auto& [w, x, y, z] = q;
  return {{{1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)},
           {2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)},
           {2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)}}};
}

/// R I R^T of a symmetric I; both by columns of the lower triangle: 00 10 20 11 21 22.
GROUSER_SIMD void rotatedInertia(const Mat3L& R, const Lanes (&I)[6], Lanes (&W)[6]) {
  Vec3L row[3], turnedRow[3];
#pragma GCC unroll 3
  for (int i = 0; i < 3; ++i) {
    row[i] = {R.m[i][0], R.m[i][1], R.m[i][2]};
    turnedRow[i] = {I[0] * row[i].x + I[1] * row[i].y + I[2] * row[i].z,
                    I[1] * row[i].x + I[3] * row[i].y + I[4] * row[i].z,
                    I[2] * row[i].x + I[4] * row[i].y + I[5] * row[i].z};
  }
  W[0] = dot(turnedRow[0], row[0]), W[1] = dot(turnedRow[1], row[0]), W[2] = dot(turnedRow[2], row[0]);
  W[3] = dot(turnedRow[1], row[1]), W[4] = dot(turnedRow[2], row[1]), W[5] = dot(turnedRow[2], row[2]);
}

GROUSER_SIMD Vec3L timesInertia(const Lanes (&I)[6], const Vec3L& v) {
  return {I[0] * v.x + I[1] * v.y + I[2] * v.z, I[1] * v.x + I[3] * v.y + I[4] * v.z,
          I[2] * v.x + I[4] * v.y + I[5] * v.z};
}

GROUSER_SIMD Vec3L gyroscopicMomentum(const Lanes (&I)[6], const Vec3L& w, double dt) {
  const Vec3L theta = w * all(dt), first = cross(theta, timesInertia(I, w));
  const Lanes s = 0.25 * norm2(theta);
  Lanes beta = 0.25 * (1.0 / 3 + s * (1.0 / 45 + s * (2.0 / 945 + s * (1.0 / 4725 + s * (2.0 / 93555)))));
  const LaneMask large = s >= 0.01;
  if (__builtin_expect(base::any(large), 0))
    for (int l = 0; l < kLanes; ++l)
      if (large[l]) beta[l] = inverseTangentFactor(s[l]);
  return first * all(0.5) + cross(theta, first) * beta;
}

/// Angle from its sine and cosine, by the series of the arc sine for small angles (axisPositionAfter()).
GROUSER_SIMD Lanes angleIncrement(const Lanes& sine, const Lanes& cosine) {
  const Lanes q = sine * sine;
  Lanes angle = sine * (1.0 + q * (1.0 / 6 + q * (3.0 / 40 + q * (15.0 / 336 + q * (105.0 / 3456)))));
  const LaneMask large = (q >= 4e-4) | (cosine <= 0.0);
  if (__builtin_expect(base::any(large), 0))
    for (int l = 0; l < kLanes; ++l)
      if (large[l]) angle[l] = base::atan2(sine[l], cosine[l]);
  return angle;
}

} // namespace grouser::multibody::detail
