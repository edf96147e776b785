// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/math.hpp"

namespace grouser::scm {

/// Soil constants: Bekker's pressure-sinkage relation p = (k_c / b + k_phi) z^n, Wong's linear unloading, and Janosi's
/// shear stress tau = (c + p tan phi) (1 - exp(-j / K)) (Wong, Theory of Ground Vehicles, chapter 2).
struct SoilConstants {
  double exponent = 1;                            ///< n [-], > 0
  double kc{};                                    ///< [N/m^(n+1)], may be negative
  double kphi{};                                  ///< [N/m^(n+2)]
  double cohesion{};                              ///< c [Pa], >= 0
  double friction{};                              ///< tan phi [-], >= 0
  double shearDisplacement{};                     ///< K [m], > 0
  double unloadingStiffness{}, unloadingGrowth{}; ///< k_0 [N/m3] and A_u [N/m4] of k_u = k_0 + A_u z_u, as measured
  double elasticRatio =
      10;               ///< f [-], >= 1: k_u is at least f max(1, n) p_u / z_u, so a plate rebounds by at most z_u / f
  double damping{};     ///< [Pa s/m] of compression and shear, >= 0
  double slipSinkage{}; ///< sinkage per shear displacement at constant pressure [-], >= 0
  double maximumSlipSinkage{}; ///< [m]
  double unitWeight{};         ///< [N/m3]

  /// k = k_c / b + k_phi [N/m^(n+2)] for a loaded area with the smaller side b [m].
  double modulusAt(double b) const { return kc / b + kphi; }
  /// Sinkage [m] under a pressure [Pa] in virgin loading.
  double sinkageUnder(double pressure, double b) const { return base::pow(pressure / modulusAt(b), 1 / exponent); }
};

/// Shear damping coefficient [N] of a contact with area [m2] and shear strength [N]: damping force / change of s in the
/// step, with `change` the magnitude of that change. Follows from R K ds/dt with the damping R, the bristle damping of
/// the LuGre model (Canudas de Wit et al. 1995, IEEE Trans. Autom. Control 40:419), limited to 1 % of the strength. It
/// dissipates in any motion, and is zero in steady slip. Without it, a loaded body below its holding limit oscillates
/// and creeps downhill.
inline double shearDamping(const SoilConstants& soil, double timeStep, double area, double strength, double change) {
  constexpr double kMaxShare = 0.01; // maximum damping force / shear strength
  const double damping = soil.damping * soil.shearDisplacement / timeStep * area;
  return damping * change > kMaxShare * strength ? kMaxShare * strength / change : damping;
}

} // namespace grouser::scm
