// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/period.hpp"
#include "base/position.hpp"
#include "base/vec.hpp"

#include <cstdint>

namespace grouser::contact {

/// Dense grid over the occupied cells; z runs fastest, so the three cells of a column are adjacent in memory. Along
/// periodic axes the cells are at least `edge` wide, fill the period, and wrap around.
struct CellGrid {
  using Cell = base::Vec3<std::uint32_t>;
  base::Period period;
  base::Vec3l edge{}; ///< [units]
  Cell low{}, cells{};

  /// Sets the cell edges to at least `least`, and the periodic axes. The caller sets the bounds of the other axes.
  void setEdge(std::int64_t least);
  GROUSER_HD std::uint64_t key(const Cell& c) const {
    return (static_cast<std::uint64_t>(c.x) * cells.y + c.y) * cells.z + c.z;
  }
  /// Cell of a position, counted from the lowest representable position or from the lower periodic boundary.
  GROUSER_HD Cell cellOf(const base::Position& p) const {
    constexpr std::int64_t kBias = std::int64_t{1} << 41;
    const base::Vec3l u = base::toUnits(p);
    Cell c;
    for (int a = 0; a < 3; ++a) {
      if (period.along(a)) {
        const std::int64_t inside = u[a] + period.periodsBack(a, u[a]) * period.length[a] - period.low[a];
        const auto k = static_cast<std::uint32_t>(inside / edge[a]);
        c[a] = k < cells[a] ? k : cells[a] - 1; // the last cell includes the remainder of the division
      } else {
        c[a] = static_cast<std::uint32_t>((u[a] + kBias) / edge[a]);
      }
    }
    return c;
  }
  GROUSER_HD Cell local(const base::Position& p) const { return cellOf(p) - low; }

  /// Range of cells along an axis, starting at `first`; wraps around at periodic boundaries.
  struct Span {
    std::uint32_t first, count;
  };
  /// Range of cells that contain all points within `range` [units] of coordinate `u`.
  GROUSER_HD Span within(int axis, std::int64_t u, std::int64_t range) const {
    constexpr std::int64_t kBias = std::int64_t{1} << 41;
    const std::int64_t all = cells[axis];
    if (!period.along(axis)) {
      const std::int64_t from = (u + kBias - range) / edge[axis] - low[axis];
      const std::int64_t to = (u + kBias + range) / edge[axis] - low[axis];
      const std::int64_t first = from > 0 ? from : 0, last = to < all ? to : all - 1;
      return {static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(last - first + 1)};
    }
    // The last cell is wider than `edge`, since it includes the remainder of the division. The range may therefore
    // contain more cells than needed, but never fewer.
    const std::int64_t inside = u + period.periodsBack(axis, u) * period.length[axis] - period.low[axis];
    const std::int64_t own = inside / edge[axis] < all ? inside / edge[axis] : all - 1;
    const std::int64_t below = inside - own * edge[axis];
    const std::int64_t down = below < range ? (range - below + edge[axis] - 1) / edge[axis] : 0;
    const std::int64_t up = (below + range) / edge[axis];
    if (down + up + 1 >= all) return {0, cells[axis]};
    const std::int64_t first = own >= down ? own - down : own - down + all;
    return {static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(down + up + 1)};
  }
  /// The k-th cell of a span.
  GROUSER_HD std::uint32_t at(int axis, const Span& span, std::uint32_t k) const {
    const std::uint32_t c = span.first + k;
    return c < cells[axis] ? c : c - cells[axis];
  }
};

} // namespace grouser::contact
