// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/math.hpp"
#include "base/vec.hpp"

namespace grouser::multibody::detail {

using base::Mat3d;
using base::Quat;
using base::Vec3d;

/// Quaternion of the rotation by the vector `angle` [rad]: (cos h, sin(h)/h angle/2), h = |angle|/2.
inline Quat rotationBy(const Vec3d& angle) {
  const double s = 0.25 * norm2(angle); // h^2
  double c, f;
  if (s < 0.0625) {
    // Taylor series in h^2; the first terms left out are below 1e-17 for h < 1/4.
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

/// R I R^T: the inertia about the centre of mass in world axes.
inline Mat3d rotatedInertia(const Mat3d& R, const Mat3d& I) {
  const Mat3d RI = R * I;
  Mat3d W;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j <= i; ++j) {
      W.m[i][j] = RI.m[i][0] * R.m[j][0] + RI.m[i][1] * R.m[j][1] + RI.m[i][2] * R.m[j][2];
      W.m[j][i] = W.m[i][j];
    }
  return W;
}

/// Gyroscopic part g of the discrete angular momentum S(w) = I w + g at the node where a step starts.
///
/// The body turns by exp(theta), theta = dt w, with constant w. The discrete Legendre transform of the Lagrangian
/// dt/2 w.I w on the rotation group (Bou-Rabee and Marsden 2009, Found. Comput. Math. 9:197, with exp as the map) gives
///   S = I w + 1/2 theta x I w + beta theta x (theta x I w),   beta = (1 - h cot h) / (4 h^2),   h = |theta|/2.
/// S is the same world vector at the end of the step, where I has turned along; so the update S_new = S_old + dt torque
/// conserves angular momentum to the last digits, is symplectic, and the energy of a fast top stays bounded at any
/// step.
inline Vec3d gyroscopicMomentum(const Mat3d& I_W, const Vec3d& w, double dt) {
  const Vec3d theta = dt * w, y = I_W * w;
  const Vec3d first = cross(theta, y);
  if (first == Vec3d{}) return {};
  const double s = 0.25 * norm2(theta);
  double beta;
  if (s < 0.01) {
    // (1 - h cot h) / h^2 = 1/3 + h^2/45 + 2 h^4/945 + h^6/4725 + 2 h^8/93555 + ...
    beta = 0.25 * (1.0 / 3 + s * (1.0 / 45 + s * (2.0 / 945 + s * (1.0 / 4725 + s * (2.0 / 93555)))));
  } else {
    const double h = sqrt(s);
    beta = 0.25 * (1 - h * base::cos(h) / base::sin(h)) / s;
  }
  return 0.5 * first + beta * cross(theta, first);
}

} // namespace grouser::multibody::detail
