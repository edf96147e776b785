// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/bits.hpp"
#include "base/for_each.cuh"
#include "base/vec.hpp"
#include "base/wide_sum.cuh"
#include "terrain/compensated_sum.hpp"

#include <cmath>
#include <cstdint>

/// What the grains' steps add to the books of a run. Symplectic Euler changes the kinetic energy of a grain in a step
/// by exactly F . (v_old + v_new) / 2 dt + T . (w_old + w_new) / 2 dt. That work is summed here, step by step, from the
/// very forces, velocities and remainders that make the new state; the kinetic energy itself is read off the state, so
/// that the two check each other. All sums are of integers: order-free, the same for any device, threads and ranks.
namespace grouser::terrain {

/// The sums. Kernels of grains add to the first kGrainBooks and, with fixed grains, to the wall forces; those of walls,
/// floor and surfaces to all from kFirstOfWalls on.
enum Book : int {
  kWork,     ///< by all forces on the grains
  kTurnover, ///< the same without signs, a grain and a step each
  kMass,     ///< of the grains, a step each, from which gravity's impulse follows
  kMoment,   ///< x, y, z: mass times place, a step each, from which gravity's torque follows
  kFirstOfWalls = kMoment + 3,
  kDamped = kFirstOfWalls, ///< taken by dashpots of contacts
  kRubbed,                 ///< by sliding
  kRolled,                 ///< by rolling resistance
  kSlipped,                ///< by tangential springs of Hertz' law as they stiffen and soften
  kGrainBooks,
  /// x, y, z: of walls, floor and fixed grains on the grains, and of what holds fixed ones against surfaces and
  /// parts; a step each
  kWallForce = kGrainBooks,
  kWallTorque = kWallForce + 3, ///< about the origin of the world
  kYielded = kWallTorque + 3,   ///< by elastic-plastic contacts
  kStabilised,                  ///< put in by complementarity contacts that push overlaps apart
  kBooks
};

/// Quanta of the mass of the largest grain.
inline constexpr std::int64_t kMassQuanta = 1 << 30;

/// Quanta of the sums: what one grain adds in a step lies within 2^51 of them, or the run has become unsound.
struct BookScale {
  double perEnergy{1}, perMoment{1}, perForce{1}, perTorque{1}; ///< quanta a unit; powers of two
};

/// Nearest whole number of |quanta| < 2^51, ties to even, without a call; what is beyond, or no number, becomes the end
/// of the range.
GROUSER_HD std::int64_t wholeQuanta(double quanta) {
  constexpr double kMost = 0x1p51, kShift = 0x1.8p52;
  const double within = !(quanta > -kMost) ? -kMost : quanta < kMost ? quanta : kMost;
  return base::bitsAs<std::int64_t>(within + kShift) - base::bitsAs<std::int64_t>(kShift); // the last place is 1
}

/// What dissipation takes from one grain in one step [J].
struct Lost {
  double damped, rubbed, rolled, slipped;
};

/// What several grains have added to the sums from kBegin to kEnd.
template <int kBegin, int kEnd> struct BooksOf {
  static constexpr int kFirst = kBegin, kCount = kEnd - kBegin;
  std::int64_t of[kCount] = {};
  GROUSER_HD void add(int book, std::int64_t quanta) { of[book - kFirst] += quanta; }
  /// Of what does not move on a grain [N], [N m about the origin].
  GROUSER_HD void addForce(const base::Vec3d& force, const base::Vec3d& torque, const BookScale& scale) {
    for (int a = 0; a < 3; ++a) {
      add(kWallForce + a, wholeQuanta(scale.perForce * force[a]));
      add(kWallTorque + a, wholeQuanta(scale.perTorque * torque[a]));
    }
  }
};
/// Without kSlipped where contacts are linear. `kHolds`: with forces by grains that never move.
template <bool kSlips, bool kHolds> using GrainBooksOf = BooksOf<0, kHolds   ? kYielded
                                                                    : kSlips ? kGrainBooks
                                                                             : kSlipped>;
using GrainBooks = GrainBooksOf<true, true>;
using WallBooks = BooksOf<kFirstOfWalls, kYielded>;
using RareBooks = BooksOf<kYielded, kBooks>;

/// What half the square of a velocity gains in a step that adds `faster` to it: faster (v_old + v_new) / 2, and what
/// rounding makes of it, whose square is beyond a double's digits.
GROUSER_HD double halfSquareGained(double faster, const CompensatedStep& now) {
  return faster * (now.sum - 0.5 * faster) + now.rounding * now.sum;
}

/// The sums are kept several times over, so that threads which add at the same time rarely meet: [kBookBanks][kBooks].
inline constexpr int kBookBanks = 64;

/// Adds to one of the banks; `item`: a number that tells the callers apart.
template <class Books> GROUSER_HD void addToBank(base::WideSum* books, int item, const Books& some) {
  base::WideSum* const bank = books + (item % kBookBanks) * kBooks + Books::kFirst;
#if defined(__CUDA_ARCH__)
  base::atomicAddTogether(bank, some.of);
#else
  for (int b = 0; b < Books::kCount; ++b)
    if (some.of[b] != 0) base::atomicAddWide(bank + b, some.of[b]);
#endif
}

/// A kernel that keeps books: of as many grains as one thread takes at a time. `Body` has run(k, books).
template <class Body> struct Booked {
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
    typename Body::Books books;
#if defined(__CUDA_ARCH__)
    body.run(item, books);
    addToBank(body.d.books, static_cast<int>(blockIdx.x), books);
#else
    const std::int64_t first = std::int64_t{item} * kOnCpu, last = first + kOnCpu < count ? first + kOnCpu : count;
    for (std::int64_t k = first; k < last; ++k) body.run(static_cast<int>(k), books);
    addToBank(body.d.books, item, books);
#endif
  }
};

} // namespace grouser::terrain
