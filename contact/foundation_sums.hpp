// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "contact/patch_lanes.hpp"

/// Elastic foundation of a patch, per unit modulus, for contacts that are damped as a whole (whole_contact.hpp).
namespace grouser::contact {

/// Sums over the points of a patch. x: position halfway through the overlap; n: outward unit normal of B; o: rate at
/// which the overlap of a point decreases; areas with a rocking share are flat in at least one direction.
template <class T> struct FoundationSumsOf {
  T area, pressed;                 ///< area [m2]; area x overlap [m3]
  base::Vec3<T> place;             ///< area x overlap x position [m4]
  base::Vec3<T> force, torque;     ///< area x overlap x n [m3], about the reference point [m4]
  T squared, deepest;              ///< area x overlap^2 [m4]; largest overlap [m]
  T rocking;                       ///< rocking area [m2]
  base::Vec3<T> normals, turns;    ///< rocking area x n, and x (position x n)
  base::Vec3<T> rated, ratedTurns; ///< rocking area x o x n, and x o x (position x n)

  GROUSER_SIMD FoundationSumsOf& operator+=(const FoundationSumsOf& b) {
    area += b.area, pressed += b.pressed, place += b.place, force += b.force, torque += b.torque;
    squared += b.squared, deepest = deepest > b.deepest ? deepest : b.deepest;
    rocking += b.rocking, normals += b.normals, turns += b.turns, rated += b.rated, ratedTurns += b.ratedTurns;
    return *this;
  }
};
using FoundationSums = FoundationSumsOf<double>;

/// Motion and shape of a patch's part, in the part frame.
struct FoundationPress {
  RelativeMotion<double> motion; ///< without the spin of a round part about its own axis
  double flatWithin;             ///< points with |z| up to this height have a rocking share [m]; < 0: none
};

struct FoundationLanes : FoundationSumsOf<PointLanes> {
  GROUSER_SIMD void clear() {
    const PointLanes none = allLanes(0);
    const Vec3P zero{none, none, none};
    area = pressed = squared = deepest = rocking = none;
    place = force = torque = normals = turns = rated = ratedTurns = zero;
  }

  /// Adds the elastic part of one point per lane, except force and torque. Returns area x overlap.
  GROUSER_SIMD PointLanes addElastic(const Vec3P& x, const PointLanes& overlap, const PointLanes& touching) {
    const PointLanes volume = touching * overlap;
    area += touching, pressed += volume, place += x * volume;
    squared += volume * overlap, deepest = greater(deepest, touching > allLanes(0) ? overlap : allLanes(0));
    return volume;
  }

  GROUSER_SIMD static double over(const PointLanes& v) {
    return ((v[0] + v[1]) + (v[2] + v[3])) + ((v[4] + v[5]) + (v[6] + v[7]));
  }
  /// Sum over all lanes.
  GROUSER_SIMD FoundationSums sum() const {
    const auto of = [](const Vec3P& v) { return base::Vec3d{over(v.x), over(v.y), over(v.z)}; };
    double most = 0;
    for (int l = 0; l < kPointLanes; ++l) most = deepest[l] > most ? deepest[l] : most;
    return {over(area), over(pressed), of(place),   of(force), of(torque), over(squared),
            most,       over(rocking), of(normals), of(turns), of(rated),  of(ratedTurns)};
  }
};

} // namespace grouser::contact
