// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/fixed_point.hpp"
#include "base/vec.hpp"

namespace grouser::contact {

/// Contact of extended surfaces: an elastic foundation (Winkler) with relaxation, so that the force does not depend on
/// how finely a part was cut into spheres.
///
///   pressure = modulus (overlap + relaxation * closing speed), never pulling
///   friction = -k_t shear - relaxation k_t slip on each patch, k_t = ratio * modulus * area, within Coulomb's cone
struct PatchLaw {
  double modulus{};         ///< [N/m3], > 0
  double relaxation{};      ///< [s], >= 0
  double friction{};        ///< [-], >= 0
  double tangentialRatio{}; ///< [-], >= 0
};

/// Quanta of the sums over samples, from the scene alone.
struct PatchQuanta {
  base::FixedPoint force, torque, energy, area, moment; ///< [N], [N m], [J], [m2], [N m] of weighted places
};

/// Sums over the samples of one patch in one step, in quanta; free of order.
struct PatchSums {
  std::int64_t area, weight; ///< touching area; sum of the normal forces' sizes
  base::Vec3l place;         ///< sum of size * (place - centre of part A)
  base::Vec3l normalForce;   ///< on A
  std::int64_t elastic, dissipated;
};

/// What a patch remembers: the tangential spring in world axes.
struct PatchState {
  base::Vec3d shear; ///< [m]
  double stiffness;  ///< k_t that goes with it [N/m]: it follows the touching area
  double dissipated; ///< [J] since the start
};

} // namespace grouser::contact
