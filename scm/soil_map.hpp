// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/math.hpp"
#include "scm/compaction.hpp"
#include "terrain/height_field.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <unordered_map>
#include <vector>

namespace grouser::scm {

/// Unit of the thickness of loose soil [m]: transport between nodes conserves volume exactly.
inline constexpr double kHeightQuantum = 1.0 / (1 << 30);

/// Node of the soil grid, which represents a square of soil around it.
struct Node {
  double height{};            ///< height of the undisturbed surface [m]
  double cosine = 1;          ///< cosine of the angle between the normal of that surface and the vertical [-]
  Compaction state;           ///< firm soil; sinkage is along the normal, from the surface lowered by slipSinkage
  double slipSinkage{};       ///< additional sinkage by shear [m]
  Compaction loose;           ///< compaction state of the loose soil, below its own surface
  std::int64_t looseQuanta{}; ///< vertical thickness of loose soil as deposited [kHeightQuantum]
  double displaced{};         ///< pending displaced soil, as a vertical thickness [m]
  double spared{};  ///< sinkage minus mean sinkage of the square, where bodies cover a part of it, along the normal [m]
  int touched = -1; ///< index among the nodes in contact within a step; not saved

  bool isLoaded() const { return state.stiffness > 0 || looseQuanta != 0 || slipSinkage > 0; }
  /// Depth of the unloaded firm soil surface below the undisturbed surface, along the normal [m].
  double firmDepth() const { return slipSinkage + state.rebound(); }
  double looseThickness() const { return static_cast<double>(looseQuanta) * kHeightQuantum; } ///< as deposited [m]
  /// Depth of the unloaded surface below the undisturbed one, vertical [m], mean over the square; negative in a berm.
  double rut() const { return (firmDepth() + loose.rebound() - spared) / cosine - looseThickness(); }
  double surface() const { return height - rut(); } ///< height of the unloaded surface [m]
};

/// Interpolates a grid of this spacing bilinearly at (x, y); `valueAt`: value of node (i, j).
template <class Value> double interpolate(double x, double y, double spacing, const Value& valueAt) {
  const auto i = static_cast<std::int32_t>(std::floor(x / spacing)),
             j = static_cast<std::int32_t>(std::floor(y / spacing));
  const double u = x / spacing - i, v = y / spacing - j;
  return (1 - v) * ((1 - u) * valueAt(i, j) + u * valueAt(i + 1, j)) +
         v * ((1 - u) * valueAt(i, j + 1) + u * valueAt(i + 1, j + 1));
}

/// Grid of soil nodes in square tiles, allocated when a contact first approaches: memory grows with the touched area,
/// not with the terrain.
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
  /// Undisturbed surface at (x, y).
  terrain::SurfaceJet jetAt(double x, double y) const { return surface_(x, y); }
  /// Unit normal of the undisturbed surface at a node, upwards.
  base::Vec3d normalAt(std::int32_t i, std::int32_t j) const {
    const terrain::SurfaceJet jet = surface_(spacing_ * i, spacing_ * j);
    const double up = 1 / std::sqrt(1 + jet.hx * jet.hx + jet.hy * jet.hy);
    return {-jet.hx * up, -jet.hy * up, up};
  }
  /// Adds loose soil to a node, or removes it [kHeightQuantum]. All changes must use this function.
  void addLoose(Node& node, std::int64_t quanta) {
    node.looseQuanta += quanta, maxLoose_ = std::max(maxLoose_, node.looseThickness());
  }
  /// Upper bound of the surface height at the nodes i0 ... i1, j0 ... j1 [m].
  double topOf(std::int32_t i0, std::int32_t i1, std::int32_t j0, std::int32_t j1);
  /// Depth of the unloaded surface below the undisturbed one at (x, y) [m], linear between nodes; negative in a berm.
  double rutAt(double x, double y) const;
  /// Height of the unloaded surface at (x, y) [m], linear between nodes.
  double surfaceAt(double x, double y);
  static std::int32_t tileAt(std::int32_t index) { return index >> kShift; } ///< row or column of the tile of a node
  /// Calls look(i, j, node) for all nodes, in an order that depends only on their positions.
  void forEach(const std::function<void(std::int32_t, std::int32_t, const Node&)>& look) const;

private:
  static constexpr int kShift = 4, kMask = kTile - 1;
  struct Tile {
    std::array<Node, static_cast<std::size_t>(kTile) * kTile> nodes;
    double top = -base::kInfinity; ///< maximum height of the undisturbed surface [m]
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
  double maxLoose_{}; ///< upper bound of the thickness of loose soil [m]
  Tile* last_{};
  std::uint64_t lastKey_{};
};

} // namespace grouser::scm
