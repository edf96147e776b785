// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/math.hpp"
#include "base/vec.hpp"
#include "multibody/spatial.hpp"

#include <cmath>

namespace grouser::multibody::detail {

using base::Mat3d;
using base::Quat;
using base::Vec3d;
using multibody::rotatedInertia; // besides the version for lanes

/// Quaternion of the rotation by the vector `angle` [rad]: (cos h, sin(h)/h angle/2), h = |angle|/2.
inline Quat rotationBy(const Vec3d& angle) {
  const double s = 0.25 * norm2(angle); // h^2
  double c, f;
  if (s < 0.0625) {
    // Taylor series in h^2; the first omitted terms are below h^12 / 12! = 1.3e-16 and h^12 / 13! = 1e-17 for h < 1/4.
    c = 1 + s * (-1.0 / 2 + s * (1.0 / 24 + s * (-1.0 / 720 + s * (1.0 / 40320 + s * (-1.0 / 3628800)))));
    f = 1 + s * (-1.0 / 6 + s * (1.0 / 120 + s * (-1.0 / 5040 + s * (1.0 / 362880 + s * (-1.0 / 39916800)))));
  } else {
    const double h = sqrt(s);
    c = base::cos(h);
    f = base::sin(h) / h;
  }
  f *= 0.5;
  return {c, f * angle.x, f * angle.y, f * angle.z};
}

/// beta(s) = (1 - h cot h) / (4 h^2) with s = h^2, h = |theta| / 2: the factor of the second-order term in the inverse
/// derivative of exp on the rotation group, Y(theta) = 1 - theta x / 2 + beta theta x theta x.
inline double inverseTangentFactor(double s) {
  if (s < 0.01) {
    // (1 - h cot h) / h^2 = 1/3 + h^2/45 + 2 h^4/945 + h^6/4725 + 2 h^8/93555 + ...
    return 0.25 * (1.0 / 3 + s * (1.0 / 45 + s * (2.0 / 945 + s * (1.0 / 4725 + s * (2.0 / 93555)))));
  }
  const double h = sqrt(s);
  return 0.25 * (1 - h * base::cos(h) / base::sin(h)) / s;
}

/// Unit quaternion of the rotation matrix with columns x, y, z; divides by the largest of its four components.
inline Quat quaternionOf(const Vec3d& x, const Vec3d& y, const Vec3d& z) {
  const double tw = 1 + x.x + y.y + z.z, tx = 1 + x.x - y.y - z.z, ty = 1 - x.x + y.y - z.z, tz = 1 - x.x - y.y + z.z;
  Quat q;
  if (tw >= tx && tw >= ty && tw >= tz)
    q = {tw, y.z - z.y, z.x - x.z, x.y - y.x};
  else if (tx >= ty && tx >= tz)
    q = {y.z - z.y, tx, y.x + x.y, z.x + x.z};
  else if (ty >= tz)
    q = {z.x - x.z, y.x + x.y, ty, z.y + y.z};
  else
    q = {x.y - y.x, z.x + x.z, z.y + y.z, tz};
  return q.normalized();
}

/// Rotation vector phi of a unit quaternion, |phi| <= pi: the inverse of rotationBy.
inline Vec3d rotationVector(const Quat& given) {
  const double sign = given.w < 0 ? -1 : 1;
  const double w = sign * given.w;
  const Vec3d v{sign * given.x, sign * given.y, sign * given.z};
  const double q = norm2(v), r2 = q / (w * w);
  // |phi| / |v| = 2 atan(r) / (r w), r = |v| / w; the first omitted term of the series is below 1e-18.
  if (w > 0.5 && r2 < 4e-4)
    return (2 / w * (1 + r2 * (-1.0 / 3 + r2 * (1.0 / 5 + r2 * (-1.0 / 7 + r2 * (1.0 / 9)))))) * v;
  const double n = sqrt(q);
  return (2 * base::atan2(n, w) / n) * v;
}

/// Gyroscopic part g of the discrete angular momentum S(w) = I w + g at the start of a step.
///
/// The body rotates by exp(theta), theta = dt w, with constant w. The discrete Legendre transform of the Lagrangian
/// dt/2 w.I w on the rotation group (Bou-Rabee and Marsden 2009, Found. Comput. Math. 9:197, with exp as the map) is
///   S = I w + 1/2 theta x I w + beta theta x (theta x I w),   beta = (1 - h cot h) / (4 h^2),   h = |theta|/2.
/// At the end of the step, after I has rotated, S is the same world vector. Therefore the update S_new = S_old + dt
/// torque conserves angular momentum to round-off, is symplectic, and the energy of a fast top is bounded for any step
/// size.
inline Vec3d gyroscopicMomentum(const Mat3d& I_W, const Vec3d& w, double dt) {
  const Vec3d theta = dt * w, y = I_W * w;
  const Vec3d first = cross(theta, y);
  if (first == Vec3d{}) return {};
  const double beta = inverseTangentFactor(0.25 * norm2(theta));
  return 0.5 * first + beta * cross(theta, first);
}

/// Spread of the principal moments: tr(I) tr(I^-1) / 9, 1 for a sphere.
inline double spreadOf(const Mat3d& I) {
  const auto minor = [&](int i, int j) { return I.m[i][i] * I.m[j][j] - I.m[i][j] * I.m[j][i]; };
  const double xx = minor(1, 2), yy = minor(0, 2), zz = minor(0, 1);
  const double determinant = I.m[0][0] * xx - I.m[0][1] * (I.m[1][0] * I.m[2][2] - I.m[1][2] * I.m[2][0]) +
                             I.m[0][2] * (I.m[1][0] * I.m[2][1] - I.m[1][1] * I.m[2][0]);
  return (I.m[0][0] + I.m[1][1] + I.m[2][2]) * (xx + yy + zz) / (9 * determinant);
}

/// Solves S = I w + gyroscopicMomentum(I, w, dt) for w near `guess`, by Newton's method with the derivative at constant
/// beta:
///   dS/dw = I + dt/2 ([w] I - [I w]) + beta dt^2 (w.y + w y^T + w (I w)^T - |w|^2 I - 2 y w^T),   y = I w,
/// where each step is halved until the residual decreases. If the moments differ by orders of magnitude, a fixed-point
/// iteration with I only diverges even for slow motion.
inline Vec3d angularVelocityOf(const Mat3d& I, const Vec3d& S, const Vec3d& guess, double dt) {
  Vec3d w = guess;
  const auto residual = [&](const Vec3d& v) { return S - (I * v + gyroscopicMomentum(I, v, dt)); };
  Vec3d r = residual(w);
  // Converge to round-off: about 6e-16 of S.
  for (int iteration = 0; iteration < 30 && norm2(r) > 4e-31 * norm2(S); ++iteration) {
    const Vec3d y = I * w;
    const double beta = inverseTangentFactor(0.25 * dt * dt * norm2(w)), q = beta * dt * dt;
    const Mat3d cross_wI = skew(w) * I, cross_y = skew(y);
    Mat3d A;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        A.m[i][j] = I.m[i][j] + 0.5 * dt * (cross_wI.m[i][j] - cross_y.m[i][j]) +
                    q * ((i == j ? dot(w, y) : 0) + 2 * w[i] * y[j] - norm2(w) * I.m[i][j] - 2 * y[i] * w[j]);
    // Cramer's rule.
    const Vec3d a{A.m[0][0], A.m[1][0], A.m[2][0]}, b{A.m[0][1], A.m[1][1], A.m[2][1]},
        c{A.m[0][2], A.m[1][2], A.m[2][2]};
    const double determinant = dot(a, cross(b, c));
    if (!(std::fabs(determinant) > 0)) return w;
    const Vec3d step = (1 / determinant) * Vec3d{dot(r, cross(b, c)), dot(a, cross(r, c)), dot(a, cross(b, r))};
    double part = 1;
    Vec3d next = residual(w + step);
    if (norm2(r) < 1e-28 * norm2(S) && !(norm2(next) < norm2(r))) return w;
    while (!(norm2(next) < norm2(r)) && part > 1e-3) {
      part *= 0.5;
      next = residual(w + part * step);
    }
    if (!(norm2(next) < norm2(r))) return w;
    w += part * step;
    r = next;
  }
  return w;
}

} // namespace grouser::multibody::detail
