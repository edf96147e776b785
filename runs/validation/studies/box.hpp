// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "terrain/grains.hpp"

#include <cstdint>

namespace grouser::studies {

/// A box of equal spheres, open or closed at the top, filled by a jittered lattice with random velocities. The grains
/// are those of the source paper: radius 27 mm, 2500 kg/m3, 1e6 N/m, step 5e-5 s (20 steps per contact).
struct StudyBox {
  std::int64_t grains = 2000;
  int layers = 10;
  double spacing = 2.2;     ///< lattice spacing [radii]
  double speed = 0.5;       ///< maximum initial velocity component [m/s]
  double gravity = 9.81;    ///< downward gravity [m/s2]; 0: the box has a lid
  double restitution = 0.5; ///< [-]
  double friction = 0.5;    ///< [-]
  int shaken = 0;           ///< maximum initial displacement per axis [units of length]
  std::uint64_t seed = 0;   ///< seed of the initial displacements
  terrain::Precision precision = terrain::Precision::single;

  static constexpr double kRadius = 0.027, kDensity = 2500, kStiffness = 1e6, kTimeStep = 5e-5;
};
terrain::Grains fill(const StudyBox& box, const base::Exec& exec);

/// studyBoxScale(): unit of length of the positions, as in Grains. studyBoxDiameter(): grain diameter in this unit.
base::PositionScale studyBoxScale();
std::int64_t studyBoxDiameter();

} // namespace grouser::studies
