// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scm/soil_map.hpp"

#include <cstdint>
#include <set>
#include <vector>

namespace grouser::scm {

class NumberStream;

/// Loose soil beside ruts. Soil displaced sideways is deposited next to the body, and slides down slopes steeper than
/// the angle of repose. Thicknesses are integers, so that transport conserves volume exactly. Soil under bodies does
/// not slide, and walls of firm soil are stable.
class Berms {
public:
  /// `repose`: tangent of the angle of repose.
  Berms(SoilMap& map, double repose) : map_(map), steepest_(repose * map.spacing()) {}

  /// Moves the displaced soil of a node outward from (x, y) along the horizontal unit vector (dx, dy), to the nearest
  /// node without contact. If no such node is within kFarthest nodes, the soil remains pending.
  void deposit(Node& from, double x, double y, double dx, double dy);
  /// Performs one sweep over the tiles with moved soil. Each pair of neighbours halves its height excess over the
  /// slope of repose.
  void slide();

  double moved() const {
    return static_cast<double>(moved_) * kHeightQuantum * map_.spacing() * map_.spacing();
  } ///< [m3]

  void save(NumberStream& numbers) const;
  void restore(NumberStream& numbers);

private:
  static constexpr int kFarthest = 8;
  using Place = std::pair<std::int32_t, std::int32_t>; ///< row, column

  void slide(std::int32_t i, std::int32_t j, std::int32_t di, std::int32_t dj, std::set<Place>& active);

  SoilMap& map_;
  double steepest_;        ///< height between neighbours at the angle of repose [m]
  std::set<Place> active_; ///< tiles to sweep
  std::int64_t moved_ = 0; ///< total deposited since the start [kHeightQuantum]
};

} // namespace grouser::scm
