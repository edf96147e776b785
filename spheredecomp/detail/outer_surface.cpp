// SPDX-License-Identifier: BSD-3-Clause
#include "spheredecomp/detail/outer_surface.hpp"

#include <array>
#include <cmath>
#include <utility>

namespace grouser::spheredecomp::detail {
namespace {

using Corners = std::array<Vec3d, 3>;

double triangleArea(const Corners& t) { return norm(cross(t[1] - t[0], t[2] - t[0])) / 2; }
Vec3d centroid(const Corners& t) { return (t[0] + t[1] + t[2]) * (1.0 / 3); }

/// Returns the longest edge: its index k (from corner k to k + 1) and its length.
std::pair<std::size_t, double> longestEdge(const Corners& t) {
  std::size_t best = 0;
  double best2 = -1;
  for (std::size_t k = 0; k < 3; ++k)
    if (const double l2 = norm2(t[(k + 1) % 3] - t[k]); l2 > best2) best2 = l2, best = k;
  return {best, sqrt(best2)};
}

/// Splits a triangle at the middle of edge k; both halves keep its orientation.
std::pair<Corners, Corners> bisect(const Corners& t, std::size_t k) {
  const Vec3d middle = (t[k] + t[(k + 1) % 3]) * 0.5;
  const Vec3d& apex = t[(k + 2) % 3];
  return {Corners{t[k], middle, apex}, Corners{middle, t[(k + 1) % 3], apex}};
}

/// True if two triangles are within about `gap` of each other, i.e. no axis separates them. Tests both normals, the
/// nine cross products of edges and, for coplanar triangles, the in-plane normals of the edges.
bool meet(const Corners& a, const Corners& b, double gap) {
  auto separated = [&](const Vec3d& axis) {
    const double length2 = norm2(axis);
    if (length2 == 0) return false;
    double lowA = 1e300, highA = -1e300, lowB = 1e300, highB = -1e300;
    for (std::size_t k = 0; k < 3; ++k) {
      const double pa = dot(axis, a[k] - a[0]), pb = dot(axis, b[k] - a[0]);
      lowA = pa < lowA ? pa : lowA, highA = pa > highA ? pa : highA;
      lowB = pb < lowB ? pb : lowB, highB = pb > highB ? pb : highB;
    }
    const double margin = gap * sqrt(length2);
    return lowA > highB + margin || lowB > highA + margin;
  };
  const Corners edgesA = {a[1] - a[0], a[2] - a[1], a[0] - a[2]}, edgesB = {b[1] - b[0], b[2] - b[1], b[0] - b[2]};
  const Vec3d normalA = cross(edgesA[0], edgesA[1]), normalB = cross(edgesB[0], edgesB[1]);
  if (separated(normalA) || separated(normalB)) return false;
  for (std::size_t k = 0; k < 3; ++k)
    if (separated(cross(edgesA[k], normalA)) || separated(cross(edgesB[k], normalB))) return false;
  for (const Vec3d& u : edgesA)
    for (const Vec3d& v : edgesB)
      if (separated(cross(u, v))) return false;
  return true;
}

/// Classifies the pieces of the mesh's triangles as outer surface or inside.
struct Sorter {
  const MeshQuery& solid;
  double resolution, gap;
  TriangleMesh outer{};
  std::vector<std::uint32_t> parent{};
  std::vector<double> weight{};

  Corners corners(std::uint32_t t) const { return {solid.vertex(t, 0), solid.vertex(t, 1), solid.vertex(t, 2)}; }

  bool sharesVertex(std::uint32_t s, std::uint32_t t) const {
    const auto& index = solid.mesh().indices;
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t k = 0; k < 3; ++k)
        if (index[3 * s + i] == index[3 * t + k]) return true;
    return false;
  }

  void sortTriangle(std::uint32_t t) {
    const Corners c = corners(t);
    if (triangleArea(c) == 0) return;
    const Vec3d margin{gap, gap, gap};
    std::vector<std::uint32_t> near, cutters;
    solid.overlapping(base::min(c[0], base::min(c[1], c[2])) - margin, base::max(c[0], base::max(c[1], c[2])) + margin,
                      near);
    for (const std::uint32_t s : near)
      if (!sharesVertex(s, t) && meet(c, corners(s), gap)) cutters.push_back(s);
    sortPiece(c, t, cutters);
  }

  /// Bisects a piece until no other triangle intersects it or its size is `resolution`, then keeps the parts on the
  /// outer surface.
  void sortPiece(const Corners& c, std::uint32_t t, const std::vector<std::uint32_t>& cutters) {
    std::vector<std::uint32_t> still;
    for (const std::uint32_t s : cutters)
      if (meet(c, corners(s), gap)) still.push_back(s);
    if (const auto [edge, length] = longestEdge(c); !still.empty() && length > resolution) {
      const auto [left, right] = bisect(c, edge);
      sortPiece(left, t, still);
      sortPiece(right, t, still);
      return;
    }
    const Vec3d middle = centroid(c), step = solid.normal(t) * gap;
    if (solid.winding(middle + step) != 0) return;
    // Coincident faces change the winding number together; each counts as a fraction.
    const int within = std::abs(solid.winding(middle - step));
    if (within == 0) return;
    for (const Vec3d& v : c) {
      outer.indices.push_back(static_cast<std::uint32_t>(outer.vertices.size()));
      outer.vertices.push_back(v);
    }
    parent.push_back(t);
    weight.push_back(1.0 / within);
  }
};

} // namespace

OuterSurface::OuterSurface(const TriangleMesh& mesh, double resolution) : solid_(mesh), surface_(TriangleMesh{}) {
  const auto [low, high] = bounds(mesh);
  Sorter sorter{.solid = solid_, .resolution = resolution, .gap = 1e-6 * norm(high - low)};
  for (std::uint32_t t = 0; t < mesh.indices.size() / 3; ++t) sorter.sortTriangle(t);
  parent_ = std::move(sorter.parent);
  weight_ = std::move(sorter.weight);
  surface_ = MeshQuery(std::move(sorter.outer));
  // Divergence theorem over the outer surface: 3 V = integral of normal . (x - origin).
  const Vec3d origin = (low + high) * 0.5;
  for (std::uint32_t t = 0; t < parent_.size(); ++t) {
    const double piece =
        weight_[t] * triangleArea({surface_.vertex(t, 0), surface_.vertex(t, 1), surface_.vertex(t, 2)});
    area_ += piece;
    volume_ += piece * dot(normal(t), surface_.vertex(t, 0) - origin) / 3;
  }
}

std::vector<SurfaceSample> OuterSurface::samples(double spacing) const {
  // After the last bisection, the pieces are between half of this length and this length; their mean area is spacing^2.
  const double longest = 2 * spacing;
  std::vector<SurfaceSample> result;
  std::vector<Corners> stack;
  for (std::uint32_t t = 0; t < parent_.size(); ++t) {
    stack.push_back({surface_.vertex(t, 0), surface_.vertex(t, 1), surface_.vertex(t, 2)});
    while (!stack.empty()) {
      const Corners c = stack.back();
      stack.pop_back();
      if (const auto [edge, length] = longestEdge(c); length > longest) {
        const auto [left, right] = bisect(c, edge);
        stack.push_back(right);
        stack.push_back(left);
      } else {
        result.push_back({centroid(c), normal(t), weight_[t] * triangleArea(c)});
      }
    }
  }
  return result;
}

} // namespace grouser::spheredecomp::detail
