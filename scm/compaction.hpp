// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scm/pressure_curve.hpp"
#include "scm/soil_constants.hpp"

#include <algorithm>

namespace grouser::scm {

/// What a place of the soil remembers of the loads on it: the end of its virgin loading, and the line along which it is
/// unloaded and loaded again, p = p_u - k_u (z_u - z), never below 0 (Wong). Sinkage z counts from the surface of the
/// virgin soil.
struct Compaction {
  double sinkage{};   ///< z_u [m]
  double pressure{};  ///< p_u [Pa]
  double stiffness{}; ///< k_u [N/m3]; 0 before the first load
  double modulus{};   ///< k of the curve k z^n that p_u lies on [N/m^(n+2)]

  /// Sinkage of the unloaded surface [m].
  double rebound() const { return stiffness > 0 ? sinkage - pressure / stiffness : 0; }
  /// Pressure of un- and reloading [Pa], at z <= z_u.
  double pressureAt(double z) const { return stiffness > 0 ? std::max(0.0, pressure - stiffness * (sinkage - z)) : 0; }
  /// Elastic energy an area holds under a pressure [J/m2].
  double elastic(double p) const { return stiffness > 0 ? 0.5 * p * p / stiffness : 0; }
};

/// k_u at the end of a virgin loading [N/m3]. Never less than f max(1, n) p_u / z_u: below p_u / z_u soil would rise above
/// its old surface, and below the virgin slope, n p_u / z_u, its plastic sinkage would run backwards.
inline double unloadingStiffness(const SoilConstants& soil, double sinkage, double pressure) {
  return std::max(soil.unloadingStiffness + soil.unloadingGrowth * sinkage,
                  soil.elasticRatio * std::max(1.0, soil.exponent) * pressure / sinkage);
}

/// Meets a load of another width, of modulus k [N/m^(n+2)]: if that is stiffer than what the place remembers, virgin
/// loading begins where its present line meets the curve k g(z). A place never forgets a stiffer load.
inline void meetModulus(Compaction& place, const PressureCurve& curve, double k) {
  if (!(place.stiffness > 0) || k <= place.modulus) return;
  // p_u + k_u (z - z_u) = k g(z). The line is the steeper one, so Newton's method converges from its present end.
  double z = place.sinkage;
  for (int i = 0; i < 6; ++i) {
    const double excess = k * curve.at(z) - place.pressure - place.stiffness * (z - place.sinkage);
    z += excess / (place.stiffness - k * curve.slopeAt(z));
  }
  place.pressure += place.stiffness * (z - place.sinkage), place.sinkage = z, place.modulus = k;
}

/// Work a place has taken [J/m2]: in all, and how much of it is lost.
struct Compression {
  double pressure{}; ///< at the end [Pa]
  double work{}, loss{};
};

/// Moves the surface of a place from sinkage `from` to `to` [m] under a pad of modulus k, and updates its memory. The work
/// is exact: the integral of the pressures on the way.
inline Compression compress(Compaction& place, const SoilConstants& soil, const PressureCurve& curve, double k,
                            double from, double to) {
  meetModulus(place, curve, k);
  const double before = place.pressureAt(std::min(from, place.sinkage)), held = place.elastic(before);
  Compression c;
  if (to <= place.sinkage) {
    c.pressure = place.pressureAt(to);
    // On the line the work is the change of what it holds, and nothing is lost.
    c.work = place.elastic(c.pressure) - held;
    return c;
  }
  const double own = std::max(k, place.modulus);
  const double reached = place.elastic(place.pressure);
  c.work = reached - held + own * (curve.integralTo(to) - curve.integralTo(place.sinkage));
  place.sinkage = to, place.pressure = own * curve.at(to), place.modulus = own;
  place.stiffness = unloadingStiffness(soil, to, place.pressure);
  c.pressure = place.pressure;
  c.loss = c.work - (place.elastic(c.pressure) - held);
  return c;
}

} // namespace grouser::scm
