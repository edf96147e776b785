// SPDX-License-Identifier: BSD-3-Clause
#include "contact/restitution.hpp"

#include "base/math.hpp"

#include <cmath>
#include <limits>

namespace grouser::contact {

namespace {

/// omega_0 t_c of the clamped law; eta = zeta omega_0.
double clampedDuration(double zeta) {
  if (zeta < 1) {
    const double w = std::sqrt(1 - zeta * zeta);
    return (base::kPi - base::atan2(2 * zeta * w, w * w - zeta * zeta)) / w;
  }
  if (zeta == 1) return 2;
  const double s = std::sqrt(zeta * zeta - 1);
  return base::log((zeta + s) / (zeta - s)) / s;
}

} // namespace

double contactDuration(double omega0, double zeta, bool attraction) {
  if (!attraction) return clampedDuration(zeta) / omega0;
  if (zeta >= 1) return std::numeric_limits<double>::infinity();
  return base::kPi / (omega0 * std::sqrt(1 - zeta * zeta));
}

double restitutionOf(double zeta, bool attraction) {
  if (attraction) return zeta >= 1 ? 0.0 : base::exp(-zeta * base::kPi / std::sqrt(1 - zeta * zeta));
  return base::exp(-zeta * clampedDuration(zeta));
}

double dampingRatioFor(double restitution, bool attraction) {
  if (restitution >= 1) return 0;
  if (attraction) {
    const double l = -base::log(restitution);
    return l / std::sqrt(base::kPi * base::kPi + l * l);
  }
  // e falls steadily with zeta: bisect.
  double low = 0, high = 1;
  while (restitutionOf(high, false) > restitution) high *= 2;
  for (int i = 0; i < 200 && low < high; ++i) {
    const double middle = 0.5 * (low + high);
    if (middle == low || middle == high) break;
    (restitutionOf(middle, false) > restitution ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

double stableStep(double omega0, double zeta) { return 2 * (std::sqrt(1 + zeta * zeta) - zeta) / omega0; }

} // namespace grouser::contact
