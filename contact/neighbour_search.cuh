// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "contact/cell_grid.hpp"
#include "contact/cell_search.cuh"
#include "contact/neighbour_rows.cuh"
#include "contact/neighbour_view.hpp"

/// Neighbour search: spheres are sorted by grid cells. With cells as wide as the maximum reach, each sphere searches
/// the 27 cells around it; if some spheres are much smaller than the largest, cells are finer, and each sphere searches
/// as far as the largest sphere near it requires.
namespace grouser::contact {

/// Finds the neighbours of a sphere: spheres with a surface gap below the skin.
struct NearSpheres {
  CellGrid grid;
  const base::Position* position;
  const std::uint32_t* cellStart;
  const std::uint32_t* slotAt; ///< slot per place in the cells; null if spheres are sorted by cells
  std::int64_t reach2;
  RadiiInW radii;
  std::int64_t skin;
  const std::uint32_t* ghost; ///< per slot: nonzero if it needs no row; null if all slots have rows
  /// Maximum radius of spheres that may reach into each cell [units]; null if cells are as wide as the maximum reach.
  const std::uint32_t* largest;

  /// Calls `visit(j)` for the slots near slot i, in cell order.
  template <class Visit> GROUSER_HD void each(int i, const Visit& visit) const {
    if ((ghost && ghost[i]) || radii.isFixed(i)) return;
    if (largest) return eachOfFine(i, visit);
    const Cell c = grid.local(position[i]);
    for (int column = 0; column < 9; ++column) {
      std::uint32_t x = c.x + static_cast<std::uint32_t>(column / 3) - 1,
                    y = c.y + static_cast<std::uint32_t>(column % 3) - 1;
      if (!besides(0, x) || !besides(1, y)) continue;
      const ColumnOfThree near(grid, cellStart, x, y, c.z);
      eachBetween(i, near.first, near.last, visit);
    }
  }

private:
  template <class Visit> GROUSER_HD void eachOfFine(int i, const Visit& visit) const {
    const base::Vec3l u = base::toUnits(position[i]);
    const std::int64_t range = radii.units(i) + skin + largest[grid.key(grid.local(position[i]))];
    const CellGrid::Span x = grid.within(0, u.x, range), y = grid.within(1, u.y, range), z = grid.within(2, u.z, range);
    for (std::uint32_t a = 0; a < x.count; ++a)
      for (std::uint32_t b = 0; b < y.count; ++b) {
        const std::uint64_t row = grid.key({grid.at(0, x, a), grid.at(1, y, b), z.first});
        eachBetween(i, cellStart[row], cellStart[row + z.count], visit); // never periodic along z
      }
  }
  /// Visits neighbours among the sorted places [first, last).
  template <class Visit>
  GROUSER_HD void eachBetween(int i, std::uint32_t first, std::uint32_t last, const Visit& visit) const {
    const base::Position p = position[i];
    const std::int64_t own = radii.sphere ? radii.units(i) + skin : 0;
    for (std::uint32_t k = first; k < last; ++k) {
      const std::uint32_t j = slotAt ? slotAt[k] : k;
      if (static_cast<int>(j) == i) continue;
      const base::Vec3l apart = grid.period.apart(p, position[j]);
      if (!differencesHold(apart)) continue;
      const std::int64_t reach = radii.sphere ? own + radii.units(static_cast<int>(j)) : 0;
      if (base::squaredNorm(apart.as<std::int32_t>()) < (radii.sphere ? reach * reach : reach2)) visit(j);
    }
  }
  /// True if the cell is within the grid along x or y; wraps around at periodic boundaries.
  GROUSER_HD bool besides(int axis, std::uint32_t& c) const {
    const std::uint32_t cells = grid.cells[axis];
    if (grid.period.along(axis)) c = c == cells ? 0 : c > cells ? cells - 1 : c;
    return c < cells;
  }
};

/// Computes the maximum radius in each cell [units].
struct LargestInCell {
  RadiiInW radii;
  const std::uint32_t *cellStart, *slotAt;
  std::uint32_t* largest;
  GROUSER_HD void operator()(int c) const {
    std::int64_t most = 0;
    for (std::uint32_t k = cellStart[c]; k < cellStart[c + 1]; ++k) {
      const std::int64_t radius = radii.units(static_cast<int>(slotAt ? slotAt[k] : k));
      most = radius > most ? radius : most;
    }
    largest[c] = static_cast<std::uint32_t>(most);
  }
};

/// Computes the maximum over cells at most `reach` away along one axis.
struct LargestAlong {
  CellGrid grid;
  int axis, reach;
  const std::uint32_t* from;
  std::uint32_t* largest;
  GROUSER_HD void operator()(int key) const {
    std::int64_t stride = 1;
    for (int a = 2; a > axis; --a) stride *= grid.cells[a];
    const std::int64_t cells = grid.cells[axis], own = key / stride % cells;
    std::uint32_t most = 0;
    for (std::int64_t k = own - reach; k <= own + reach; ++k) {
      std::int64_t there = k;
      if (grid.period.along(axis)) there = k < 0 ? k + cells : k >= cells ? k - cells : k;
      if (there < 0 || there >= cells) continue;
      const std::uint32_t value = from[key + (there - own) * stride];
      most = value > most ? value : most;
    }
    largest[key] = most;
  }
};

/// Sorts nearby spheres by number of contacts, then by row length: interleaved rows are padded to the longest.
struct AssignContactKeys {
  static constexpr std::uint64_t kMax = 255; ///< larger numbers of contacts or neighbours count as this one
  TouchingRows former;
  const std::uint32_t* order; ///< previous slots, in cell order
  const std::uint32_t* rowOf; ///< row of the previous list by previous slot; null: equal to the slot
  std::uint32_t window;       ///< number of spheres sorted among themselves
  std::uint64_t* key;
  GROUSER_HD void operator()(int k) const {
    const std::uint32_t slot = order[k], row = rowOf ? rowOf[slot] : slot;
    const std::uint32_t contacts = former.contactsOf(row), listed = row < former.rowCount ? former.count[row] : 0;
    key[k] = static_cast<std::uint64_t>(k) / window << 16 | (contacts < kMax ? contacts : kMax) << 8 |
             (listed < kMax ? listed : kMax);
  }
};

/// Sets place[k]: position in cell order of the sphere in slot k.
struct TakePlaces {
  const std::uint32_t *place, *byCell;
  std::uint32_t *order, *slotAt;
  GROUSER_HD void operator()(int k) const {
    order[k] = byCell[place[k]];
    slotAt[place[k]] = static_cast<std::uint32_t>(k);
  }
};

struct CountNear {
  static constexpr double kNanoseconds = 150;
  NearSpheres near;
  std::uint32_t* count;
  GROUSER_HD void operator()(int i) const {
    std::uint32_t found = 0;
    near.each(i, [&found](std::uint32_t) { ++found; });
    count[i] = found;
  }
};

/// Writes a row: the slots near one sphere, in ascending order of their ids.
struct ListNear {
  static constexpr double kNanoseconds = 200;
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

/// Stores the sum of both radii with each neighbour, to avoid scattered reads every step.
struct ListReach {
  static constexpr double kNanoseconds = 25;
  RadiiInW radii;
  NeighbourRows rows;
  const std::uint32_t *count, *slot;
  std::uint32_t* reach;
  GROUSER_HD void operator()(int i) const {
    const std::uint32_t n = count[i];
    const std::int64_t own = n > 0 ? radii.units(i) : 0;
    for (std::uint32_t k = 0; k < n; ++k) {
      const std::int64_t at = rows.at(i, k);
      reach[at] = static_cast<std::uint32_t>(own + radii.units(static_cast<int>(slot[at])));
    }
  }
};

} // namespace grouser::contact
