// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "contact/restitution.hpp"

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

/// Limits of the step, and what a mode of the system does to them.
namespace grouser::setup {

/// Steps [s] that a scene bears; infinite where nothing limits them.
struct StepLimit {
  /// The limit that one kind of contact sets.
  struct Bound {
    double step;      ///< [s]
    std::string what; ///< "shoe on rigid ground under a road wheel"
  };
  double step = std::numeric_limits<double>::infinity(); ///< up to which no contact gives energy; a run takes no longer
  std::string what;                                      ///< gives energy beyond it: "grain on the floor"
  std::string remedy;                                    ///< "lower its stiffness"
  /// Up to which every motion decays that sticking contacts make together. Between the two, strong dashpots let grains
  /// at rest tremble, by as much as Coulomb's limit and forces that only push allow.
  double calm = std::numeric_limits<double>::infinity();
  /// Duration of the shortest bounce of a body on a rigid surface or body [s].
  double bounce = std::numeric_limits<double>::infinity();
  std::vector<Bound> vehicle; ///< limits that contacts of the vehicle with itself and with rigid ground set
};

/// Keeps the smaller limit: of the mode x'' + damping x' + stiffness x = 0 [1/s, 1/s2].
inline void consider(StepLimit& limit, double stiffness, double damping, const std::string& what,
                     const std::string& remedy = "lower its stiffness") {
  if (stiffness <= 0 && damping <= 0) return;
  const double step = contact::stableStepOfMode(stiffness, damping);
  limit.vehicle.push_back({step, what});
  if (step < limit.step) limit.step = step, limit.what = what, limit.remedy = remedy;
}
inline void considerCalm(StepLimit& limit, double stiffness, double damping) {
  if (stiffness > 0 || damping > 0) limit.calm = std::min(limit.calm, contact::stableStepOfMode(stiffness, damping));
}

/// Of a mode that counts for both: nothing but forces on springs, unbounded.
inline void considerBoth(StepLimit& limit, double stiffness, double damping, const std::string& what,
                         const std::string& remedy) {
  consider(limit, stiffness, damping, what, remedy);
  considerCalm(limit, stiffness, damping);
}

} // namespace grouser::setup
