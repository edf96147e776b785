// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scm/compaction.hpp"
#include "terrain/height_field.hpp"

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <unordered_map>
#include <vector>

namespace grouser::scm {

/// A node of the grid, which stands for a square of soil around it.
struct Node {
  double height{};   ///< of the undisturbed surface [m]
  double cosine = 1; ///< between the normal of that surface and the vertical [-]
  Compaction state;  ///< sinkage is measured along the normal of the undisturbed surface
  int touched = -1;  ///< index among the nodes under pads within a step; not saved
};

/// A grid of soil nodes in square tiles, allocated when a pad first approaches: memory grows with the touched ground, not
/// with the terrain.
class SoilMap {
public:
  static constexpr int kTile = 16; ///< nodes along a side of a tile

  /// `surface`: height and slopes of the undisturbed surface. `spacing` [m] > 0.
  SoilMap(double spacing, std::function<terrain::SurfaceJet(double x, double y)> surface)
      : spacing_(spacing), surface_(std::move(surface)) {}

  double spacing() const { return spacing_; }
  /// Node at x = i spacing, y = j spacing; the reference stays valid.
  Node& at(std::int32_t i, std::int32_t j) {
    Tile& tile = tileOf(i >> kShift, j >> kShift);
    return tile.nodes[placeInTile(i, j)];
  }
  /// Depth of the unloaded surface below the undisturbed one at (x, y) [m], linear between nodes.
  double rutAt(double x, double y) const;
  /// Calls look(i, j, node) for all nodes, in an order that depends on their positions only.
  void forEach(const std::function<void(std::int32_t, std::int32_t, const Node&)>& look) const;

private:
  static constexpr int kShift = 4, kMask = kTile - 1;
  struct Tile {
    std::array<Node, static_cast<std::size_t>(kTile) * kTile> nodes;
  };
  static std::size_t placeInTile(std::int32_t i, std::int32_t j) {
    return static_cast<std::size_t>(j & kMask) * kTile + static_cast<std::size_t>(i & kMask);
  }
  static std::uint64_t key(std::int32_t tileX, std::int32_t tileY) {
    return (static_cast<std::uint64_t>(static_cast<std::uint32_t>(tileY)) << 32) | static_cast<std::uint32_t>(tileX);
  }
  Tile& tileOf(std::int32_t tileX, std::int32_t tileY) {
    const std::uint64_t wanted = key(tileX, tileY);
    if (last_ && lastKey_ == wanted) return *last_;
    const auto found = tiles_.find(wanted);
    last_ = found != tiles_.end() ? found->second.get() : &make(tileX, tileY);
    lastKey_ = wanted;
    return *last_;
  }
  Tile& make(std::int32_t tileX, std::int32_t tileY);
  const Node* find(std::int32_t i, std::int32_t j) const;

  double spacing_;
  std::function<terrain::SurfaceJet(double, double)> surface_;
  std::unordered_map<std::uint64_t, std::unique_ptr<Tile>> tiles_;
  Tile* last_{};
  std::uint64_t lastKey_{};
};

} // namespace grouser::scm
