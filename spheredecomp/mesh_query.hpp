// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "spheredecomp/mesh.hpp"

#include <cstdint>
#include <vector>

namespace grouser::spheredecomp {

inline constexpr std::uint32_t kNone = 0xFFFFFFFFu; ///< no triangle

/// Nearest point of a mesh to a query point.
struct ClosestPoint {
  Vec3d point;              ///< [m]
  double distance{};        ///< [m], >= 0
  std::uint32_t triangle{}; ///< index of the triangle; among equally near triangles, the lowest index
};

/// Crossing of a vertical line with the mesh.
struct Crossing {
  double z{}; ///< [m]
  int step{}; ///< change of the winding number along the line downwards: +1 at entry through an upper face
};

/// Distance and inside/outside queries on a triangle mesh, by a bounding-box tree. Immutable after construction, hence
/// thread-safe.
class MeshQuery {
public:
  /// Copies the mesh. Winding numbers require a closed mesh; distances do not.
  explicit MeshQuery(TriangleMesh mesh);

  /// Returns the nearest surface point within `limit` [m]; if there is none, triangle = kNone and distance = limit.
  ClosestPoint closest(const Vec3d& p, double limit = 1e300) const;

  /// True if any surface point is nearer than `distance` [m]; stops at the first such point.
  bool within(const Vec3d& p, double distance) const;

  /// Writes all crossings of the vertical line through (x, y) to `crossings`, from top to bottom; clears it first.
  void column(double x, double y, std::vector<Crossing>& crossings) const;

  /// Winding number of the mesh about `p`, i.e. the number of enclosing shells: the sum of signed crossings of a
  /// vertical ray. A point on the surface may count as inside or outside.
  int winding(const Vec3d& p) const;
  bool inside(const Vec3d& p) const { return winding(p) != 0; }

  /// Distance to the surface [m], negative inside.
  double signedDistance(const Vec3d& p) const;

  /// Indices of triangles with bounding boxes that overlap the box [low, high], ascending.
  void overlapping(const Vec3d& low, const Vec3d& high, std::vector<std::uint32_t>& triangles) const;

  const TriangleMesh& mesh() const { return mesh_; }
  const Vec3d& vertex(std::uint32_t triangle, int corner) const {
    return mesh_.vertices[mesh_.indices[3 * triangle + static_cast<std::uint32_t>(corner)]];
  }
  /// Outward unit normal of a triangle.
  const Vec3d& normal(std::uint32_t triangle) const { return normals_[triangle]; }

private:
  struct Node {
    Vec3d low, high;
    std::uint32_t first{}; ///< first entry of order_ (leaf) or left child (the right one follows it)
    std::uint32_t count{}; ///< triangles of a leaf, 0 for an inner node
  };
  void build(std::uint32_t node, std::uint32_t begin, std::uint32_t end);
  template <class Visit> void visitColumn(double x, double y, double zMin, Visit&& visit) const;

  TriangleMesh mesh_;
  std::vector<Vec3d> normals_;
  std::vector<std::uint32_t> order_;
  std::vector<Node> nodes_;
};

} // namespace grouser::spheredecomp
