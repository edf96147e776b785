// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/bits.hpp"
#include "base/for_each.cuh"
#include "base/vec.hpp"
#include "base/wide_sum.cuh"
#include "terrain/compensated_sum.hpp"

#include <cmath>
#include <cstdint>

/// Energy accounting of grain steps. Symplectic Euler changes the kinetic energy of a grain in a step by exactly F .
/// (v_old + v_new) / 2 dt + T . (w_old + w_new) / 2 dt. This work is summed step by step, from the same forces,
/// velocities and remainders as the new state; the kinetic energy itself is computed from the state, which provides a
/// check. All sums are integers: order-independent, identical for any device, threads and ranks.
namespace grouser::terrain {

/// Indices of the sums. Grain kernels add to the first kGrainSums and, with fixed grains, to the wall forces;
/// kernels of walls, floor and surfaces add to kFirstOfWalls and all that follow.
enum LedgerSum : int {
  kWork,     ///< work of all forces on the grains
  kTurnover, ///< sum of |work| per grain and step
  kMass,     ///< sum of grain masses per step, for the impulse of gravity
  kMoment,   ///< x, y, z: mass times position per step, for the torque of gravity
  kFirstOfWalls = kMoment + 3,
  kDashpotDissipation = kFirstOfWalls, ///< dissipated by contact dashpots
  kSlidingDissipation,                 ///< dissipated by sliding
  kRollingDissipation,                 ///< dissipated by rolling resistance
  kMicroSlipDissipation,               ///< dissipated by tangential springs of Hertz contacts due to stiffness changes
  kGrainSums,
  /// x, y, z, summed over steps: force of walls, floor and fixed grains on the grains, and of the ground on fixed
  /// grains loaded by surfaces and parts
  kWallForce = kGrainSums,
  kWallTorque = kWallForce + 3,          ///< about the world origin
  kPlasticDissipation = kWallTorque + 3, ///< dissipated by elastic-plastic contacts
  kStabilisation,                        ///< added by complementarity contacts that separate overlaps
  kLedgerSums
};

/// Quanta that represent the mass of the largest grain.
inline constexpr std::int64_t kMassQuanta = 1 << 30;

/// Quanta of the sums: a grain adds at most 2^51 quanta per step unless the run is unstable.
struct LedgerScale {
  double perEnergy{1}, perMoment{1}, perForce{1}, perTorque{1}; ///< quanta per unit; powers of two
};

/// Rounds `quanta` to the nearest integer, ties to even, without a function call. Clamps values beyond +-2^51 to the
/// limit, and NaN to -2^51.
GROUSER_HD std::int64_t wholeQuanta(double quanta) {
  constexpr double kMax = 0x1p51, kShift = 0x1.8p52;
  const double within = !(quanta > -kMax) ? -kMax : quanta < kMax ? quanta : kMax;
  return base::bitsAs<std::int64_t>(within + kShift) - base::bitsAs<std::int64_t>(kShift); // the last place is 1
}

/// Dissipation of one grain in one step [J].
struct Lost {
  double damped, rubbed, rolled, slipped;
};

/// Partial sums over several grains, from kBegin to kEnd.
template <int kBegin, int kEnd> struct EnergyAccumulator {
  static constexpr int kFirst = kBegin, kCount = kEnd - kBegin;
  std::int64_t of[kCount] = {};
  GROUSER_HD void add(int sum, std::int64_t quanta) { of[sum - kFirst] += quanta; }
  /// Adds a force of fixed surroundings on a grain [N], and torque [N m] about the world origin.
  GROUSER_HD void addForce(const base::Vec3d& force, const base::Vec3d& torque, const LedgerScale& scale) {
    for (int a = 0; a < 3; ++a) {
      add(kWallForce + a, wholeQuanta(scale.perForce * force[a]));
      add(kWallTorque + a, wholeQuanta(scale.perTorque * torque[a]));
    }
  }
};
/// Accumulator of grain kernels; linear contacts need no kMicroSlipDissipation. `kHolds`: with forces of fixed grains.
template <bool kSlips, bool kHolds> using GrainAccumulatorFor = EnergyAccumulator<0, kHolds   ? kPlasticDissipation
                                                                                     : kSlips ? kGrainSums
                                                                                              : kMicroSlipDissipation>;
using GrainAccumulator = GrainAccumulatorFor<true, true>;
using WallAccumulator = EnergyAccumulator<kFirstOfWalls, kPlasticDissipation>;
using RareAccumulator = EnergyAccumulator<kPlasticDissipation, kLedgerSums>;

/// Change of half the squared velocity in a step that adds `faster`: faster (v_old + v_new) / 2, plus the effect of
/// rounding (the square of the rounding error is below double precision).
GROUSER_HD double halfSquareGained(double faster, const CompensatedStep& now) {
  return faster * (now.sum - 0.5 * faster) + now.rounding * now.sum;
}

/// The sums are replicated in banks, so that concurrent threads rarely collide: [kLedgerBanks][kLedgerSums].
inline constexpr int kLedgerBanks = 64;

/// Adds to one of the banks, selected by `item`, the index of the caller.
template <class Accumulator> GROUSER_HD void addToBank(base::WideSum* sums, int item, const Accumulator& some) {
  base::WideSum* const bank = sums + (item % kLedgerBanks) * kLedgerSums + Accumulator::kFirst;
#if defined(__CUDA_ARCH__)
  base::atomicAddTogether(bank, some.of);
#else
  for (int b = 0; b < Accumulator::kCount; ++b)
    if (some.of[b] != 0) base::atomicAddWide(bank + b, some.of[b]);
#endif
}

/// Kernel with energy accounting for the grains of one task. `Body` requires run(k, accumulator).
template <class Body> struct WithEnergyAccounting {
  static constexpr int kBlocksTogether = base::blocksTogether<Body>();
  static constexpr int kOnCpu = 32;
  Body body;
  std::int64_t count;

  double nanoseconds() const { return kOnCpu * Body::kNanoseconds; }
  /// Number of tasks in a loop over `count` grains.
  static std::int64_t items(const base::Exec& exec, std::int64_t count) {
    return exec.onCpu() ? (count + kOnCpu - 1) / kOnCpu : count;
  }
  GROUSER_HD void operator()(int item) const {
    typename Body::Accumulator accumulator;
#if defined(__CUDA_ARCH__)
    body.run(item, accumulator);
    addToBank(body.d.ledgerSums, static_cast<int>(blockIdx.x), accumulator);
#else
    const std::int64_t first = std::int64_t{item} * kOnCpu, last = first + kOnCpu < count ? first + kOnCpu : count;
    for (std::int64_t k = first; k < last; ++k) body.run(static_cast<int>(k), accumulator);
    addToBank(body.d.ledgerSums, item, accumulator);
#endif
  }
};

} // namespace grouser::terrain
