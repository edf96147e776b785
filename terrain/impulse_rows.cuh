// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "contact/impulse_law.hpp"
#include "terrain/grain_kernel_data.cuh"

/// What the kernels of complementarity contacts share: the rows of a step, and what of them changes in an iteration.
/// Both grains of a pair have a row of their own, with opposite impulses of the same bits, so that a grain sums its own
/// in the order of its neighbours' ids, and writes no others.
namespace grouser::terrain {

inline constexpr std::uint32_t kNobody = ~0u; ///< the other side of a row never moves

/// Constants of a row during a step.
template <class Real> struct ImpulseRowRecord {
  base::Vec3<Real> push;   ///< unit, towards the grain
  base::Vec3<Real> offset; ///< [m/s] velocities of what is prescribed are in it
  Real softness, shearSoftness;
  Real friction;
  Real armOwn, armOther; ///< from the centres to the point of contact [m]
  Real weight;           ///< of the metric: the step of the solver is its inverse [1/kg]
  Real mobility;         ///< inverse masses of both sides and softness [1/kg]: makes velocities of residuals
  std::uint32_t other;   ///< slot, or kNobody
  std::uint32_t place;   ///< in the grain's row of the neighbour list; the boundary; the highest bit: an impact
};
inline constexpr std::uint32_t kImpactBit = 1u << 31;

/// The same of rolling resistance.
template <class Real> struct RollingRowRecord {
  base::Vec3<Real> offset; ///< [rad/s]
  Real softness, arm, weight;
};

/// Used at the end of the step alone.
template <class Real> struct ImpulseRowEnd {
  Real overlap;               ///< at the start [m], < 0 where they are apart
  Real pull;                  ///< impulse of cohesion [N s]
  Real damping, shearDamping; ///< of the dashpots [N s/m]
};

/// Velocities of a grain within the iterations; as they are exchanged between ranks.
template <class Real> struct ImpulseMotion { base::Vec3<Real> velocity, spin; };

/// Rows of one kind, device arrays by place. Three generations of what changes, in turns: of the iteration, of the one
/// before, and what is tried.
template <class Real> struct ImpulseRowsView {
  ImpulseRowRecord<Real>* row;
  RollingRowRecord<Real>* rolling; ///< null without rolling resistance
  base::Vec3<Real>* impulse[3];    ///< [N s]
  base::Vec3<Real>* gradient[3];   ///< a of the complementarity problem [m/s]
  base::Vec3<Real>* turning[3];    ///< rolling impulse [N m s]; null without
  base::Vec3<Real>* turnGradient[3];
  ImpulseRowEnd<Real>* end;
};

/// Sums of an iteration over all rows, in whole quanta of two sizes, so that they have no order: a pair counts from
/// both sides.
enum ImpulseSum : int { kCurvature, kLength, kAgainst, kSquares, kContacts, kImpulseSums };
inline constexpr int kSumSizes = 2, kSumBanks = 64;
/// A contact counts 2 quanta: half of one from each side of a pair.
inline constexpr double kPerContact = 2;
/// Quanta of the small size to one of the large.
inline constexpr double kFinerSums = 0x1p40;

/// What kernels of one step take.
template <class Real> struct ImpulseData {
  contact::ImpulseRules<Real> rules;
  ImpulseRowsView<Real> grains; ///< places as in the neighbour list; the rows of a grain stand before others
  ImpulseRowsView<Real> bounds; ///< [row of the grain][place in the list of grains near boundaries]
  std::uint32_t* grainRows;     ///< by slot: rows with other grains
  std::uint32_t* boundRows;     ///< by place in the list near boundaries
  std::uint32_t* degree;        ///< by slot: all rows; of ghosts too
  std::int64_t near;            ///< grains listed near boundaries
  ImpulseMotion<Real>* free;    ///< by slot: at the end of the step without contacts
  ImpulseMotion<Real>* motion;  ///< by slot: with the impulses of this iteration; of ghosts too
  const std::uint32_t* ghost;   ///< by slot: not 0 for those of other ranks; null: none
  std::int64_t margin;          ///< no pair has a row whose gap is above this [units]
  std::int64_t leastMargin;     ///< all have whose gap is below this and what both move in the step [units]
  int now, before, tried;       ///< generations
  Real ahead, tau;              ///< momentum; curvature over that of the metric
  // Of surfaces that forces move.
  std::uint32_t* surfaceRows;  ///< [surface] its rows, of all ranks
  std::int64_t* surfacePushes; ///< [surface] of this rank's rows along its axis
  base::FixedPoint push;       ///< quanta of these [N s]
  const Real* surfaceChange;   ///< [surface] of its speed along its axis by all contacts [m/s]
  base::WideSum* sums;         ///< [kSumBanks][kImpulseSums][kSumSizes]
  double perEnergy, perSquare; ///< quanta of the large size
  std::uint32_t* worst;        ///< bits of the largest residual [m/s], a float
};

/// Calls each(rows, place) for the rows of a grain, in the order in which it sums them.
template <class Real, class Each>
GROUSER_HD void forRowsOf(const GrainKernelData& d, const ImpulseData<Real>& s, int i, const Each& each) {
  for (std::uint32_t k = 0; k < s.grainRows[i]; ++k) each(s.grains, d.neighbours.at(i, k));
  const std::uint32_t at = d.boundaryCount > 0 ? d.boundaryOf[i] : 0;
  if (at == 0) return;
  for (std::uint32_t k = 0; k < s.boundRows[at - 1]; ++k) each(s.bounds, std::int64_t{at} - 1 + k * s.near);
}

/// Of a grain's point of contact relative to that of the other side [m/s]; opposite, to the bit, from the other side.
template <class Real> GROUSER_HD base::Vec3<Real>
relativeVelocity(const ImpulseMotion<Real>& own, const ImpulseMotion<Real>& other, const ImpulseRowRecord<Real>& row) {
  return (own.velocity - other.velocity) - cross(own.spin * row.armOwn + other.spin * row.armOther, row.push);
}

/// The surface that a row at a boundary belongs to, where forces move it; else none.
template <class Real> GROUSER_HD const SurfacePose*
freeSurface(const GrainKernelData& d, const ImpulseRowRecord<Real>& row, bool atBoundary, int& surface) {
  surface = static_cast<int>(row.place & ~kImpactBit) - (d.boundaryCount - d.surfaceCount);
  if (!atBoundary || surface < 0 || !(d.placements[surface].inverseMass > 0)) return nullptr;
  return d.placements + surface;
}

/// Whether a slot's grain has no rows of its own.
template <class Real> GROUSER_HD bool hasNoRows(const GrainKernelData& d, const ImpulseData<Real>& s, int i) {
  return (s.ghost && s.ghost[i] != 0) || ((d.features & kFixed) && isFixed(d.motion[i].velocity));
}

template <class Real>
GROUSER_HD contact::Impulse<Real> impulseAt(const ImpulseRowsView<Real>& rows, int generation, std::int64_t at) {
  return {rows.impulse[generation][at], rows.rolling ? rows.turning[generation][at] : base::Vec3<Real>{}};
}
template <class Real>
GROUSER_HD contact::Impulse<Real> gradientAt(const ImpulseRowsView<Real>& rows, int generation, std::int64_t at) {
  return {rows.gradient[generation][at], rows.rolling ? rows.turnGradient[generation][at] : base::Vec3<Real>{}};
}

} // namespace grouser::terrain
