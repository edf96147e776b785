// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/number.hpp"

/// Implicit steps of Hertz contacts: their force is nonlinear in the overlap at the end of the step, so a row of the
/// complementarity problem is its tangent, which Newton's method moves to where the step ends.
namespace grouser::contact {

using base::squareRoot;

/// Normal spring and dashpot of a Hertz contact: elastic overlap^1.5 and damping overlap^0.25 times the speed.
template <class T> struct HertzNormal {
  T elastic; ///< [N/m^1.5]; 0: not a Hertz contact, or linear in this step (impacts)
  T damping; ///< [N s/m^1.25]
  T mass;    ///< see ImpulseTouch::movedMass
};

/// Overlap of a Hertz contact after an implicit step in which only its elastic force acts, from the overlap `free` > 0
/// without this force [m]: the root of m (free - overlap) / h^2 = elastic overlap^1.5. Newton's method for the square
/// root of the overlap: a convex function, approached from above.
template <class T> GROUSER_HD T endOverlap(const HertzNormal<T>& law, T free, T timeStep) {
  const T cubic = timeStep * timeStep * law.elastic / law.mass;
  T root = squareRoot(free);
  constexpr int kMost = 100; // two thirds of the former value at least, then twice the places
  for (int k = 0; k < kMost; ++k) {
    const T next = root - (root * root * (cubic * root + T(1)) - free) / (root * (T(3) * cubic * root + T(2)));
    if (!(next < root)) break;
    root = next;
  }
  return root * root;
}

/// Normal part of a row: softness [1/kg], offset [m/s] and dashpot coefficient [N s/m].
template <class T> struct NormalRow { T softness, offset, damping; };

/// Hertz contact linearised at the overlap `deep` > 0. `gap`: at the start of the step [m].
template <class T> GROUSER_HD NormalRow<T> linearised(const HertzNormal<T>& law, T deep, T gap, T timeStep) {
  const T root = squareRoot(deep), modulus = law.elastic * root, stiffness = T(1.5) * modulus,
          damping = law.damping * squareRoot(root), soft = timeStep * stiffness + damping;
  const T force = modulus * deep - stiffness * (deep + gap); // at the start; < 0 if the surfaces are apart
  return {1 / (timeStep * soft), -force / soft, damping};
}

/// Where a step ended on the tangent of Hertz's law, compared with the law.
template <class T> struct HertzError {
  T speed; ///< velocity error due to the difference of the forces [m/s], >= 0
  T deep;  ///< overlap at which the row is linearised next [m]
};

/// `row`: current linearisation; `overlap`: at the start of the step; `along`: normal impulse; `parting`: separation
/// speed at the end. The next overlap is that of the law if the mass of the contact alone responds. The error excludes
/// the residual of the iterations: it compares the forces of tangent and law at the same overlap.
template <class T> GROUSER_HD HertzError<T> hertzError(const HertzNormal<T>& law, const NormalRow<T>& row, T overlap,
                                                       T along, T parting, T timeStep) {
  const T deep = overlap - timeStep * parting, dashpot = row.damping * parting;
  const T elastic = deep > 0 ? law.elastic * squareRoot(deep) * deep : T(0);
  // Rigid rows, of surfaces that were not expected to meet, have no tangent.
  const T impulse = row.softness > 0 ? (parting + row.offset) / -row.softness : along;
  const T acts = along > 0 && impulse > 0 ? impulse / timeStep + dashpot : T(0);
  if (!(along > 0) && elastic <= dashpot) return {T(0), deep}; // the dashpot of a separating contact holds the force
  const T error = elastic - acts, free = deep + (acts > 0 ? acts : T(0)) * (timeStep * timeStep / law.mass);
  if (!(free > 0)) return {T(0), deep};
  const T next = endOverlap(law, free, timeStep);
  if (!(next > 0)) return {T(0), deep};
  const T softness = linearised(law, next, -overlap, timeStep).softness;
  return {(error < 0 ? -error : error) * timeStep * (softness / (softness * law.mass + T(1))), next};
}

} // namespace grouser::contact
