// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/for_each.cuh"
#include "base/position.hpp"

#include <cstdint>

/// Kernel bodies shared by all cell searches. Spheres are sorted by cell of a dense grid (z fastest). Each sphere
/// searches the columns around its cell. A grid must provide cellOf(position), low, cells, local(position), key(cell).
namespace grouser::contact {

using Cell = base::Vec3<std::uint32_t>;

constexpr std::int64_t kShare = 32; ///< items per thread in strided loops

/// Number of threads for `count` items, kShare items each.
GROUSER_HD constexpr std::int64_t sharesOf(std::int64_t count) { return (count + kShare - 1) / kShare; }

/// Calls visit(i) for the items of one of sharesOf(count) threads: strided on a GPU, so that reads of neighbouring
/// threads coalesce; consecutive on a CPU.
template <class Visit> GROUSER_HD void overShare(std::int64_t thread, std::int64_t count, const Visit& visit) {
#if defined(__CUDA_ARCH__)
  const std::int64_t threads = sharesOf(count);
  for (std::int64_t i = thread; i < count; i += threads) visit(i);
#else
  const std::int64_t first = thread * kShare, last = first + kShare < count ? first + kShare : count;
  for (std::int64_t i = first; i < last; ++i) visit(i);
#endif
}

/// Finds the bounds of the occupied cells with sharesOf(count) threads. bounds[0..2] store the complement of the
/// minimum, so that all six bounds are maxima.
template <class Grid> struct FindBounds {
  static constexpr double kNanoseconds = 3.0 * kShare;
  Grid grid;
  const base::Position* position;
  std::int64_t count;
  std::uint32_t* bounds;

  GROUSER_HD void operator()(int thread) const {
    Cell low{~0u, ~0u, ~0u}, high{0, 0, 0};
    overShare(thread, count, [&](std::int64_t i) {
      const Cell c = grid.cellOf(position[i]);
      low = base::min(low, c), high = base::max(high, c);
    });
    for (int a = 0; a < 3; ++a) {
      base::atomicMax32(bounds + a, ~low[a]);
      base::atomicMax32(bounds + 3 + a, high[a]);
    }
  }
};

/// Computes the cell keys of all spheres, or of those in a list.
template <class Grid> struct AssignKeys {
  static constexpr double kNanoseconds = 8;
  Grid grid;
  const base::Position* position;
  std::uint64_t* key;
  const std::uint32_t* list = nullptr;
  GROUSER_HD void operator()(int i) const { key[i] = grid.key(grid.local(position[list ? list[i] : i])); }
};

/// Sets start[c] to the first place with a key >= c, for c in [0, cells]. Run it for count + 1 places.
struct MarkStarts {
  const std::uint64_t* key;
  std::int64_t count, cells;
  std::uint32_t* start;
  GROUSER_HD void operator()(int i) const {
    const std::int64_t before = i == 0 ? -1 : static_cast<std::int64_t>(key[i - 1]);
    const std::int64_t here = i == count ? cells : static_cast<std::int64_t>(key[i]);
    for (std::int64_t c = before + 1; c <= here; ++c) start[c] = static_cast<std::uint32_t>(i);
  }
};

/// Range of places, in sorted order, of the spheres in the cells z - 1, z and z + 1 of a column.
struct ColumnOfThree {
  std::uint32_t first, last;

  template <class Grid> GROUSER_HD ColumnOfThree(const Grid& grid, const std::uint32_t* start, std::uint32_t x,
                                                 std::uint32_t y, std::uint32_t z) {
    const std::uint64_t row = grid.key({x, y, 0});
    first = start[row + (z == 0 ? 0 : z - 1)];
    last = start[row + (z + 1 < grid.cells.z ? z + 1 : z) + 1];
  }
};

/// True if the low words of two positions suffice for an exact difference; not always in cells widened by far spheres.
GROUSER_HD bool differencesHold(const base::Vec3l& apart) {
  constexpr std::int64_t kSafe = std::int64_t{1} << 30;
  return apart.x < kSafe && apart.x > -kSafe && apart.y < kSafe && apart.y > -kSafe && apart.z < kSafe &&
         apart.z > -kSafe;
}

} // namespace grouser::contact
