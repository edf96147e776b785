// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "contact/complementarity_options.hpp"
#include "contact/contact_law.hpp"
#include "contact/hertz_tangent.hpp"
#include "contact/impulse_cone.hpp"
#include "contact/rolling_resistance.hpp"

/// Contact as one row of the complementarity problem of a step (Moreau 1988; Tasora and Anitescu 2011, Comput. Methods
/// Appl. Mech. Eng. 200:439), with u the relative velocity at the end of the step and x the impulse:
///
///   K  >  x   perpendicular to   a = u + softness x + offset   > K*
///
/// Compliant contacts discretise the penalty law by implicit Euler: the force k (overlap - h u_n) - c u_n yields the
/// softness 1 / (h (h k + c)) and the offset -k overlap / (h k + c). Rigid contacts have zero softness.
namespace grouser::contact {

/// Options in a kernel's precision.
template <class T> struct ImpulseRules {
  T timeStep, recovery, impact;
  T stiffness; ///< scale of keptImpulse() [N/m]
  bool rigid;
};

/// Geometry and motion of two surfaces at the start of a step, seen from side i.
template <class T> struct ImpulseTouch {
  base::Vec3<T> push;     ///< unit, from j to i
  T gap;                  ///< [m], < 0: overlap
  base::Vec3<T> velocity; ///< velocity of contact point i relative to j's [m/s]
  base::Vec3<T> spin;     ///< angular velocity of i relative to j [rad/s]
  T freely;               ///< change of the separation speed in this step without contact forces [m/s]
  T effectiveMass, effectiveRadius;
  T movedMass;                    ///< mass that an impulse along the normal accelerates, or less [kg]
  T rollingInertia;               ///< see RollingMotion
  T dampingShare;                 ///< see BasicContactGeometry
  T pullShare = 1;                ///< see BasicContactGeometry
  base::Vec3<T> shear{}, angle{}; ///< springs in the tangent plane [m], [rad]; rigid: see keptImpulse()
  bool held{false};               ///< the contact overlapped or transmitted an impulse in the last step
  T slipped{}, rolled{};          ///< energy that followStiffness() has taken from the springs [J]
};

/// Constants of a row during a step.
template <class T> struct ImpulseRow {
  base::Vec3<T> push;
  base::Vec3<T> offset, turnOffset; ///< [m/s], [rad/s]
  T softness, shearSoftness;        ///< [1/kg]
  T rollingSoftness;                ///< [1/(kg m2)]
  ImpulseCone<T> cone;
  T pull;                  ///< impulse of cohesion on each side, towards the other [N s]
  T damping, shearDamping; ///< dashpot coefficients [N s/m]; 0 for rigid contacts and impacts
  T rollingDamping;        ///< dashpot coefficient of the rolling spring [N m s]; 0 likewise
  T slipped, rolled;       ///< see ImpulseTouch
  T normalOffset;          ///< part of `offset` along `push` that depends on the linearisation [m/s]
  HertzNormal<T> hertz;
  bool impact;      ///< a new contact with Newton restitution
  Impulse<T> start; ///< initial impulse of the solver
};

/// Warm start of a rigid contact, stored in place of a spring: a length [m] that represents the initial
/// impulse of the next step.
template <class T> GROUSER_HD base::Vec3<T> keptImpulse(const base::Vec3<T>& impulse, const ImpulseRules<T>& rules) {
  return impulse * (T(-1) / (rules.timeStep * rules.stiffness));
}

namespace detail {
template <class T> GROUSER_HD base::Vec3<T> tangentOf(const base::Vec3<T>& v, const base::Vec3<T>& normal) {
  return v - normal * dot(v, normal);
}
} // namespace detail

/// Adapts the springs of a lasting Hertz contact to the stiffness at its overlap, as penalty contacts do:
/// hertzChange().
template <class T> GROUSER_HD void followStiffness(const BasicLaw<T>& law, ImpulseTouch<T>& touch, T timeStep) {
  if (!law.hertz || !(touch.gap < 0)) return;
  const StiffnessChange<T> change = hertzChange(-touch.gap, -dot(touch.velocity, touch.push) * timeStep);
  const Coefficients<T> c = coefficientsOf<kGeneral>(law, -touch.gap, touch.effectiveMass, touch.effectiveRadius);
  touch.slipped = c.tangentialStiffness * norm2(touch.shear) * change.taken;
  touch.rolled = rollingStiffness(law, c.normalStiffness, touch.effectiveRadius) * norm2(touch.angle) * change.taken;
  touch.shear *= change.kept, touch.angle *= change.kept;
}

/// Returns the row of two surfaces that may come into contact within a step.
template <class T> GROUSER_HD ImpulseRow<T> impulseRow(const BasicLaw<T>& law, const ImpulseTouch<T>& touch,
                                                       const ImpulseRules<T>& rules) {
  const T h = rules.timeStep, overlap = touch.gap < 0 ? -touch.gap : T(0);
  const T parting = dot(touch.velocity, touch.push);
  ImpulseRow<T> row{};
  row.push = touch.push;
  row.cone = {law.friction, law.rollingFriction * touch.effectiveRadius};
  if (touch.gap < 0) row.pull = h * law.pull(touch.effectiveRadius) * touch.pullShare;
  const T closing = -(touch.gap + h * (parting + touch.freely)); // overlap at the end, without contact forces
  row.impact = !touch.held && parting < -rules.impact && closing > 0;
  if (row.impact) {
    row.offset = touch.push * (law.restitution * parting);
    return row;
  }
  if (rules.rigid) {
    const T wanted = touch.gap / h;
    row.offset = touch.push * (wanted > -rules.recovery ? wanted : -rules.recovery);
    if (touch.held) row.start = {touch.shear * (-h * rules.stiffness), touch.angle * (-h * rules.stiffness)};
    return row;
  }
  // Hertz's law is linearised first where the step ends if no other contact acts, or at the current overlap if that is
  // larger; later where the step ends, see hertzError().
  T deep = overlap;
  if (law.hertz) {
    const T root = squareRoot(touch.effectiveRadius);
    row.hertz = {law.stiffness * root,
                 touch.gap < 0 ? law.rootDamping * squareRoot(touch.effectiveMass * root) * touch.dampingShare : T(0),
                 touch.movedMass};
    const T alone = closing > overlap ? endOverlap(row.hertz, closing, h) : overlap;
    if (alone > overlap) deep = alone;
  }
  Coefficients<T> c = coefficientsOf<kGeneral>(law, deep, touch.effectiveMass, touch.effectiveRadius);
  const T touches = touch.gap < 0 ? touch.dampingShare : T(0); // no dashpot before contact
  c.damping *= touches, c.tangentialDamping *= touches;
  row.damping = c.damping, row.shearDamping = c.tangentialDamping;
  const T stiffness = c.normalStiffness, soft = h * stiffness + c.damping;
  const T force = c.elastic - stiffness * (deep + touch.gap); // spring force; < 0 if the surfaces are apart
  row.softness = soft > 0 ? 1 / (h * soft) : T(0);
  row.normalOffset = soft > 0 ? -force / soft : touch.gap / h;
  row.offset = touch.push * row.normalOffset;
  // Springs of a lasting contact have the stiffness of the current overlap, which followStiffness() has adapted them
  // to.
  T springs = stiffness;
  if (law.hertz && touch.held && overlap > 0 && deep > overlap) {
    const T damping = c.damping;
    c = coefficientsOf<kGeneral>(law, overlap, touch.effectiveMass, touch.effectiveRadius);
    c.damping = damping, c.tangentialDamping *= touches, springs = c.normalStiffness;
    row.shearDamping = c.tangentialDamping;
  }
  row.slipped = touch.slipped, row.rolled = touch.rolled;
  const T softShear = h * c.tangentialStiffness + c.tangentialDamping;
  row.shearSoftness = softShear > 0 ? 1 / (h * softShear) : T(0);
  if (softShear > 0) row.offset += touch.shear * (c.tangentialStiffness / softShear);
  const T turn = rollingStiffness(law, springs, touch.effectiveRadius);
  row.rollingDamping = T(2) * law.rollingDamping * base::squareRoot(touch.rollingInertia * turn);
  const T softTurn = h * turn + row.rollingDamping;
  row.rollingSoftness = softTurn > 0 ? 1 / (h * softTurn) : T(0);
  if (softTurn > 0) row.turnOffset = touch.angle * (turn / softTurn);
  row.start = {touch.push * (h * (force > 0 ? force : T(0))) - touch.shear * (h * c.tangentialStiffness),
               touch.angle * (-h * turn)};
  return row;
}

} // namespace grouser::contact
