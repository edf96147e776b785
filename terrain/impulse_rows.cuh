// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "contact/body_response.hpp"
#include "contact/impulse_law.hpp"
#include "contact/part_patches.cuh"
#include "terrain/grain_kernel_data.cuh"
#include "terrain/impulse_control.hpp"

#include <cstring>
#include <type_traits>

/// Rows of the complementarity problem of a step, as seen by its kernels. Each grain of a pair has its own row, with
/// opposite impulses that are bitwise equal: a grain sums its rows in the order of its neighbours' ids, and writes only
/// its own rows.
namespace grouser::terrain {

inline constexpr std::uint32_t kFixedPartner = ~0u; ///< denotes a wall, floor, surface or fixed grain

/// Constants of a row during a step that every kernel of an iteration reads.
template <class Real> struct alignas(16) ImpulseRowRecord {
  base::Vec3<Real> push; ///< unit normal towards the grain
  Real armOwn;           ///< distance from the grain's centre to the contact point [m]
  Real softness, shearSoftness;
  Real friction;
  Real signedWeight; ///< see weight(); negative if the other side of the pair contributes to the sums

  /// Weight in the metric, the inverse of the step size [1/kg].
  GROUSER_HD Real weight() const { return counts() ? signedWeight : -signedWeight; }
  /// True on one side of a pair (smaller id), which contributes to the sums.
  GROUSER_HD bool counts() const { return !(signedWeight < 0); }
};

/// Other constants of a row, for its gradient.
template <class Real> struct alignas(16) ImpulseRowOther {
  base::Vec3<Real> offset; ///< [m/s], including prescribed velocities
  Real arm;                ///< distance from the other side's centre to the contact point [m]
  Real mobility;           ///< sum of the inverse masses and the softness [1/kg]: scales residuals to velocities
  Real inertia;            ///< 1 / mobility [kg]
  std::uint32_t slot;      ///< the other grain, or kFixedPartner
  std::uint32_t place;     ///< index in the neighbour list, boundary, or patch, with a flag
};
/// Flag of ImpulseRowOther::place.
inline constexpr std::uint32_t kImpactBit = 1u << 31, kPlaceBits = kImpactBit - 1;

/// Constants of the rolling resistance of a row.
template <class Real> struct RollingRowRecord {
  base::Vec3<Real> offset; ///< [rad/s]
  Real softness, arm, weight;
};

/// Constants of a row used at the end of the step.
template <class Real> struct ImpulseRowEnd {
  Real overlap;               ///< at the start of the step [m]; < 0: gap
  Real pull;                  ///< impulse of cohesion [N s]
  Real damping, shearDamping; ///< dashpot coefficients [N s/m]
  Real rollingDamping;        ///< [N m s]
  Real slipped, rolled;       ///< energy that the springs have lost since their stiffness changed [J]
  Real normalOffset;          ///< see contact::ImpulseRow [m/s]
  contact::HertzNormal<Real> hertz;
};

/// Velocities of a grain in an iteration; exchanged with other ranks.
template <class Real> struct ImpulseMotion { base::Vec3<Real> velocity, spin; };

/// Body that a row acts on.
template <class Real> struct PartRowRecord {
  base::Vec3<Real> arm; ///< from the body's centre of mass to the contact point [m]
  std::uint32_t body;
};

/// Velocity of a body in an iteration.
template <class Real> struct BodyMotion {
  base::Vec3<Real> velocity, spin;
  GROUSER_HD base::Vec3<Real> at(const base::Vec3<Real>& arm) const { return velocity + cross(spin, arm); }
};

/// Rows of one kind in device arrays, by place. Impulses and gradients are triple-buffered: current, previous and trial
/// iteration.
template <class Real> struct ImpulseRowsView {
  ImpulseRowRecord<Real>* row;
  ImpulseRowOther<Real>* other;
  RollingRowRecord<Real>* rolling; ///< null without rolling resistance
  base::Vec3<Real>* impulse[3];    ///< [N s]
  base::Vec3<Real>* gradient[3];   ///< a in impulse_law.hpp [m/s]; not of the trial
  base::Vec3<Real>* turning[3];    ///< rolling impulse [N m s]; null without rolling resistance
  base::Vec3<Real>* turnGradient[3];
  ImpulseRowEnd<Real>* end;
  PartRowRecord<Real>* part; ///< null: no rows with parts
};

/// Sums of an iteration over all rows, as integers with quanta of two sizes, so that the order of grains does not
/// matter. Each grain sums its own rows in a fixed order. The first three describe a step, the others the residual.
enum ImpulseSum : int { kCurvature, kLength, kAgainst, kSquares, kContacts, kImpulseSums };
inline constexpr int kSumSizes = 2, kSumBanks = 64;
/// Ratio of the two quanta.
inline constexpr double kFinerSums = 0x1p40;

/// Arguments of the kernels of a step.
template <class Real> struct ImpulseData {
  contact::ImpulseRules<Real> rules;
  ImpulseRowsView<Real> grains; ///< by place of the neighbour list; a grain's rows occupy the first places of its list
  ImpulseRowsView<Real> bounds; ///< [row of the grain][index in the list of grains near boundaries]
  ImpulseRowsView<Real> parts;  ///< [listed grain-part pair][kPatches]
  std::uint32_t* grainRows;     ///< [slot] number of rows with other grains
  std::uint32_t* boundRows;     ///< [index in the list near boundaries] number of rows
  std::uint32_t* partRows;      ///< [listed grain-part pair] number of rows
  std::uint32_t* degree;        ///< [slot] number of all rows, including ghosts
  std::int64_t near;            ///< number of grains listed near boundaries
  ImpulseMotion<Real>* free;    ///< [slot] velocities at the end of the step without contacts
  ImpulseMotion<Real>* motion[3]; ///< [slot] velocities with the impulses of each buffer, including ghosts
  const std::uint32_t* ghost;     ///< [slot] nonzero for ghosts; null without ghosts
  std::int64_t margin;            ///< maximum gap of a row [units]
  std::int64_t minMargin;         ///< gap below which a pair at rest has a row [units]
  ImpulseControl<Real>* control;  ///< state of the iterations
  int now;                        ///< buffer index of the rows before and after the iterations
  // Force-driven surfaces.
  std::uint32_t* surfaceRows;   ///< [surface] number of rows on all ranks
  std::int64_t* surfacePushes;  ///< [surface] impulse of this rank's rows along its axis
  base::FixedPoint push;        ///< quantum of surfacePushes [N s]
  const Real* surfaceChange[3]; ///< [surface] speed change along its axis due to the impulses of each buffer [m/s]
  // Parts of bodies.
  contact::PartPatches patches;               ///< empty without parts
  const contact::BasicLaw<Real>* partLaws;    ///< by PartPatches::law()
  const std::uint32_t* bodyOfPart;            ///< [part]
  const contact::BodyResponse::Inverse* body; ///< [body]
  std::uint32_t* bodyRows;                    ///< [body] number of rows on all ranks
  std::int64_t* bodyPushes;                   ///< [body][6] impulse and moment of this rank's rows; null if no body
                                              ///< can move
  base::FixedPoint bodyPush, bodyTurn;        ///< quanta of bodyPushes [N s], [N m s]
  const BodyMotion<Real>* bodyMotion[3];      ///< [body] velocity with the impulses of each buffer
  bool rolls;                                 ///< any row has rolling resistance
  base::WideSum* sums;                        ///< [kSumBanks][kImpulseSums][kSumSizes]
  double perEnergy, perSquare;                ///< large quanta per unit
  std::uint32_t* worst;                       ///< maximum residual [m/s], as bits of a float
  std::uint32_t* rounding;                    ///< maximum of roundingOf() over all rows [m/s], as bits of a float
};

/// Calls each(pair, place) for the rows of a grain in contact with parts.
template <class Real, class Each> GROUSER_HD void forPartRowsOf(const ImpulseData<Real>& s, int i, const Each& each) {
  const std::uint32_t range = s.patches.pairs > 0 ? s.patches.range[i] : 0, first = range >> 8;
  for (std::uint32_t e = first; e < first + (range & 255u); ++e)
    for (std::uint32_t k = 0; k < s.partRows[e]; ++k)
      each(static_cast<int>(e), contact::PartPatches::first(static_cast<int>(e)) + k);
}

/// Calls each(rows, place) for all rows of a grain, in summation order.
template <class Real, class Each>
GROUSER_HD void forRowsOf(const GrainKernelData& d, const ImpulseData<Real>& s, int i, const Each& each) {
  const std::uint32_t grains = s.grainRows[i];
#if defined(__CUDA_ARCH__)
#pragma unroll 2
#endif
  for (std::uint32_t k = 0; k < grains; ++k) each(s.grains, d.neighbours.at(i, k));
  forPartRowsOf(s, i, [&](int, std::int64_t at) { each(s.parts, at); });
  const std::uint32_t at = d.boundaryCount > 0 ? d.boundaryOf[i] : 0;
  if (at == 0) return;
  for (std::uint32_t k = 0; k < s.boundRows[at - 1]; ++k) each(s.bounds, std::int64_t{at} - 1 + k * s.near);
}

/// Velocities of slot i at the start of the step.
template <class Real> GROUSER_HD ImpulseMotion<Real> motionAtStart(const GrainKernelData& d, int i) {
  return {d.motion[i].velocity.xyz().template as<Real>(), d.motion[i].spin.xyz().template as<Real>()};
}

/// Velocity of a grain's contact point relative to the other side [m/s]. Seen from the other side it has the opposite
/// sign, bit for bit.
template <class Real>
GROUSER_HD base::Vec3<Real> relativeVelocity(const ImpulseMotion<Real>& own, const ImpulseMotion<Real>& other,
                                             const base::Vec3<Real>& push, Real armOwn, Real armOther) {
  return (own.velocity - other.velocity) - cross(own.spin * armOwn + other.spin * armOther, push);
}

template <bool kRolls, class Real> GROUSER_HD contact::ImpulseCone<Real>
coneAt(const ImpulseRowsView<Real>& rows, std::int64_t at, const ImpulseRowRecord<Real>& row) {
  if constexpr (kRolls) return {row.friction, rows.rolling ? rows.rolling[at].arm : Real(0)};
  return {row.friction, Real(0)};
}

/// Returns the force-driven surface of a row, or null.
template <class Real> GROUSER_HD const SurfacePose* freeSurface(const GrainKernelData& d, const ImpulseData<Real>& s,
                                                                const ImpulseRowsView<Real>& rows, std::int64_t at,
                                                                int& surface) {
  if (rows.row != s.bounds.row || d.surfaceCount == 0) return nullptr;
  surface = static_cast<int>(rows.other[at].place & kPlaceBits) - (d.boundaryCount - d.surfaceCount);
  if (surface < 0 || !(d.placements[surface].inverseMass > 0)) return nullptr;
  return d.placements + surface;
}

/// True for ghosts and fixed grains.
template <class Real> GROUSER_HD bool hasNoRows(const GrainKernelData& d, const ImpulseData<Real>& s, int i) {
  return (s.ghost && s.ghost[i] != 0) || ((d.features & kFixed) && isFixed(d.motion[i].velocity));
}

/// Value that no thread of the kernel writes: its load may precede earlier stores, and is not coherent with them.
template <class T> GROUSER_HD T readOnly(const T* from) {
  static_assert(std::is_trivially_copyable_v<T> && alignof(T) >= alignof(int));
#if defined(__CUDA_ARCH__)
  using Word = std::conditional_t<alignof(T) % 16 == 0, int4, std::conditional_t<alignof(T) % 8 == 0, long long, int>>;
  Word words[sizeof(T) / sizeof(Word)];
  for (std::size_t k = 0; k < sizeof(T) / sizeof(Word); ++k) words[k] = __ldg(reinterpret_cast<const Word*>(from) + k);
  T value;
  memcpy(&value, words, sizeof(T));
  return value;
#else
  return *from;
#endif
}

/// Torque of a row; `kRolls`: whether any row has rolling resistance.
template <class Real, bool kRolls> using TurnOf = std::conditional_t<kRolls, base::Vec3<Real>, contact::NoTurn>;

/// Impulse or gradient from buffers that the calling kernel does not write: see readOnly(). `rolling`: null without
/// rolling resistance.
template <bool kRolls, class Real> GROUSER_HD contact::Impulse<Real, TurnOf<Real, kRolls>>
loadPair(const base::Vec3<Real>* linear, const base::Vec3<Real>* rolling, std::int64_t at) {
  TurnOf<Real, kRolls> turn{};
  if constexpr (kRolls)
    if (rolling) turn = readOnly(rolling + at);
  return {readOnly(linear + at), turn};
}
template <bool kRolls, class Real>
GROUSER_HD auto impulseAt(const ImpulseRowsView<Real>& rows, int generation, std::int64_t at) {
  return loadPair<kRolls>(rows.impulse[generation], rows.turning[generation], at);
}
template <bool kRolls, class Real>
GROUSER_HD auto gradientAt(const ImpulseRowsView<Real>& rows, int generation, std::int64_t at) {
  return loadPair<kRolls>(rows.gradient[generation], rows.turnGradient[generation], at);
}

} // namespace grouser::terrain
