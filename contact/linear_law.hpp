// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/vec.hpp"

namespace grouser::contact {

/// Linear spring-dashpot contact with Cundall-Strack tangential history (Cundall and Strack 1979, Geotechnique 29:47).
///
///   F_n = k overlap - gamma m_eff v_n            v_n: separation speed;  never attractive unless `attraction`
///   F_t = -k_t shear - gamma_t m_eff v_t         |F_t| <= friction F_n; when it slips the spring is shortened to fit
struct LinearLaw {
  float stiffness{};           ///< k [N/m], > 0
  float damping{};             ///< gamma [1/s], >= 0
  float tangentialStiffness{}; ///< k_t [N/m], >= 0
  float tangentialDamping{};   ///< gamma_t [1/s], >= 0
  float friction{};            ///< Coulomb coefficient [-], >= 0; 0 switches the tangential force off
  bool attraction{};           ///< whether the dashpot may pull
};

/// Two surfaces in touch, seen from side i. The normal points from i to j.
struct Touch {
  base::Vec3f normal;   ///< unit, from i to j
  float overlap;        ///< [m], > 0
  base::Vec3f velocity; ///< of i's material point relative to j's at the contact point [m/s]
  float effectiveMass;  ///< m_i m_j / (m_i + m_j) [kg]
};

/// What one contact does in one step.
struct Reaction {
  base::Vec3f force; ///< on i [N]; on j it is the exact opposite
  float dissipated;  ///< by dashpots and sliding within the step [J]
};

/// Force of `law` on side i, and the tangential spring `shear` [m] carried to the end of the step.
/// Swapping i and j (normal, velocity and shear change sign) changes only the force's sign, to the last bit.
///
/// What is dissipated is the work of the dashpot, with the approach in the middle of the step as this contact alone
/// would make it (second order in the step for a single collision), and of friction (first order).
GROUSER_HD Reaction linearForce(const LinearLaw& law, const Touch& touch, float dt, base::Vec3f& shear) {
  const base::Vec3f& n = touch.normal;
  const float approach = dot(touch.velocity, n);
  const float elastic = law.stiffness * touch.overlap;
  float dashpot = law.damping * touch.effectiveMass * approach;
  // Without attraction the dashpot may at most cancel the spring.
  if (!law.attraction && elastic + dashpot < 0) dashpot = -elastic;
  const float normalForce = elastic + dashpot;
  const float halfStepPerMass = 0.5f * dt / touch.effectiveMass;
  Reaction reaction{n * -normalForce, dashpot * (approach - normalForce * halfStepPerMass) * dt};
  if (law.friction <= 0) return reaction;

  // Turn the spring into the present tangent plane, then stretch it by this step's slip.
  const base::Vec3f slip = touch.velocity - n * approach;
  shear -= n * dot(shear, n);
  const float storedBefore = law.tangentialStiffness * dot(shear, shear);
  shear += slip * dt;
  const float tangentialDashpot = law.tangentialDamping * touch.effectiveMass;
  base::Vec3f tangential = shear * -law.tangentialStiffness - slip * tangentialDashpot;
  const float limit = law.friction * (normalForce > 0 ? normalForce : 0.0f);
  const float size2 = dot(tangential, tangential);
  if (size2 > limit * limit) {
    // Sliding: the force lies on Coulomb's cone, and the spring is as long as it would hold that force.
    tangential *= limit / sqrtf(size2);
    shear = law.tangentialStiffness > 0 ? tangential * (-1.0f / law.tangentialStiffness) : base::Vec3f{};
  }
  // Work put into the tangential contact, less what its spring has gained.
  reaction.dissipated -=
      dot(tangential, slip) * dt + 0.5f * (law.tangentialStiffness * dot(shear, shear) - storedBefore);
  reaction.force += tangential;
  return reaction;
}

/// Energy stored in the springs of a contact [J].
GROUSER_HD double storedEnergy(const LinearLaw& law, double overlap, const base::Vec3f& shear) {
  const double s2 = static_cast<double>(dot(shear, shear));
  return 0.5 * law.stiffness * overlap * overlap + 0.5 * law.tangentialStiffness * s2;
}

} // namespace grouser::contact
