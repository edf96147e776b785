// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/math.hpp"
#include "base/vec.hpp"

namespace grouser::scm {

/// Shear of the soil under a piece of a pad, as a share of the stress that it can carry: tau = tau_m s, |s| <= 1, in the
/// plane of the pad. K ds = dj - s |dj|: in straight shear Janosi's 1 - exp(-j / K) (Janosi, Hanamoto 1961), and right in
/// turns and reversals, where a stress by path length against the present velocity is not.
struct Shear {
  double x{}, y{}; ///< [-]

  double square() const { return x * x + y * y; }
};

/// Work of a piece over a slip at constant tau_m [m]: times tau_m and area it is an energy.
struct ShearWork {
  double work{}, loss{};
};

/// Advances by the slip (dx, dy) of the pad over the ground [m] along a straight line: exact for any length. With the
/// slip's unit vector d and length l, s' = d + (s - d) exp(-l / K).
inline ShearWork advance(Shear& s, double dx, double dy, double K) {
  const double l = ::sqrt(dx * dx + dy * dy);
  if (!(l > 0)) return {};
  const double ux = dx / l, uy = dy / l, along = s.x * ux + s.y * uy, before = s.square();
  const double kept = base::exp(-l / K);
  s.x = ux + (s.x - ux) * kept, s.y = uy + (s.y - uy) * kept;
  // The integral of s . d over the slip, and what of it the soil does not hold as K s^2 / 2.
  const double work = l - (1 - along) * K * (1 - kept);
  return {work, work - 0.5 * K * (s.square() - before)};
}

} // namespace grouser::scm
