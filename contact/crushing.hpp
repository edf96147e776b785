// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "contact/contact_law.hpp"

/// Grains that crush: the normal force of a contact is at most F_c = sigma_f d^2 (d: diameter; sigma_f: crushing
/// strength; Jaeger 1967, Int. J. Rock Mech. Min. Sci. 4:219). At F_c the contact yields: the further indentation, the
/// `dent`, is permanent, and the spring depends only on the elastic overlap e = overlap - dent:
///
///   F = F_spring(e),  0 <= e <= y,  F_spring(y) = F_c
///   overlap - dent > y:  dent = overlap - y, which dissipates (F_c - pull) x the growth of the dent
///   overlap <= dent:     the surfaces are apart in the dent: no force, no energy
///
/// (pull: attraction of cohesion). The stored energy is that of the spring at e, a function of the state (overlap,
/// dent). Unloading from F_c follows the curve F_spring(e) and returns only the elastic energy. Linear law: unloading
/// has the slope k, and an impact with the relative energy E retains the fraction F_c^2 / (2 k) / E. The dashpot acts
/// in addition to the spring, up to a total force of F_c.
namespace grouser::contact {

/// Crushing constants of one material, for its contacts with parts.
struct Crushing {
  float strength;   ///< sigma_f [Pa]; 0: does not crush
  float hertzYield; ///< y / radius for a Hertz contact [-]
};

inline Crushing crushingOf(double strength, const ContactLaw& law) {
  if (!law.hertz || strength <= 0) return {static_cast<float>(strength), 0};
  // K sqrt(R) y^1.5 = 4 sigma_f R^2: (y / R)^3 = (4 sigma_f / K)^2, by Newton's iteration from above.
  const double ratio = 4 * strength / law.stiffness, cube = ratio * ratio;
  double y = cube > 1 ? cube : 1;
  for (int k = 0; k < 200; ++k) y -= (y * y * y - cube) / (3 * y * y);
  return {static_cast<float>(strength), static_cast<float>(y)};
}

/// Effect of the force cap on a contact in one step.
struct Yielded {
  float overlap;    ///< elastic overlap [m]; <= 0 if the surfaces are apart in the dent
  float damping;    ///< active fraction of the law's normal damping [-]
  float dissipated; ///< [J]
  float cut;        ///< spring force removed by the cap [N]
  bool capped;
};

/// Increases the `dent`. `approach`: approach speed of the surfaces [m/s]. The effective radius is the grain radius.
template <unsigned kFeatures> GROUSER_HD Yielded yieldContact(const Crushing& crushing, const BasicLaw<float>& law,
                                                              float overlap, float approach, float dt, float mass,
                                                              float radius, float& dent) {
  const float cap = 4 * crushing.strength * radius * radius;
  const float most = law.hertz ? crushing.hertzYield * radius : cap / law.stiffness;
  Yielded y{overlap - dent, 1, 0, 0, false};
  if (y.overlap >= most) {
    const float growth = y.overlap - most;
    dent = overlap - most;
    y.overlap = most, y.capped = true;
    // A contact that has moved to another place of the part can deepen instantly, without any work.
    const float way = approach > 0 ? approach * dt : 0;
    y.dissipated = (cap - law.pull(radius)) * (growth > 1.5f * way ? way : growth);
    y.cut = coefficientsOf<kFeatures>(law, overlap, mass, radius).elastic - cap;
  }
  if (y.overlap <= 0 || approach <= 0) return y;
  const Coefficients<float> c = coefficientsOf<kFeatures>(law, y.overlap, mass, radius);
  const float dashpot = c.damping * approach, room = cap - c.elastic;
  if (dashpot > room) y.damping = room > 0 ? room / dashpot : 0;
  return y;
}

} // namespace grouser::contact
