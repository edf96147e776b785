// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/vec.hpp"
#include "contact/neighbour_view.hpp"
#include "fluid/fluid_constants.hpp"
#include "fluid/fluid_setup.hpp"
#include "fluid/fluid_state.hpp"

#include <cstdint>

namespace grouser::fluid {

/// Velocity and compression in double precision; neighbours read them rounded.
struct alignas(32) PreciseMotion {
  base::Vec3d velocity; ///< [m/s]
  double compression;   ///< s = rho/rho0 - 1 [-]
};

/// Changes of compression in a step [-]: by flow, and by density diffusion.
struct CompressionChange {
  double flow, diffusion;
  double limit; ///< greatest compression, lower beside bodies that touch others [-]
};

/// Load of the fluid on a body about its frame's origin: exact sums, in quanta of acceleration x particle mass, and of
/// that x spacing.
struct BodyLoadQuanta {
  base::Vec3l force, torque;
};

/// Neighbour rows. Row i of a particle holds fluid neighbours, and from place fluidCount[i] on markers of walls. Row
/// particles + m of marker m holds fluid neighbours.
struct FluidRows : contact::NeighbourRows {
  const std::uint32_t *count, *fluidCount, *slot;
};

/// Flags of a step, raised by any thread.
struct FluidFlags {
  std::uint64_t fault;     ///< FluidFault << 32 | id, the least of all; kNoFault without one
  std::uint32_t listEnded; ///< the next step would bring a particle beyond half the skin
  std::uint32_t fastest;   ///< bits of the greatest squared speed as a float [m2/s2]
};
inline constexpr std::uint64_t kNoFault = ~std::uint64_t{0};
enum class FluidFault : std::uint32_t { speed, compression, displacement, range };

/// Device arrays of a fluid, for its kernels. Slots: particles first, markers behind them.
struct FluidView {
  FluidConstants constants;
  double timeStep;                 ///< [s]
  base::Vec3d gravity;             ///< [m/s2]
  double attraction;               ///< [1/s2]
  std::uint32_t particles;         ///< slots of fluid
  base::Position* position;        ///< [particles + markers]
  base::Vec4f* motion;             ///< [particles + markers] velocity [m/s]; w: compression, stress() in sums of forces
  PreciseMotion* precise;          ///< [particles]
  base::Vec3l* force;              ///< [particles] sum of pair terms, quanta of acceleration
  CompressionChange* change;       ///< [particles]
  Losses* losses;                  ///< [particles]
  base::Vec3d* shift;              ///< [particles] gradient of concentration [1/m]; null without shifting
  float* divergence;               ///< [particles] div r [-]; null without shifting
  base::Vec3f* ghostVelocity;      ///< [markers] velocity for viscosity [m/s]; null without laminar viscosity
  base::Vec3l* markerForce;        ///< [markers] force of the fluid, quanta of acceleration x particle mass
  const std::uint32_t* id;         ///< [particles]
  const base::Position* reference; ///< [particles] places when the lists were made
  std::uint32_t fixedMarkers;      ///< markers of bodies lie behind them
  const BodyMotion* body;          ///< [bodies]
  const std::uint32_t* bodyOf;     ///< [markers of bodies] index of the body
  const float* bodyContact;        ///< [bodies] distance within which markers repel [m]; 0 for bodies that touch others
  const base::Vec3d* bodyPoint;    ///< [markers of bodies] place in the body's frame [m]
  BodyLoadQuanta* bodyLoad;        ///< [bodies]
  FluidRows rows;
  FluidFlags* flags;
  const std::uint32_t* ghost; ///< [particles] not 0 for copies of what another rank integrates; null on one rank

  /// Distance within which a marker repels [m].
  GROUSER_HD float contactOf(std::uint32_t marker) const {
    return marker < fixedMarkers ? constants.contact : bodyContact[bodyOf[marker - fixedMarkers]];
  }
  GROUSER_HD bool isGhost(std::uint32_t i) const { return ghost && ghost[i] != 0; }
  GROUSER_HD bool isGhost(int i) const { return isGhost(static_cast<std::uint32_t>(i)); }
};

} // namespace grouser::fluid
