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

/// Argument for which the decreasing function `restitutionAt` returns `restitution`, to `accuracy` or to the last bit.
template <class F> double ratioFor(double restitution, const F& restitutionAt, double accuracy) {
  double low = 0, high = 1;
  while (restitutionAt(high) > restitution) high *= 2;
  for (int i = 0; i < 200 && high - low > accuracy; ++i) {
    const double middle = 0.5 * (low + high);
    if (middle == low || middle == high) break;
    (restitutionAt(middle) > restitution ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

/// Restitution that a dashpot without attraction can reach: the given value, or kMinDashpotRestitution for 0.
double reachable(double restitution) { return restitution > 0 ? restitution : kMinDashpotRestitution; }

struct UnitImpact {
  double restitution, deepest;
};

/// One clamped Hertz impact at unit speed, in units with x'' = -x^(3/2) - c x^(1/4) x'; or only its loading phase.
UnitImpact clampedHertzImpact(double beta, bool wayInOnly) {
  const double c = 2 * beta * std::sqrt(1.5);
  const auto acceleration = [c](double x, double v) {
    const double root = std::sqrt(x > 0 ? x : 0);
    const double force = x * root + c * std::sqrt(root) * v;
    return force > 0 ? -force : 0.0;
  };
  constexpr double kStep = 3.2 / 4000;
  double x = 0, v = 1, deepest = 0;
  for (int i = 0; i < 1000000; ++i) {
    // Fourth-order Runge-Kutta.
    const double h = kStep;
    const double a1 = acceleration(x, v), v2 = v + 0.5 * h * a1;
    const double a2 = acceleration(x + 0.5 * h * v, v2), v3 = v + 0.5 * h * a2;
    const double a3 = acceleration(x + 0.5 * h * v2, v3), v4 = v + h * a3;
    const double a4 = acceleration(x + h * v3, v4);
    x += h / 6 * (v + 2 * v2 + 2 * v3 + v4);
    v += h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
    if (x > deepest) deepest = x;
    if (v < 0 && (wayInOnly || x <= 0 || acceleration(x, v) == 0)) return {-v, deepest};
  }
  return {0, deepest}; // overdamped return: c is very large
}

double clampedHertzRestitution(double beta) { return clampedHertzImpact(beta, false).restitution; }

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
  if (attraction && restitution <= 0) return 1;
  if (attraction) {
    const double l = -base::log(restitution);
    return l / std::sqrt(base::kPi * base::kPi + l * l);
  }
  return ratioFor(
      reachable(restitution), [](double zeta) { return restitutionOf(zeta, false); }, 0);
}

double stableStepOfMode(double stiffness, double damping) {
  return 4 / (damping + std::sqrt(damping * damping + 4 * stiffness));
}

double stableStep(double omega0, double zeta) { return stableStepOfMode(omega0 * omega0, 2 * zeta * omega0); }

double hertzRestitutionOf(double beta, bool attraction) {
  if (attraction) return restitutionOf(beta * std::sqrt(1.2), true);
  return beta <= 0 ? 1 : clampedHertzRestitution(beta);
}

double hertzDampingRatioFor(double restitution, bool attraction) {
  if (restitution >= 1) return 0;
  if (attraction) return std::sqrt(5.0 / 6) * dampingRatioFor(restitution, true);
  return ratioFor(reachable(restitution), clampedHertzRestitution, 1e-7);
}

HertzImpact hertzImpact(double effectiveModulus, double effectiveRadius, double effectiveMass, double speed) {
  // Johnson 1985, Contact Mechanics, eq. 11.23 and 11.24; 4 sqrt(pi) / 5 Gamma(2/5) / Gamma(9/10) = 2.943275...
  const double deepest =
      base::pow(15 * effectiveMass * speed * speed / (16 * effectiveModulus * std::sqrt(effectiveRadius)), 0.4);
  return {deepest, 2.9432751844 * deepest / speed};
}

double hertzDepthShare(double beta) {
  // Elastic: v^2 / 2 = (2/5) x^(5/2) at maximum overlap.
  return beta <= 0 ? 1 : clampedHertzImpact(beta, true).deepest / base::pow(1.25, 0.4);
}

double rayleighTime(double radius, double density, double shearModulus, double poisson) {
  return base::kPi * radius * std::sqrt(density / shearModulus) / (0.1631 * poisson + 0.8766);
}

} // namespace grouser::contact
