// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "contact/part_motion.hpp"
#include "scm/facets.hpp"
#include "scm/polygon.hpp"
#include "scm/soil_map.hpp"

#include <cstdint>
#include <vector>

namespace grouser::scm {

/// Part of a facet below or near a node's square, seen along the normal of the undisturbed surface. In a Polygon, x and
/// y are the place relative to the node, on the surface, and z is the depth along that normal [m].
struct Piece {
  Polygon outline;
  Vec3d up;                           ///< unit normal into the body, world
  double cosine{};                    ///< cosine of the angle between `up` and the normal of the soil surface, > 0
  double level{}, slopeX{}, slopeY{}; ///< depth of the facet's plane [m]: level + slopeX x + slopeY y
  std::size_t solid{};

  double depthAt(const Vec3d& p) const { return level + slopeX * p.x + slopeY * p.y; }
};

/// Square of a node with the underside of a body.
struct Cell {
  std::int32_t i{}, j{};
  Node* node{};
  Vec3d normal;              ///< normal of the undisturbed surface
  std::vector<Piece> pieces; ///< do not cover each other

  /// World position of a point of a Piece.
  Vec3d toWorld(double spacing, const Vec3d& p) const {
    const double z = node->height - (normal.x * p.x + normal.y * p.y) / normal.z;
    return Vec3d{spacing * i + p.x, spacing * j + p.y, z} - normal * p.z;
  }
};

/// Underside of a rigid body, i.e. its surface seen from below along the normal of the undisturbed soil surface, cut by
/// the squares of the nodes: exact areas and depths for plane facets, of several solids that may overlap, at any tilt.
class Underside {
public:
  /// `count` solids of one body from `solids`; `motion`: indexed by part.
  void cut(SoilMap& map, const Solid* solids, std::size_t count, const contact::PartMotion* motion);

  /// Cells with pieces that are below the surface, or not farther above it than kNear and the slope of the piece.
  /// Ordered by j, then i.
  const std::vector<Cell>& cells() const { return cells_; }

private:
  void recycle();
  void add(const Facet& facet, std::size_t solid, const contact::PartMotion& motion, double spacing);
  /// Adds the part of the facet with corners_ in the cell's square.
  void addTo(Cell& cell, const Vec3d& up, std::size_t solid, double spacing);
  void removeCovered(Cell& cell, const Solid* solids, double sliver);

  std::int32_t firstI_{}, firstJ_{}, columns_{}, rows_{};
  std::vector<Cell> grid_; ///< by row
  std::vector<Cell> cells_;
  double leastTurned_{};          ///< vertical component of Piece::up below which a facet faces away from all cells
  double lowest_{};               ///< height of the lowest node [m]
  double highest_{};              ///< height above which facets cannot reach the soil [m]
  std::vector<Vec3d> corners_;    ///< corners of a facet, world
  Polygon one_, other_;           ///< scratch
  std::vector<Polygon> outlines_; ///< spare
};

} // namespace grouser::scm
