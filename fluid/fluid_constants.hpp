// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/fixed_point.hpp"
#include "base/period.hpp"
#include "base/position.hpp"
#include "fluid/fluid_setup.hpp"

namespace grouser::fluid {

/// Constants of the kernels in single precision, and quanta of the integer sums. Pair terms are rounded to 32-bit
/// integers, so that sums are order-independent and opposite terms cancel exactly.
struct FluidConstants {
  base::PositionScale scale;
  base::Period period;
  float metresPerUnit{};
  float perLength{};               ///< 1/h [1/m]
  float slope{};                   ///< V0 F(0) [1/m2]
  float eta2{};                    ///< (h/10)^2 [m2]
  float sound2{};                  ///< c^2 [m2/s2]
  float artificial{};              ///< alpha h c [m2/s]
  float laminar{};                 ///< twice the kinematic viscosity [m2/s]
  float central{};                 ///< factor d + 2 of the central operator; 0: Morris operator [-]
  float contact{};                 ///< distance below which markers repel particles [m]
  float diffusion{};               ///< -2 delta h c [m2/s]
  base::Vec3f gravityOverSound2{}; ///< [1/m]
  float shiftSeed{};               ///< 0.2/W(spacing)^4, in units of W(0) [-]

  base::FixedPoint rate;                               ///< ds/dt [1/s]
  base::FixedPoint acceleration;                       ///< [m/s2]
  base::FixedPoint power;                              ///< per mass [W/kg]
  base::FixedPoint weight, compression, moment, speed; ///< sums of a marker: W/W(0) [-], times s [-], r [m], v [m/s]
  base::FixedPoint gradient, divergence;               ///< shifting: V grad W [1/m], V r.grad W [-]

  double greatestSpeed{}; ///< [m/s]
  double lowest{};        ///< height below which a particle has left the walls [m]; minus infinity: no limit
};

FluidConstants fluidConstants(const FluidSetup& setup);

} // namespace grouser::fluid
