// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/vec.hpp"

#include <limits>

namespace grouser::coupling {

/// Constants of a prescribed motion; see SurfaceMotion.
struct SurfaceMotionLaw {
  base::Vec3d pivot;                                     ///< [m] centre of rotation
  base::Vec3d velocity, spin, amplitude;                 ///< [m/s], [rad/s], [m]
  double frequency{}, phase{};                           ///< [Hz], [turns]
  double start{};                                        ///< [s]
  double until{std::numeric_limits<double>::infinity()}; ///< [s]
};

/// Prescribed motion of a rigid surface: closed functions of time, so that errors do not accumulate and resumed runs
/// are bitwise identical.
///
/// With s the time since `start`, constant after `until`:
///   pivot(s) = pivot + velocity s + amplitude (sin(2 pi frequency s + phase) - sin(phase))
///   turn(s)  = |spin| s about spin,   centre(s) = pivot(s) + turn(s) (centre - pivot)
class SurfaceMotion {
public:
  SurfaceMotion() = default; ///< at rest at the origin
  SurfaceMotion(const SurfaceMotionLaw& law, const base::Vec3d& centre) : law_(law), arm_(centre - law.pivot) {}

  struct State {
    base::Vec3d centre;         ///< [m]
    base::Quat turned;          ///< rotation since the start
    base::Vec3d velocity, spin; ///< velocity of the centre [m/s], angular velocity [rad/s]
    base::Vec3d pivot;          ///< [m]
  };
  State at(double time) const;
  void lift(double way) { law_.pivot.z += way; } ///< raises the whole motion [m]

private:
  SurfaceMotionLaw law_;
  base::Vec3d arm_; ///< vector from the pivot to the initial centre [m]
};

} // namespace grouser::coupling
