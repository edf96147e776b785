// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/vec.hpp"
#include "contact/neighbour_view.hpp"
#include "fluid/fluid_constants.hpp"
#include "fluid/fluid_setup.hpp"
#include "fluid/fluid_state.hpp"

#include <cstdint>

namespace grouser::fluid {

/// Velocity and compression in double precision; neighbours use rounded values.
struct alignas(32) PreciseMotion {
  base::Vec3d velocity; ///< [m/s]
  double compression;   ///< s = rho/rho0 - 1 [-]
};

/// Compression changes in a step [-]: by flow, and by density diffusion.
struct CompressionChange {
  double flow, diffusion;
  double limit; ///< maximum compression [-]; lower beside bodies that touch other bodies
};

/// Fluid load on a body about its frame origin: exact sums, in quanta of acceleration x particle mass, and of that
/// times spacing.
struct BodyLoadQuanta {
  base::Vec3l force, torque;
};

/// Neighbour rows. Row i of a particle contains fluid neighbours, followed from place fluidCount[i] by wall markers.
/// Row particles + m of marker m contains fluid neighbours.
struct FluidRows : contact::NeighbourRows {
  const std::uint32_t *count, *fluidCount, *slot;
};

/// Flags of a step, raised by any thread.
struct FluidFlags {
  std::uint64_t fault;     ///< FluidFault << 32 | id, the minimum of all; kNoFault if there is none
  std::uint32_t listEnded; ///< the next step would move a particle beyond half the skin
  std::uint32_t fastest;   ///< maximum squared speed, as bits of a float [m2/s2]
};
inline constexpr std::uint64_t kNoFault = ~std::uint64_t{0};
enum class FluidFault : std::uint32_t { speed, compression, displacement, range };

/// Kernel view of the device arrays of a fluid. Slots: particles first, then markers.
struct FluidView {
  FluidConstants constants;
  double timeStep;                 ///< [s]
  base::Vec3d gravity;             ///< [m/s2]
  double attraction;               ///< [1/s2]
  std::uint32_t particles;         ///< slots of fluid
  base::Position* position;        ///< [particles + markers]
  base::Vec4f* motion;             ///< [particles + markers] velocity [m/s]; w: compression, in force sums stress()
  PreciseMotion* precise;          ///< [particles]
  base::Vec3l* force;              ///< [particles] sum of pair terms, quanta of acceleration
  CompressionChange* change;       ///< [particles]
  Losses* losses;                  ///< [particles]
  base::Vec3d* shift;              ///< [particles] gradient of concentration [1/m]; null without shifting
  float* divergence;               ///< [particles] div r [-]; null without shifting
  base::Vec3f* ghostVelocity;      ///< [markers] velocity for viscosity [m/s]; null without laminar viscosity
  base::Vec3l* markerForce;        ///< [markers] force of the fluid, quanta of acceleration x particle mass
  const std::uint32_t* id;         ///< [particles]
  const base::Position* reference; ///< [particles] positions when the lists were built
  std::uint32_t fixedMarkers;      ///< number of fixed markers; markers of bodies follow
  const BodyMotion* body;          ///< [bodies]
  const std::uint32_t* bodyOf;     ///< [markers of bodies] index of the body
  const float* bodyContact;        ///< [bodies] distance below which markers repel [m]; 0 for bodies that touch others
  const base::Vec3d* bodyPoint;    ///< [markers of bodies] position in the body frame [m]
  BodyLoadQuanta* bodyLoad;        ///< [bodies]
  FluidRows rows;
  FluidFlags* flags;
  const std::uint32_t* ghost; ///< [particles] nonzero for copies integrated by another rank; null on a single rank

  /// Distance below which a marker repels [m].
  GROUSER_HD float contactOf(std::uint32_t marker) const {
    return marker < fixedMarkers ? constants.contact : bodyContact[bodyOf[marker - fixedMarkers]];
  }
  GROUSER_HD bool isGhost(std::uint32_t i) const { return ghost && ghost[i] != 0; }
  GROUSER_HD bool isGhost(int i) const { return isGhost(static_cast<std::uint32_t>(i)); }
};

} // namespace grouser::fluid
