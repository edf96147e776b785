// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "contact/contact_law.hpp"

namespace grouser::contact {

/// How two surfaces in touch roll on each other, seen from side i.
template <class T> struct RollingMotion {
  base::Vec3<T> normal; ///< unit, from i to j
  base::Vec3<T> spin;   ///< of i relative to j [rad/s]
  T radius;             ///< R_r = R_i R_j / (R_i + R_j); R_i against a wall [m]
  T inertia;            ///< I_r: of both about the contact point, in series [kg m2]
};

/// Of a sphere on what never moves.
template <class T> GROUSER_HD T rollingInertia(T mass, T radius) { return T(1.4) * mass * radius * radius; }
/// Of spheres: 1 / I_r = 1 / (1.4 m_i R_i^2) + 1 / (1.4 m_j R_j^2).
template <class T> GROUSER_HD T rollingInertia(T massI, T radiusI, T massJ, T radiusJ) {
  const T i = rollingInertia(massI, radiusI), j = rollingInertia(massJ, radiusJ);
  return i * j / (i + j);
}

/// Stiffness of the rolling spring [N m/rad].
template <class T> GROUSER_HD T rollingStiffness(const BasicLaw<T>& law, T normalStiffness, T radius) {
  const T arm = law.rollingFriction * radius;
  return T(2.25) * normalStiffness * (arm * arm);
}

/// Elastic-plastic spring-dashpot, type C of Ai, Chen, Rotter and Ooi (2011), Powder Technol. 206:269, in space:
///
///   M = -k_r angle - c_r spin    with k_r = 2.25 k_n (mu_r R_r)^2,  |M| <= mu_r R_r F_n
///
/// The angle [rad] is the history of the relative spin in the tangent plane; where the spring is at the limit it is
/// shortened to fit and the dashpot is off. Below, the dashpot may at most fill the torque up to the limit: in the
/// paper it may exceed it many times, so that a fast ball loses percents of its energy in the moment of touch. Spin
/// about the normal is not resisted. `pressing` and `normalStiffness` are the reaction's. Returns the torque on i [N
/// m]; on j it is the exact opposite. Adds what it dissipates: by the dashpot, with the spin in the middle of the step
/// as this torque alone would make it, and at the limit all work but what the spring gains.
template <class T> GROUSER_HD base::Vec3<T> rollingTorque(const BasicLaw<T>& law, const RollingMotion<T>& m, T pressing,
                                                          T normalStiffness, T dt, base::Vec3<T>& angle,
                                                          T& dissipated) {
  if (law.rollingFriction <= 0) return angle = {};
  const base::Vec3<T> rolling = m.spin - m.normal * dot(m.spin, m.normal);
  const T stiffness = rollingStiffness(law, normalStiffness, m.radius);
  angle -= m.normal * dot(angle, m.normal);
  const T storedBefore = stiffness * dot(angle, angle);
  angle += rolling * dt;
  base::Vec3<T> torque = angle * -stiffness;
  const T limit = law.rollingFriction * m.radius * (pressing > 0 ? pressing : T(0));
  const T size2 = dot(torque, torque);
  const bool slides = size2 > limit * limit;
  base::Vec3<T> damping{};
  if (slides) {
    torque *= limit / squareRoot(size2);
    angle = stiffness > 0 ? torque * (T(-1) / stiffness) : base::Vec3<T>{};
  } else {
    const base::Vec3<T> spring = torque;
    torque -= rolling * (T(2) * law.rollingDamping * squareRoot(m.inertia * stiffness));
    const T both2 = dot(torque, torque);
    if (both2 > limit * limit) torque *= limit / squareRoot(both2);
    damping = torque - spring;
  }
  if (slides) {
    dissipated -= dot(torque, rolling) * dt + T(0.5) * (stiffness * dot(angle, angle) - storedBefore);
  } else {
    // About their centres spheres are 7/2 times easier to turn than about the point of contact.
    const base::Vec3<T> middle = rolling + torque * (T(1.75) * dt / m.inertia);
    dissipated -= dot(damping, middle) * dt;
  }
  return torque;
}

} // namespace grouser::contact
