// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/bits.hpp"
#include "base/for_each.cuh"
#include "base/vec.hpp"
#include "base/wide_sum.cuh"
#include "terrain/compensated_sum.hpp"

#include <cmath>
#include <cstdint>

/// Energy accounting of the grains' steps. Symplectic Euler changes the kinetic energy of a grain in a step by exactly
/// F . (v_old + v_new) / 2 dt + T . (w_old + w_new) / 2 dt. That work is summed here, step by step, from the forces,
/// velocities and remainders that make the new state; the kinetic energy itself is computed from the state, so that the
/// two check each other. All sums are of integers: order-free, the same for any device, threads and ranks.
namespace grouser::terrain {

/// The sums. Kernels of grains add to the first kGrainSums and, with fixed grains, to the wall forces; those of walls,
/// floor and surfaces to kFirstOfWalls and all after it.
enum LedgerSum : int {
  kWork,     ///< work of all forces on the grains
  kTurnover, ///< sum of its magnitudes per grain and step
  kMass,     ///< mass of the grains per step, for the impulse of gravity
  kMoment,   ///< x, y, z: mass times position per step, for the torque of gravity
  kFirstOfWalls = kMoment + 3,
  kDashpotDissipation = kFirstOfWalls, ///< by dashpots of contacts
  kSlidingDissipation,                 ///< by sliding
  kRollingDissipation,                 ///< by rolling resistance
  kMicroSlipDissipation,               ///< by tangential springs of Hertz contacts as their stiffness changes
  kGrainSums,
  /// x, y, z: force of walls, floor and fixed grains on the grains, and of the ground on fixed grains loaded by
  /// surfaces and parts; per step
  kWallForce = kGrainSums,
  kWallTorque = kWallForce + 3,          ///< about the origin of the world
  kPlasticDissipation = kWallTorque + 3, ///< by elastic-plastic contacts
  kStabilisation,                        ///< added by complementarity contacts that push overlaps apart
  kLedgerSums
};

/// Quanta of the mass of the largest grain.
inline constexpr std::int64_t kMassQuanta = 1 << 30;

/// Quanta of the sums: a grain adds at most 2^51 of them in a step, or the run is unstable.
struct LedgerScale {
  double perEnergy{1}, perMoment{1}, perForce{1}, perTorque{1}; ///< quanta a unit; powers of two
};

/// Nearest whole number of |quanta| < 2^51, ties to even, without a call; larger values and NaN are clamped to the end
/// of the range.
GROUSER_HD std::int64_t wholeQuanta(double quanta) {
  constexpr double kMost = 0x1p51, kShift = 0x1.8p52;
  const double within = !(quanta > -kMost) ? -kMost : quanta < kMost ? quanta : kMost;
  return base::bitsAs<std::int64_t>(within + kShift) - base::bitsAs<std::int64_t>(kShift); // the last place is 1
}

/// Dissipation of one grain in one step [J].
struct Lost {
  double damped, rubbed, rolled, slipped;
};

/// Contributions of several grains to the sums from kBegin to kEnd.
template <int kBegin, int kEnd> struct EnergyAccumulator {
  static constexpr int kFirst = kBegin, kCount = kEnd - kBegin;
  std::int64_t of[kCount] = {};
  GROUSER_HD void add(int sum, std::int64_t quanta) { of[sum - kFirst] += quanta; }
  /// Adds a force of fixed surroundings on a grain [N], [N m about the origin].
  GROUSER_HD void addForce(const base::Vec3d& force, const base::Vec3d& torque, const LedgerScale& scale) {
    for (int a = 0; a < 3; ++a) {
      add(kWallForce + a, wholeQuanta(scale.perForce * force[a]));
      add(kWallTorque + a, wholeQuanta(scale.perTorque * torque[a]));
    }
  }
};
/// Without kMicroSlipDissipation for linear contacts. `kHolds`: with forces of fixed grains.
template <bool kSlips, bool kHolds> using GrainAccumulatorFor = EnergyAccumulator<0, kHolds   ? kPlasticDissipation
                                                                                     : kSlips ? kGrainSums
                                                                                              : kMicroSlipDissipation>;
using GrainAccumulator = GrainAccumulatorFor<true, true>;
using WallAccumulator = EnergyAccumulator<kFirstOfWalls, kPlasticDissipation>;
using RareAccumulator = EnergyAccumulator<kPlasticDissipation, kLedgerSums>;

/// Change of half the square of a velocity in a step that adds `faster` to it: faster (v_old + v_new) / 2, plus the
/// effect of rounding, whose square is below the precision of a double.
GROUSER_HD double halfSquareGained(double faster, const CompensatedStep& now) {
  return faster * (now.sum - 0.5 * faster) + now.rounding * now.sum;
}

/// The sums are replicated, so that concurrent threads rarely collide: [kLedgerBanks][kLedgerSums].
inline constexpr int kLedgerBanks = 64;

/// Adds to one of the banks; `item`: number of the caller.
template <class Accumulator> GROUSER_HD void addToBank(base::WideSum* sums, int item, const Accumulator& some) {
  base::WideSum* const bank = sums + (item % kLedgerBanks) * kLedgerSums + Accumulator::kFirst;
#if defined(__CUDA_ARCH__)
  base::atomicAddTogether(bank, some.of);
#else
  for (int b = 0; b < Accumulator::kCount; ++b)
    if (some.of[b] != 0) base::atomicAddWide(bank + b, some.of[b]);
#endif
}

/// A kernel with energy accounting for the grains of one task. `Body` has run(k, accumulator).
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
