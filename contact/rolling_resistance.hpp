// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "contact/contact_law.hpp"

namespace grouser::contact {

/// Relative rolling motion of two surfaces in contact, seen from side i.
template <class T> struct RollingMotion {
  base::Vec3<T> normal; ///< unit, from i to j
  base::Vec3<T> spin;   ///< angular velocity of i relative to j [rad/s]
  T radius;             ///< R_r = R_i R_j / (R_i + R_j); against a wall R_i [m]
  T inertia;            ///< I_r: inertias of both about the contact point, in series [kg m2]
};

/// Rolling inertia of a sphere on a fixed surface.
template <class T> GROUSER_HD T rollingInertia(T mass, T radius) { return ScalarOf<T>(1.4) * mass * radius * radius; }
/// Two spheres: 1 / I_r = 1 / (1.4 m_i R_i^2) + 1 / (1.4 m_j R_j^2), in a form without products that overflow or
/// underflow a float. Swapping i and j changes no bit.
template <class T> GROUSER_HD T rollingInertia(T massI, T radiusI, T massJ, T radiusJ) {
  const T i = rollingInertia(massI, radiusI), j = rollingInertia(massJ, radiusJ);
  const T larger = i > j ? i : j, smaller = i > j ? j : i;
  return larger * (smaller / (i + j));
}

/// Stiffness of the rolling spring [N m/rad].
template <class T> GROUSER_HD T rollingStiffness(const BasicLaw<ScalarOf<T>>& law, T normalStiffness, T radius) {
  const T arm = law.rollingFriction * radius;
  return ScalarOf<T>(2.25) * normalStiffness * (arm * arm);
}

/// Elastic-plastic spring-dashpot, type C of Ai, Chen, Rotter and Ooi (2011), Powder Technol. 206:269, in 3-D:
///
///   M = -k_r angle - c_r spin    with k_r = 2.25 k_n (mu_r R_r)^2,  |M| <= mu_r R_r F_n
///
/// The angle [rad] is the accumulated relative rotation in the tangent plane; at the limit the spring is shortened to
/// the limit and the dashpot is off. Below the limit, the dashpot may raise the torque at most to the limit. In the
/// paper the torque may exceed the limit many times, and a fast ball loses several percent of its energy when contact
/// begins. Spin about the normal is not resisted. `pressing`, `normalStiffness` and `change` are those of the reaction;
/// `change`: null if k_n is constant. With Hertz's law k_r is proportional to k_n, and the spring adapts like the
/// tangential one, without adding energy. Returns the torque on i [N m]; j receives exactly the opposite. Adds to
/// the dissipation: the work of the dashpot, with the mid-step spin as if this torque acted alone; at the limit, all
/// work except the energy gain of the spring; and the loss by the stiffness change. T as in contactForce(): one source
/// for the kernels of both devices and for SIMD batches.
template <class T> GROUSER_HD base::Vec3<T> rollingTorque(const BasicLaw<ScalarOf<T>>& law, const RollingMotion<T>& m,
                                                          T pressing, T normalStiffness, ScalarOf<T> dt,
                                                          base::Vec3<T>& angle, T& dissipated,
                                                          const StiffnessChange<T>* change = nullptr) {
  using Scalar = ScalarOf<T>;
  const Scalar scale = law.squareScale; // scales the torques and energies below
  const T zero{};
  if (law.rollingFriction <= 0) return angle = {};
  const base::Vec3<T> rolling = m.spin - m.normal * dot(m.spin, m.normal);
  const T stiffness = rollingStiffness(law, normalStiffness, m.radius) * scale, inertia = m.inertia * scale;
  angle -= m.normal * dot(angle, m.normal);
  T taken{};
  if (change) taken = stiffness * dot(angle, angle) * change->taken, angle *= change->kept;
  const T storedBefore = stiffness * dot(angle, angle);
  angle += rolling * base::broadcast<T>(dt);
  const base::Vec3<T> spring = angle * -stiffness;
  const T limit = law.rollingFriction * m.radius * (pressing > zero ? pressing : zero) * scale;
  const T limit2 = limit * limit, size2 = dot(spring, spring);
  const auto slides = size2 > limit2;
  // Below the limit, the dashpot raises the torque at most to the limit.
  base::Vec3<T> torque = spring - rolling * (Scalar(2) * law.rollingDamping * squareRoot(inertia * stiffness));
  const T both2 = dot(torque, torque);
  if (const auto beyond = both2 > limit2; base::any(beyond))
    torque = base::select(beyond, torque * base::shareOf(limit, squareRoot(both2)), torque);
  // The inertia of a sphere about its centre is 7/2 times smaller than about the contact point.
  const base::Vec3<T> middle = rolling + torque * (Scalar(1.75) * dt / inertia);
  T given = dot(torque - spring, middle) * dt;
  if (base::any(slides)) {
    const base::Vec3<T> held = spring * base::shareOf(limit, squareRoot(size2));
    const base::Vec3<T> shortened =
        base::select(stiffness > zero, held * (Scalar(-1) / stiffness), base::Vec3<T>{zero, zero, zero});
    torque = base::select(slides, held, torque);
    angle = base::select(slides, shortened, angle);
    const T lost = dot(held, rolling) * dt + Scalar(0.5) * (stiffness * dot(angle, angle) - storedBefore);
    given = slides ? lost : given;
  }
  dissipated -= (given - taken) * (Scalar(1) / scale);
  return torque * base::broadcast<T>(Scalar(1) / scale);
}

} // namespace grouser::contact
