// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/fixed_point.hpp"
#include "base/position.hpp"
#include "contact/linear_law.hpp"
#include "terrain/height_field.hpp"

#include <cstdint>
#include <vector>

namespace grouser::terrain {

/// A rigid plane that fills the half-space behind its normal.
struct Wall {
  base::Vec3d normal;     ///< unit, towards the grains
  double offset{};        ///< normal . x = offset on the plane [m]
  contact::LinearLaw law; ///< between grain and plane
};

/// Constants of a bed of equal spheres. Kernels take a copy.
struct GrainModel {
  double radius{};             ///< [m]
  double mass{};               ///< [kg]
  double timeStep{};           ///< [s]
  base::Vec3d gravity;         ///< [m/s2]
  contact::LinearLaw law;      ///< grain on grain
  contact::LinearLaw floorLaw; ///< grain on the height-field floor, where there is one
  double skin{0.3};            ///< of the neighbour list, as a share of the radius [-]
  double maxOverlap{0.2};      ///< as a share of the radius [-]; more stops the run
  bool ledger{true};           ///< whether dissipation is summed grain by grain

  bool frictional() const { return law.friction > 0; }
};

/// Energies [J] and counts of the grains at one instant, from state functions; sums are order-free.
struct GrainLedger {
  double kinetic{}, rotational{}, potential{}, elastic{}, dissipated{};
  base::Vec3d momentum;            ///< [kg m/s]
  std::int64_t contacts{};         ///< pairs of grains in touch
  std::int64_t boundaryContacts{}; ///< grains in touch with walls and floor
  double deepestOverlap{};         ///< [m]
  double fastest{};                ///< [m/s]
};

} // namespace grouser::terrain
