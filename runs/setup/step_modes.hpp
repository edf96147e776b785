// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "contact/restitution.hpp"

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

/// Time step limits, and the modes of vibration that set them.
namespace grouser::setup {

/// Time step limits of a scene [s]; infinite without a limit.
struct StepLimit {
  /// Limit of one kind of contact.
  struct Bound {
    double step;      ///< [s]
    std::string what; ///< "shoe on rigid ground under a road wheel"
  };
  double step = std::numeric_limits<double>::infinity(); ///< longest step at which no contact creates energy
  std::string what;                                      ///< contact that sets this limit: "grain on the floor"
  std::string remedy;                                    ///< "lower its stiffness"
  /// Longest step at which all modes of sticking contacts decay. Between calm and step, strong dashpots make grains at
  /// rest vibrate within the limits of Coulomb friction and of contacts without tension.
  double calm = std::numeric_limits<double>::infinity();
  /// Shortest duration of a body's impact on a rigid surface or body [s].
  double bounce = std::numeric_limits<double>::infinity();
  std::vector<Bound> vehicle; ///< limits of the vehicle's contacts within its running gear and with the ground
};

/// Lowers limit.step to the stable step of the mode x'' + damping x' + stiffness x = 0 (units: 1/s2, 1/s).
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

/// Lowers both limits, step and calm, for a mode of linear springs with unbounded forces.
inline void considerBoth(StepLimit& limit, double stiffness, double damping, const std::string& what,
                         const std::string& remedy) {
  consider(limit, stiffness, damping, what, remedy);
  considerCalm(limit, stiffness, damping);
}

} // namespace grouser::setup
