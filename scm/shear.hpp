// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/math.hpp"
#include "base/vec.hpp"

namespace grouser::scm {

/// Direction and mobilised fraction of the shear stress under a piece of a pad, tau = tau_m s, |s| <= 1, in the
/// plane of the pad. K ds = dj - s |dj| for a shear displacement dj: for straight motion this is Janosi's 1 - exp(-j /
/// K) (Janosi, Hanamoto 1961). After a turn or a reversal s follows with a delay, whereas a scalar path length would
/// rotate the stress instantly.
struct Shear {
  double x{}, y{}; ///< [-]

  double square() const { return x * x + y * y; }
};

/// Work and dissipation over a shear displacement at constant tau_m, divided by tau_m and area [m].
struct ShearWork {
  double work{}, loss{};
};

/// exp(-x), x >= 0; for small x by a Pade approximant with relative error x^5 / 720.
inline double decay(double x) {
  if (x > 0.02) return base::exp(-x);
  const double square = x * x * (1.0 / 12);
  return (1 - 0.5 * x + square) / (1 + 0.5 * x + square);
}

/// Advances s by a straight shear displacement (dx, dy) [m], exactly for any length: s' = d + (s - d) exp(-l / K), with
/// unit vector d and length l.
inline ShearWork advance(Shear& s, double dx, double dy, double K) {
  const double l = ::sqrt(dx * dx + dy * dy);
  if (!(l > 0)) return {};
  const double ux = dx / l, uy = dy / l, along = s.x * ux + s.y * uy, before = s.square();
  const double kept = decay(l / K);
  s.x = ux + (s.x - ux) * kept, s.y = uy + (s.y - uy) * kept;
  // Work: the integral of s . d over the displacement. Loss: work minus the change of the elastic energy K s^2 / 2.
  const double work = l - (1 - along) * K * (1 - kept);
  return {work, work - 0.5 * K * (s.square() - before)};
}

} // namespace grouser::scm
