// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/number.hpp"
#include "base/vec.hpp"

#include <cmath>

/// Admissible impulses of a unilateral contact with Coulomb friction, and projections onto their cone.
namespace grouser::contact {

/// Torque of contacts without rolling resistance: nothing to store or compute.
struct NoTurn {
  GROUSER_HD friend NoTurn operator-(NoTurn, NoTurn) { return {}; }
  GROUSER_HD friend NoTurn operator+(NoTurn, NoTurn) { return {}; }
  template <class T> GROUSER_HD friend NoTurn operator*(NoTurn, T) { return {}; }
};

/// Impulse on side i of a contact: force and, with rolling resistance, torque, times the step.
template <class T, class Turn = base::Vec3<T>> struct Impulse {
  base::Vec3<T> linear; ///< [N s]
  Turn rolling;         ///< [N m s], in the tangent plane; zero without rolling resistance

  GROUSER_HD friend Impulse operator-(const Impulse& a, const Impulse& b) {
    return {a.linear - b.linear, a.rolling - b.rolling};
  }
  GROUSER_HD friend Impulse operator+(const Impulse& a, const Impulse& b) {
    return {a.linear + b.linear, a.rolling + b.rolling};
  }
  GROUSER_HD friend Impulse operator*(const Impulse& a, T s) { return {a.linear * s, a.rolling * s}; }
};

/// |tangential| <= friction * normal, |rolling| <= arm * normal, normal >= 0.
template <class T> struct ImpulseCone {
  T friction; ///< [-]
  T arm;      ///< coefficient of rolling resistance times radius [m]
};

/// Squared norm of an impulse: normal^2 + shear tangential^2 + rolling rolling^2.
template <class T> struct ImpulseMetric {
  T shear;   ///< [-]
  T rolling; ///< [1/m2]
};

/// False if a square may have underflowed or overflowed: squared impulses of micrometre grains underflow a float.
template <class T> GROUSER_HD bool isAccurate(T square) { return square > T(1e-30) && square < T(1e30); }

template <class T> GROUSER_HD T lengthOf(NoTurn) { return T(0); }
template <class T> GROUSER_HD T lengthOf(const base::Vec3<T>& v) {
  const T square = norm2(v);
  return isAccurate(square) ? base::squareRoot(square) : static_cast<T>(base::norm(v.template as<double>()));
}

/// Limits a vector to the length `most`.
template <class T> GROUSER_HD NoTurn cutTo(NoTurn, T) { return {}; }
template <class T> GROUSER_HD base::Vec3<T> cutTo(const base::Vec3<T>& v, T most) {
  const T square = norm2(v);
  if (isAccurate(square) && isAccurate(most * most))
    return square > most * most ? v * (most / base::squareRoot(square)) : v;
  const double size2 = norm2(v.template as<double>()), limit = static_cast<double>(most);
  if (!(size2 > limit * limit)) return v;
  return v * (most / static_cast<T>(sqrt(size2)));
}

/// Clips to Coulomb's law, which differs from the projection onto its cone: keeps a compressive normal component, then
/// limits the other components by it. A fixed point of steps along the relative velocity satisfies Coulomb's law
/// exactly, without dilation. `push`: unit normal towards side i.
template <class T, class Turn> GROUSER_HD Impulse<T, Turn>
cutToCoulomb(const Impulse<T, Turn>& z, const base::Vec3<T>& push, const ImpulseCone<T>& cone) {
  const T along = dot(z.linear, push);
  if (!(along > 0)) return {};
  const base::Vec3<T> shear = z.linear - push * along;
  return {push * along + cutTo(shear, cone.friction * along), cutTo(z.rolling, cone.arm * along)};
}

/// Projects an impulse onto the cone in the norm of `metric`: the convex relaxation (Anitescu 2006, Math. Program.
/// 105:113), in which a sliding contact separates at friction times its sliding speed. If other components exceed their
/// limits, the normal one is a weighted mean of its own value and the values that put these components at their limits.
template <class T, class Turn>
GROUSER_HD Impulse<T, Turn> projectOnCone(const Impulse<T, Turn>& z, const base::Vec3<T>& push,
                                          const ImpulseCone<T>& cone, const ImpulseMetric<T>& metric) {
  struct Limited {
    T size, slope, weight;
  };
  const T along = dot(z.linear, push);
  const base::Vec3<T> shear = z.linear - push * along;
  const Limited slides{lengthOf<T>(shear), cone.friction, metric.shear};
  const Limited rolls{lengthOf<T>(z.rolling), cone.arm, metric.rolling};
  // Start with the component that exceeds its limit more; the other component may then satisfy its own limit.
  const bool slidesFirst = slides.size * rolls.slope >= rolls.size * slides.slope;
  T asked = along, weights = 1, normal = along;
  for (int k = 0; k < 2; ++k) {
    const Limited& l = (k == 0) == slidesFirst ? slides : rolls;
    if (!(l.size > l.slope * normal)) continue;
    asked += l.weight * l.slope * l.size, weights += l.weight * l.slope * l.slope;
    normal = asked / weights;
  }
  if (!(normal > 0)) return {};
  return {push * normal + cutTo(shear, slides.slope * normal), cutTo(z.rolling, rolls.slope * normal)};
}

/// Returns the admissible impulse for `z`: clipped by Coulomb's law, or projected onto the cone.
template <class T, class Turn> GROUSER_HD Impulse<T, Turn> allowed(const Impulse<T, Turn>& z, const base::Vec3<T>& push,
                                                                   const ImpulseCone<T>& cone,
                                                                   const ImpulseMetric<T>& metric, bool associated) {
  return associated ? projectOnCone(z, push, cone, metric) : cutToCoulomb(z, push, cone);
}

} // namespace grouser::contact
