// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/vec.hpp"
#include "runs/scene/surface_sections.hpp"

namespace grouser::setup {

/// How a rigid surface is moved: closed functions of time, so that nothing adds up and a resumed run has the same bits.
///
/// With s the time since `start`, held at `until`:
///   pivot(s) = pivot + velocity s + amplitude (sin(2 pi frequency s + phase) - sin(phase))
///   turn(s)  = |spin| s about spin,   centre(s) = pivot(s) + turn(s) (centre - pivot)
class SurfaceMotion {
public:
  SurfaceMotion(const scene::SurfaceSection& section, const base::Vec3d& centre);

  struct State {
    base::Vec3d centre;         ///< [m]
    base::Quat turned;          ///< since the start
    base::Vec3d velocity, spin; ///< of the centre [m/s], [rad/s]
  };
  State at(double time) const;

private:
  base::Vec3d pivot_, arm_, velocity_, spin_, amplitude_;
  double frequency_, phase_, start_, until_;
};

} // namespace grouser::setup
