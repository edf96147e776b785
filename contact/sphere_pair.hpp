// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/moderate.hpp"

namespace grouser::contact {

/// Two overlapping spheres; with SIMD numbers, one pair per lane.
template <class T> struct SpherePair {
  base::Vec3<T> normal; ///< unit, from i to j
  T distance, overlap;  ///< distance of the centres; overlap of the surfaces [m]
};

/// Computes the overlap (D^2 - d^2) / (D + d) from exact integer squares, without cancellation. `apart`: from i to j;
/// `distance2` = d^2; `missing2` = D^2 - d^2; `reach` = D, the sum of the radii, common or per pair: all in units of
/// `unit` [m].
template <class T, class Reach> GROUSER_HD SpherePair<T> spherePair(const base::Vec3<T>& apart, const T& distance2,
                                                                    const T& missing2, const Reach& reach,
                                                                    base::ScalarOf<T> unit) {
  // distance2 is a whole number from 1 to about 2^60.
  const T distance = base::moderateRoot(distance2);
  return {apart * base::moderateInverse(distance), distance * unit,
          base::moderateQuotient(missing2, reach + distance) * unit};
}

} // namespace grouser::contact
