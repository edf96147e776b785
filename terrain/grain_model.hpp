// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/fixed_point.hpp"
#include "base/position.hpp"
#include "contact/complementarity_options.hpp"
#include "contact/contact_law.hpp"
#include "terrain/height_field.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace grouser::terrain {

/// Features of a scene besides those of contact laws; a template parameter of its kernels.
inline constexpr unsigned kManyRadii = contact::kManyMasses; ///< individual radii, in velocity.w, and masses
inline constexpr unsigned kManyMaterials = 1u << 8;          ///< individual materials, in spin.w; implies kManyRadii
inline constexpr unsigned kBoundaries = 1u << 9;             ///< walls or floor
inline constexpr unsigned kLoads = 1u << 10;                 ///< loads from rigid parts
inline constexpr unsigned kLedger = 1u << 11;                ///< energy accounting
inline constexpr unsigned kPeriodic = 1u << 12;              ///< periodic boundaries along x or y
inline constexpr unsigned kSurfaces = 1u << 13;              ///< rigid surfaces that may move; implies kBoundaries
inline constexpr unsigned kFloor = 1u << 14;                 ///< a height-field floor; implies kBoundaries
inline constexpr unsigned kFixed = 1u << 15;                 ///< some grains are fixed, marked by velocity.w < 0

/// Rigid plane; the half-space behind its normal is solid.
struct Wall {
  base::Vec3d normal;      ///< unit, towards the grains
  double offset{};         ///< normal . x = offset on the plane [m]
  contact::ContactLaw law; ///< grain-wall law
};

/// Densities and laws of grains of several materials; empty for a single material.
struct GrainMaterials {
  std::vector<double> density;                 ///< [materials] [kg/m3]
  std::vector<contact::ContactLaw> grains;     ///< [materials][materials], symmetric
  std::vector<contact::ContactLaw> boundaries; ///< [walls, floor, surfaces][materials]

  std::size_t count() const { return density.size(); }
};

/// Precision of the forces. In either precision, results are bitwise identical on every device, for any number of
/// threads and ranks. The state has the same format in both: positions in whole units of about 1e-8 of a diameter,
/// velocities and spins as float plus remainder, contact springs as float. In double, no intermediate value (laws,
/// normals, overlaps, lever arms, sums) is rounded to float; the forces of rigid parts are integers in both.
enum class Precision { single, double_ };

/// Constants of a bed of spheres, copied to kernels.
struct GrainModel {
  double radius{};               ///< radius of the largest grain [m]
  double smallestRadius{0};      ///< minimum radius, including grains that enter later [m]; 0: radius of initial grains
  double mass{};                 ///< mass of the largest grain [kg]
  double timeStep{};             ///< [s]
  base::Vec3d gravity;           ///< [m/s2]
  contact::ContactLaw law;       ///< grain-grain law
  contact::ContactLaw floorLaw;  ///< law between grains and the height-field floor, if there is one
  double skin{0.3};              ///< skin of the neighbour list / smallest radius [-]
  double maxOverlap{0.5};        ///< maximum overlap of two grains / either radius [-]; a larger one stops the run
  double maxSurfaceOverlap{0.8}; ///< same limit for walls, floor and surfaces; for parts: 1
  double maxEntryOverlap{0.2};   ///< maximum allowed overlap of entering grains / smaller radius [-]
  bool fixedGrains{false};       ///< true if some grains are fixed; a fixed initial grain also sets it
  bool ledger{true};             ///< true: work and dissipation are accounted for
  /// Options of complementarity contacts; empty: penalty contacts.
  std::optional<contact::ComplementarityOptions> complementarity;
  GrainMaterials materials; ///< replaces law, floorLaw and the walls' laws for grains of several materials
  Precision precision{Precision::single};
  bool specialised{true}; ///< false: always the general kernel; same results, for tests
  /// Maximum displacement of a grain per step / smallest radius [-]: with penalty contacts half the skin, so that no
  /// contact is missed.
  double maxWay() const { return complementarity ? kMaxWaySolved : 0.5 * skin; }
  static constexpr double kMaxWaySolved = 0.4;
  int maxSimdLanes{16}; ///< maximum number of SIMD lanes on a CPU: 16, 8, 4, 1; same results, for tests
};

/// Current state functions of the grains, and their energy accounting since the start; all sums are order-independent.
struct GrainLedger {
  double kinetic{}, rotational{}, potential{}, elastic{}; ///< current values [J]
  double damped{}, rubbed{},
      rolled{};        ///< dissipated by dashpots, sliding and rolling resistance [J]; 0 without a ledger
  double slipped{};    ///< dissipated by springs of Hertz contacts as their stiffness changes [J]
  double yielded{};    ///< dissipated by plastic work of contacts [J]
  double stabilised{}; ///< added by complementarity contacts that separate overlaps [J]
  double dissipated() const { return damped + rubbed + rolled + slipped + yielded - stabilised; }
  double work{};                       ///< work of all forces on the grains [J]: kinetic and rotational energy gain
  double turnover{};                   ///< sum of |work| per grain and step [J]
  base::Vec3d momentum;                ///< current value [kg m/s]
  base::Vec3d angularMomentum;         ///< current value, about the world origin [kg m2/s]
  base::Vec3d impulse, angularImpulse; ///< impulse of gravity, walls and floor [N s], [N m s] about the world origin
  std::int64_t contacts{};             ///< grain-grain contacts
  std::int64_t boundaryContacts{};     ///< contacts of grains with walls, floor and surfaces
  std::int64_t squeezed{};             ///< grain-grain contacts with an overlap above contact::kDeepOverlap
  std::int64_t deepAtBoundaries{};     ///< same for walls, floor and surfaces
  double deepestOverlap{};             ///< [m]
  double fastest{};                    ///< [m/s]
};

} // namespace grouser::terrain
