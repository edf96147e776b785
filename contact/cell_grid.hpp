// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/period.hpp"
#include "base/position.hpp"
#include "base/vec.hpp"

#include <cstdint>

namespace grouser::contact {

/// Dense grid over the cells in use; z runs fastest, so the three cells of a column are neighbours in memory. Along
/// periodic boundaries it is a ring of cells that fills the period, none narrower than `edge` asks.
struct CellGrid {
  using Cell = base::Vec3<std::uint32_t>;
  base::Period period;
  base::Vec3l edge{}; ///< [units]
  Cell low{}, cells{};

  /// Sets the edges, at least `least`, and the rings; bounds of the other axes are the caller's to find.
  void setEdge(std::int64_t least);
  GROUSER_HD std::uint64_t key(const Cell& c) const {
    return (static_cast<std::uint64_t>(c.x) * cells.y + c.y) * cells.z + c.z;
  }
  /// Counted from the lowest representable position, or from the lower of two periodic boundaries.
  GROUSER_HD Cell cellOf(const base::Position& p) const {
    constexpr std::int64_t kBias = std::int64_t{1} << 41;
    const base::Vec3l u = base::toUnits(p);
    Cell c;
    for (int a = 0; a < 3; ++a) {
      if (period.along(a)) {
        const std::int64_t inside = u[a] + period.periodsBack(a, u[a]) * period.length[a] - period.low[a];
        const auto k = static_cast<std::uint32_t>(inside / edge[a]);
        c[a] = k < cells[a] ? k : cells[a] - 1; // the last cell holds what the division leaves over
      } else {
        c[a] = static_cast<std::uint32_t>((u[a] + kBias) / edge[a]);
      }
    }
    return c;
  }
  GROUSER_HD Cell local(const base::Position& p) const { return cellOf(p) - low; }
};

} // namespace grouser::contact
