// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/vec.hpp"

#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace grouser::spheredecomp::detail {

/// Points binned in cubic cells, for spatial search. Points in a cell keep their insertion order.
class PointGrid {
public:
  /// @param cell  edge of a cell [m], > 0
  explicit PointGrid(double cell) : scale_(1 / cell) {}

  void add(const base::Vec3d& p, std::uint32_t id) { cells_[key(index(p.x), index(p.y), index(p.z))].push_back(id); }

  /// Calls visit(id) for the points in all cells that overlap the cube of half edge `reach` [m] about p, until a call
  /// returns true. Returns true if a call did.
  template <class Visit> bool any(const base::Vec3d& p, double reach, Visit&& visit) const {
    for (std::int64_t i = index(p.x - reach), i1 = index(p.x + reach); i <= i1; ++i)
      for (std::int64_t j = index(p.y - reach), j1 = index(p.y + reach); j <= j1; ++j)
        for (std::int64_t k = index(p.z - reach), k1 = index(p.z + reach); k <= k1; ++k)
          if (const auto cell = cells_.find(key(i, j, k)); cell != cells_.end())
            for (const std::uint32_t id : cell->second)
              if (visit(id)) return true;
    return false;
  }

  /// Calls visit(id) for all points in these cells.
  template <class Visit> void each(const base::Vec3d& p, double reach, Visit&& visit) const {
    any(p, reach, [&](std::uint32_t id) {
      visit(id);
      return false;
    });
  }

private:
  std::int64_t index(double x) const { return static_cast<std::int64_t>(std::floor(x * scale_)); }
  /// Cell key with 21 bits per axis, offset to be positive: a million cells in each direction.
  static std::uint64_t key(std::int64_t i, std::int64_t j, std::int64_t k) {
    constexpr std::int64_t kOffset = 1 << 20;
    return static_cast<std::uint64_t>(i + kOffset) << 42 | static_cast<std::uint64_t>(j + kOffset) << 21 |
           static_cast<std::uint64_t>(k + kOffset);
  }

  double scale_;
  std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> cells_;
};

} // namespace grouser::spheredecomp::detail
