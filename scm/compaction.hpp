// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scm/pressure_curve.hpp"
#include "scm/soil_constants.hpp"

#include <algorithm>

namespace grouser::scm {

/// Soil state at a node: the end point of its last virgin loading, and the unloading-reloading line through that point,
/// p = p_u - k_u (z_u - z) >= 0 (Wong). Sinkage z is measured from the virgin surface.
struct Compaction {
  double sinkage{};   ///< z_u [m], at the end of virgin loading
  double pressure{};  ///< p_u [Pa]
  double stiffness{}; ///< k_u [N/m3]; 0 before the first load
  double modulus{};   ///< k of the virgin curve k z^n through (z_u, p_u) [N/m^(n+2)]

  /// Residual sinkage after unloading [m].
  double rebound() const { return stiffness > 0 ? sinkage - pressure / stiffness : 0; }
  /// Pressure on the unloading-reloading line [Pa], for z <= z_u.
  double pressureAt(double z) const { return stiffness > 0 ? std::max(0.0, pressure - stiffness * (sinkage - z)) : 0; }
  /// Elastic energy per area [J/m2] at a pressure [Pa].
  double elastic(double p) const { return stiffness > 0 ? 0.5 * p * p / stiffness : 0; }
};

/// Slope k_u after virgin loading to (z_u, p_u) [N/m3], at least f max(1, n) p_u / z_u. A slope below p_u / z_u would
/// raise the unloaded surface above the virgin surface; a slope below that of the virgin curve, n p_u / z_u, would
/// reduce the plastic sinkage during loading.
inline double unloadingStiffness(const SoilConstants& soil, double sinkage, double pressure) {
  return std::max(soil.unloadingStiffness + soil.unloadingGrowth * sinkage,
                  soil.elasticRatio * std::max(1.0, soil.exponent) * pressure / sinkage);
}

/// Moves the end of virgin loading to the intersection of the unloading-reloading line with a stiffer virgin curve k
/// g(z) [N/m^(n+2)], as under a loaded area of another width. A softer curve has no effect.
inline void stiffen(Compaction& state, const PressureCurve& curve, double k) {
  if (!(state.stiffness > 0) || k <= state.modulus) return;
  // p_u + k_u (z - z_u) = k g(z). The line is steeper, so Newton's method converges from its current end.
  double z = state.sinkage;
  for (int i = 0; i < 6; ++i) {
    const double excess = k * curve.at(z) - state.pressure - state.stiffness * (z - state.sinkage);
    z += excess / (state.stiffness - k * curve.slopeAt(z));
  }
  state.pressure += state.stiffness * (z - state.sinkage), state.sinkage = z, state.modulus = k;
}

/// Result of a change of sinkage.
struct Compression {
  double pressure{};     ///< at the end [Pa]
  double work{}, loss{}; ///< work on the soil; its dissipated part [J/m2]
};

/// Changes the sinkage of a node from `from` to `to` [m] under a pad of modulus k, and updates its state. Work and loss
/// are path integrals of the pressure, exact for any step.
inline Compression compress(Compaction& state, const SoilConstants& soil, const PressureCurve& curve, double k,
                            double from, double to) {
  stiffen(state, curve, k);
  const double before = state.pressureAt(std::min(from, state.sinkage)), elasticBefore = state.elastic(before);
  Compression c;
  if (to <= state.sinkage) {
    c.pressure = state.pressureAt(to);
    // Elastic: no dissipation.
    c.work = state.elastic(c.pressure) - elasticBefore;
    return c;
  }
  const double modulus = std::max(k, state.modulus);
  const double elasticAtYield = state.elastic(state.pressure);
  c.work = elasticAtYield - elasticBefore + modulus * (curve.integralTo(to) - curve.integralTo(state.sinkage));
  state.sinkage = to, state.pressure = modulus * curve.at(to), state.modulus = modulus;
  state.stiffness = unloadingStiffness(soil, to, state.pressure);
  c.pressure = state.pressure;
  c.loss = c.work - (state.elastic(c.pressure) - elasticBefore);
  return c;
}

} // namespace grouser::scm
