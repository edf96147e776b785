// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/for_each.cuh"
#include "contact/neighbour_list.hpp"

/// How neighbours are found: spheres sorted by the cells of a grid, and a look into the 27 cells around each.
namespace grouser::contact {

using Cell = CellGrid::Cell;

constexpr int kBoundsChunk = 512; ///< grains that one thread finds the bounds of

/// Lowest and highest cell in use. bounds[0..2] hold the complement of the minimum, so that all six grow.
struct FindBounds {
  CellGrid grid;
  const base::Position* position;
  std::int64_t count;
  std::uint32_t* bounds;

  GROUSER_HD static void raiseTo(std::uint32_t* target, std::uint32_t value) {
#if defined(__CUDA_ARCH__)
    atomicMax(target, value);
#else
    std::uint32_t old = __atomic_load_n(target, __ATOMIC_RELAXED);
    while (value > old && !__atomic_compare_exchange_n(target, &old, value, true, __ATOMIC_RELAXED, __ATOMIC_RELAXED)) {
    }
#endif
  }
  GROUSER_HD void operator()(int chunk) const {
    const std::int64_t first = static_cast<std::int64_t>(chunk) * kBoundsChunk;
    const std::int64_t last = first + kBoundsChunk < count ? first + kBoundsChunk : count;
    Cell low{~0u, ~0u, ~0u}, high{0, 0, 0};
    for (std::int64_t i = first; i < last; ++i) {
      const Cell c = grid.cellOf(position[i]);
      low = base::min(low, c), high = base::max(high, c);
    }
    for (int a = 0; a < 3; ++a) {
      raiseTo(bounds + a, ~low[a]);
      raiseTo(bounds + 3 + a, high[a]);
    }
  }
};

struct AssignKeys {
  CellGrid grid;
  const base::Position* position;
  std::uint64_t* key;
  GROUSER_HD void operator()(int i) const { key[i] = grid.key(grid.local(position[i])); }
};

/// start[c] = first slot whose key is >= c, for c in [0, cells].
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

/// The spheres near one: those whose surfaces are closer than the skin.
struct NearSpheres {
  CellGrid grid;
  const base::Position* position;
  const std::uint32_t* cellStart;
  std::int64_t reach2;
  RadiiInW radii;
  std::int64_t skin;
  const std::uint32_t* ghost; ///< by slot: not 0 for one that needs no row; null where all have rows

  /// Calls `visit(j)` for the slots near slot i, in the order of the cells.
  template <class Visit> GROUSER_HD void each(int i, const Visit& visit) const {
    if (ghost && ghost[i]) return;
    const base::Position p = position[i];
    const Cell c = grid.local(p);
    const std::int64_t own = radii.sphere ? radii.units(i) + skin : 0;
    const std::uint32_t z0 = c.z == 0 ? 0 : c.z - 1, z1 = c.z + 1 < grid.cells.z ? c.z + 1 : c.z;
    for (int column = 0; column < 9; ++column) {
      std::uint32_t x = c.x + static_cast<std::uint32_t>(column / 3) - 1,
                    y = c.y + static_cast<std::uint32_t>(column % 3) - 1;
      if (!besides(0, x) || !besides(1, y)) continue;
      const std::uint32_t last = cellStart[grid.key({x, y, z1}) + 1];
      for (std::uint32_t j = cellStart[grid.key({x, y, z0})]; j < last; ++j) {
        if (static_cast<int>(j) == i) continue;
        const base::Vec3l apart = grid.period.apart(p, position[j]);
        if (!differencesHold(apart)) continue;
        const std::int64_t reach = radii.sphere ? own + radii.units(static_cast<int>(j)) : 0;
        if (base::squaredNorm(apart.as<std::int32_t>()) < (radii.sphere ? reach * reach : reach2)) visit(j);
      }
    }
  }

private:
  /// Whether there is such a cell beside one in use along x or y; across joined sides it is at the other end.
  GROUSER_HD bool besides(int axis, std::uint32_t& c) const {
    const std::uint32_t cells = grid.cells[axis];
    if (grid.period.along(axis)) c = c == cells ? 0 : c > cells ? cells - 1 : c;
    return c < cells;
  }

  /// Whether 32-bit differences hold: cells may have been widened for grains far away.
  GROUSER_HD static bool differencesHold(const base::Vec3l& apart) {
    constexpr std::int64_t kSafe = std::int64_t{1} << 30;
    return apart.x < kSafe && apart.x > -kSafe && apart.y < kSafe && apart.y > -kSafe && apart.z < kSafe &&
           apart.z > -kSafe;
  }
};

struct CountNear {
  NearSpheres near;
  std::uint32_t* count;
  GROUSER_HD void operator()(int i) const {
    std::uint32_t found = 0;
    near.each(i, [&found](std::uint32_t) { ++found; });
    count[i] = found;
  }
};

/// Writes a row: the slots near one, in the order of their ids.
struct ListNear {
  NearSpheres near;
  const std::uint32_t* id;
  NeighbourRows rows;
  std::uint32_t* slot;
  GROUSER_HD void operator()(int i) const {
    const std::int64_t row = rows.start[i], stride = rows.stride;
    std::uint32_t filled = 0;
    near.each(i, [&](std::uint32_t j) {
      std::int64_t k = row + stride * filled++;
      for (; k > row && id[slot[k - stride]] > id[j]; k -= stride) slot[k] = slot[k - stride];
      slot[k] = j;
    });
  }
};

} // namespace grouser::contact
