// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "contact/cell_search.cuh"
#include "runs/validation/bench/id_pair.hpp"

/// Kernels of the pair search.
namespace grouser::bench::detail {

using base::Position;
using base::Vec3l;
using contact::Cell;
using contact::ColumnOfThree;
using contact::overShare;

/// Divides 42-bit numbers by the cell edge, using a multiplication.
struct Divider {
  std::uint64_t edge, inverse;
  explicit Divider(std::int64_t e) : edge(static_cast<std::uint64_t>(e)), inverse(~std::uint64_t{0} / edge) {}

  GROUSER_HD std::uint32_t operator()(std::uint64_t u) const {
#if defined(__CUDA_ARCH__)
    std::uint64_t q = __umul64hi(u, inverse);
#else
    auto q = static_cast<std::uint64_t>(static_cast<unsigned __int128>(u) * inverse >> 64);
#endif
    // The inverse is rounded down, so that q may be too small by 1.
    if (u - q * edge >= edge) ++q;
    return static_cast<std::uint32_t>(q);
  }
};

/// Cell of a sphere; the count starts at the lowest representable position.
struct CellOf {
  Divider divide;
  GROUSER_HD std::uint32_t along(std::int64_t u) const {
    constexpr std::int64_t kBias = std::int64_t{1} << 41;
    return divide(static_cast<std::uint64_t>(u + kBias));
  }
  GROUSER_HD std::uint32_t x(const Position& p) const { return along(base::axisOf(p.x, p.high, 0)); }
  GROUSER_HD Cell operator()(const Position& p) const {
    const Vec3l u = base::toUnits(p);
    return {along(u.x), along(u.y), along(u.z)};
  }
};

/// Counts the spheres of a sample in each layer of cells along x.
struct CountLayers {
  CellOf cellOf;
  const Position* position;
  std::int64_t stride;
  std::uint32_t low;
  std::uint32_t* layers;
  GROUSER_HD void operator()(int i) const { base::atomicAdd32(layers + (cellOf.x(position[i * stride]) - low), 1u); }
};

/// Sets mark[i] = 1 for the spheres in the layers [from, to).
struct MarkLayers {
  CellOf cellOf;
  const Position* position;
  std::uint32_t from, to;
  std::uint32_t* mark;
  GROUSER_HD void operator()(int i) const {
    const std::uint32_t x = cellOf.x(position[i]);
    mark[i] = x >= from && x < to;
  }
};

/// Compacts the list of marked spheres, using prefix sums of the marks.
struct ListMarked {
  const std::uint32_t* before;
  std::int64_t count;
  std::uint32_t total;
  std::uint32_t* list;
  GROUSER_HD void operator()(int i) const {
    const std::uint32_t mine = before[i], next = i + 1 < count ? before[i + 1] : total;
    if (next != mine) list[mine] = static_cast<std::uint32_t>(i);
  }
};

/// Dense grid over a slab. x is the slowest index, so that the first layer of the next slab comes last.
struct SlabGrid {
  CellOf cellOf;
  Cell low, cells;
  GROUSER_HD std::uint64_t key(const Cell& c) const {
    return (static_cast<std::uint64_t>(c.x) * cells.y + c.y) * cells.z + c.z;
  }
  GROUSER_HD Cell local(const Position& p) const {
    const Cell c = cellOf(p);
    return {c.x - low.x, c.y - low.y, c.z - low.z};
  }
};

/// Input of the search of one slab.
struct Neighbourhood {
  SlabGrid grid;
  const Position* position; ///< sorted by cell
  const std::uint32_t* start;
  std::int64_t reach2;
  bool checkFar; ///< true if the cells are so wide that 32-bit differences may wrap

  GROUSER_HD bool overlaps(const Position& a, const Position& b) const {
    if (checkFar && !contact::differencesHold(base::toUnits(b) - base::toUnits(a))) return false;
    return base::squaredNorm(base::difference(a, b)) < reach2;
  }

  /// Calls visit(j, contact of j and i) for each sphere j that follows i in the same cell, or is in one of the 13
  /// following cells.
  template <class Visit> GROUSER_HD void forLater(std::uint32_t i, Visit& visit) const {
    const Position p = position[i];
    const Cell c = grid.local(p);
    across(p, i + 1, ColumnOfThree(grid, start, c.x, c.y, c.z).last, visit);
    // Columns of cells at the offsets (0, 1), (1, -1), (1, 0), (1, 1).
    for (std::uint32_t column = 0; column < 4; ++column) {
      const std::uint32_t x = column == 0 ? c.x : c.x + 1, y = column == 0 ? c.y + 1 : c.y + column - 2;
      if (x >= grid.cells.x || y >= grid.cells.y) continue; // -1 wraps to a large number
      const ColumnOfThree near(grid, start, x, y, c.z);
      across(p, near.first, near.last, visit);
    }
  }

private:
  template <class Visit>
  GROUSER_HD void across(const Position& p, std::uint32_t first, std::uint32_t last, Visit& visit) const {
    for (std::uint32_t j = first; j < last; ++j) visit(j, overlaps(p, position[j]));
  }
};

struct Count {
  Neighbourhood near;
  std::uint32_t* counts;

  struct Add {
    std::uint32_t n;
    GROUSER_HD void operator()(std::uint32_t, bool touches) { n += touches; }
  };
  GROUSER_HD void operator()(int i) const {
    Add add{0};
    near.forLater(static_cast<std::uint32_t>(i), add);
    counts[i] = add.n;
  }
};

/// Must run with sharesOf(count) threads.
struct SumCounts {
  const std::uint32_t* counts;
  std::int64_t count;
  std::int64_t* total;
  GROUSER_HD void operator()(int thread) const {
    std::int64_t sum = 0;
    overShare(thread, count, [&](std::int64_t i) { sum += counts[i]; });
    base::atomicAdd64(total, sum);
  }
};

struct Store {
  Neighbourhood near;
  const std::uint32_t *list, *offset;
  IdPair* pairs;

  struct Put {
    const std::uint32_t* list;
    std::uint32_t id;
    IdPair* next;
    GROUSER_HD void operator()(std::uint32_t j, bool touches) {
      if (!touches) return;
      const std::uint32_t other = list[j];
      *next++ = id < other ? IdPair{id, other} : IdPair{other, id};
    }
  };
  GROUSER_HD void operator()(int i) const {
    Put put{list, list[i], pairs + offset[i]};
    near.forLater(static_cast<std::uint32_t>(i), put);
  }
};

} // namespace grouser::bench::detail
