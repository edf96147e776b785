// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "terrain/grains.hpp"

#include <cstdint>

namespace grouser::studies {

/// A box of equal spheres for studies, open at the top or closed: a jittered lattice with random velocities, of the
/// source paper's grains (radius 27 mm, 2500 kg/m3, 1e6 N/m, 5e-5 s: 20 steps a contact).
struct StudyBox {
  std::int64_t grains = 2000;
  int layers = 10;
  double spacing = 2.2;     ///< of the lattice [radii]
  double speed = 0.5;       ///< largest of each component at the start [m/s]
  double gravity = 9.81;    ///< downwards [m/s2]; 0: the box has a lid
  double restitution = 0.5; ///< [-]
  double friction = 0.5;    ///< [-]
  int shaken = 0;           ///< each grain starts up to so many units of length aside, along each axis
  std::uint64_t seed = 0;   ///< of that shaking
  terrain::Precision precision = terrain::Precision::single;

  static constexpr double kRadius = 0.027, kDensity = 2500, kStiffness = 1e6, kTimeStep = 5e-5;
};
terrain::Grains fill(const StudyBox& box, const base::Exec& exec);

/// Units of length of its positions, and the diameter in them, as Grains has it.
base::PositionScale studyBoxScale();
std::int64_t studyBoxDiameter();

} // namespace grouser::studies
