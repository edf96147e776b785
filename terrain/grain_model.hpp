// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/fixed_point.hpp"
#include "base/position.hpp"
#include "contact/impulse_law.hpp"
#include "terrain/height_field.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace grouser::terrain {

/// Features of a scene of grains besides those of contact laws; a template parameter of its kernels.
inline constexpr unsigned kManyRadii = contact::kManyMasses; ///< each grain its own radius, in velocity.w, and mass
inline constexpr unsigned kManyMaterials = 1u << 8; ///< each grain its own material, in spin.w; implies kManyRadii
inline constexpr unsigned kBoundaries = 1u << 9;    ///< walls or floor
inline constexpr unsigned kLoads = 1u << 10;        ///< loads from rigid parts
inline constexpr unsigned kLedger = 1u << 11;       ///< energy accounting
inline constexpr unsigned kPeriodic = 1u << 12;     ///< periodic boundaries along x or y
inline constexpr unsigned kSurfaces = 1u << 13;     ///< rigid surfaces that may move; implies kBoundaries
inline constexpr unsigned kFloor = 1u << 14;        ///< a height-field floor; implies kBoundaries
inline constexpr unsigned kFixed = 1u << 15;        ///< some grains never move: velocity.w < 0 marks them

/// A rigid plane that fills the half-space behind its normal.
struct Wall {
  base::Vec3d normal;      ///< unit, towards the grains
  double offset{};         ///< normal . x = offset on the plane [m]
  contact::ContactLaw law; ///< between grain and plane
};

/// Densities and laws of grains of several materials; empty for one material.
struct GrainMaterials {
  std::vector<double> density;                 ///< [materials] [kg/m3]
  std::vector<contact::ContactLaw> grains;     ///< [materials][materials], symmetric
  std::vector<contact::ContactLaw> boundaries; ///< [walls, floor, surfaces][materials]

  std::size_t count() const { return density.size(); }
};

/// Precision of the forces. Both give the same bits on every device, for any number of threads and ranks. The state is
/// the same for both: positions in whole units of about 1e-8 of a diameter, velocities and spins as float plus
/// remainder, springs of contacts as float. In double nothing more is rounded to float between the state and its
/// change: laws, normals, overlaps, lever arms and sums; the forces of rigid parts are integers in both.
enum class Precision { single, double_ };

/// Constants of a bed of spheres. Kernels take a copy.
struct GrainModel {
  double radius{};               ///< of the largest grain [m]
  double smallestRadius{0};      ///< including grains that may enter later [m]; 0: as the grains at the start
  double mass{};                 ///< of the largest grain [kg]
  double timeStep{};             ///< [s]
  base::Vec3d gravity;           ///< [m/s2]
  contact::ContactLaw law;       ///< grain on grain
  contact::ContactLaw floorLaw;  ///< grain on the height-field floor, where there is one
  double skin{0.3};              ///< of the neighbour list, as a share of the smallest grain's radius [-]
  double maxOverlap{0.5};        ///< of two grains, as a share of either's radius [-]; more stops the run
  double maxSurfaceOverlap{0.8}; ///< the same with walls, floor and surfaces; with parts it is 1
  double maxEntryOverlap{0.2};   ///< of grains that enter [-]
  bool fixedGrains{false};       ///< whether some grains are fixed: those at the start say so too
  bool ledger{true};             ///< whether work and dissipation are accounted for
  /// Options of complementarity contacts; empty: penalty contacts.
  std::optional<contact::ComplementarityOptions> complementarity;
  GrainMaterials materials; ///< instead of law, floorLaw and the walls' laws where grains are of several
  Precision precision{Precision::single};
  bool specialised{true}; ///< false: always the general kernel; same bits, for tests
  /// Maximum allowed displacement of a grain per step, as a fraction of the smallest radius [-]: with penalty contacts,
  /// half the skin, so that no contact is missed.
  double mostWay() const { return complementarity ? kMostWaySolved : 0.5 * skin; }
  static constexpr double kMostWaySolved = 0.4;
  int mostSimdLanes{16}; ///< largest number of SIMD lanes on a CPU: 16, 8, 4, 1; same bits, for tests
};

/// State functions of the grains at one instant, and their energy accounting since the start; sums are order-free.
struct GrainLedger {
  double kinetic{}, rotational{}, potential{}, elastic{}; ///< now [J]
  double damped{}, rubbed{},
      rolled{};        ///< dissipated by dashpots, sliding and rolling resistance [J]; 0 without a ledger
  double slipped{};    ///< the same by springs of Hertz contacts as their stiffness changes [J]
  double yielded{};    ///< the same by plastic work of contacts [J]
  double stabilised{}; ///< added by complementarity contacts that push overlaps apart [J]
  double dissipated() const { return damped + rubbed + rolled + slipped + yielded - stabilised; }
  double work{};                       ///< of all forces on the grains [J]: gain of kinetic and rotational energy
  double turnover{};                   ///< sum of its magnitudes per grain and step [J]
  base::Vec3d momentum;                ///< now [kg m/s]
  base::Vec3d angularMomentum;         ///< now, about the origin of the world [kg m2/s]
  base::Vec3d impulse, angularImpulse; ///< by gravity, walls and floor [N s], [N m s about the origin]
  std::int64_t contacts{};             ///< pairs of grains in touch
  std::int64_t boundaryContacts{};     ///< grains in touch with walls, floor and surfaces
  std::int64_t squeezed{};             ///< pairs of grains deeper than contact::kSqueezed
  std::int64_t squeezedAtBoundaries{}; ///< the same with walls, floor and surfaces
  double deepestOverlap{};             ///< [m]
  double fastest{};                    ///< [m/s]
};

} // namespace grouser::terrain
