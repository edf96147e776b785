// SPDX-License-Identifier: BSD-3-Clause
#include "spheredecomp/mesh_box.hpp"

#include "base/math.hpp"
#include "spheredecomp/mesh.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace grouser::spheredecomp {

namespace {

/// Permitted deviation of a vertex from the box [largest coordinate], and at most [shortest edge].
constexpr double kBoxRounding = 4e-6, kBoxRoundingOfEdge = 2e-3;
constexpr double kBoxVolume = 0.01; // permitted relative error of the volume

using Axes = std::array<Vec3d, 3>; ///< right-handed unit vectors

Vec3d along(const Axes& axes, const Vec3d& p) { return {dot(axes[0], p), dot(axes[1], p), dot(axes[2], p)}; }
Vec3d fromAxes(const Axes& axes, const Vec3d& p) { return axes[0] * p.x + axes[1] * p.y + axes[2] * p.z; }

/// Corners of the bounding box along the axes.
std::pair<Vec3d, Vec3d> boundsAlong(const TriangleMesh& mesh, const Axes& axes) {
  Vec3d low = along(axes, mesh.vertices[mesh.indices[0]]), high = low;
  for (const std::uint32_t i : mesh.indices) {
    const Vec3d p = along(axes, mesh.vertices[i]);
    low = base::min(low, p), high = base::max(high, p);
  }
  return {low, high};
}

/// Normal of the largest triangle with a normal unlike `other` (zero: any), with the length of twice its area.
Vec3d largestNormal(const TriangleMesh& mesh, const Vec3d& other) {
  constexpr double kUnlike = 0.5; // cosine
  Vec3d largest;
  for (std::size_t t = 0; t + 2 < mesh.indices.size(); t += 3) {
    const Vec3d& a = mesh.vertices[mesh.indices[t]];
    const Vec3d n = cross(mesh.vertices[mesh.indices[t + 1]] - a, mesh.vertices[mesh.indices[t + 2]] - a);
    if (norm2(n) > norm2(largest) && std::fabs(dot(n, other)) <= kUnlike * norm(n)) largest = n;
  }
  return largest;
}

/// Directions of the edges between the vertices that are nearest to the corners of the box along approximate axes;
/// more accurate than the normals of small triangles. The longest edges have the smallest errors and come first.
Axes edgeDirections(const TriangleMesh& mesh, const Axes& rough) {
  const auto [low, high] = boundsAlong(mesh, rough);
  const Vec3d middle = (low + high) * 0.5, half = (high - low) * 0.5;
  std::array<Vec3d, 8> corners;
  std::array<double, 8> farthest;
  farthest.fill(-base::kInfinity);
  for (const std::uint32_t i : mesh.indices) {
    const Vec3d p = along(rough, mesh.vertices[i]) - middle;
    for (std::size_t c = 0; c < 8; ++c) {
      double reach = 0;
      for (int k = 0; k < 3; ++k) reach += (c >> k & 1 ? 1 : -1) * p[k] / half[k];
      if (reach > farthest[c]) farthest[c] = reach, corners[c] = mesh.vertices[i];
    }
  }
  Axes edges;
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t c = 0; c < 8; ++c) edges[k] += corners[c] * (c >> k & 1 ? 1.0 : -1.0);
  std::sort(edges.begin(), edges.end(), [](const Vec3d& a, const Vec3d& b) { return norm2(a) > norm2(b); });
  const Vec3d x = normalized(edges[0]), y = normalized(edges[1] - x * dot(edges[1], x));
  return {x, y, cross(x, y)};
}

/// Renames and reverses the axes, so that the rotation from the mesh's frame is the smallest one.
Axes nearestToFrame(const Axes& axes) {
  Axes best = axes;
  double most = -base::kInfinity; // trace of the rotation
  std::array<int, 3> order{0, 1, 2};
  do {
    for (unsigned signs = 0; signs < 4; ++signs) {
      const Vec3d x = axes[static_cast<std::size_t>(order[0])] * (signs & 1 ? -1.0 : 1.0);
      const Vec3d y = axes[static_cast<std::size_t>(order[1])] * (signs & 2 ? -1.0 : 1.0), z = cross(x, y);
      if (x.x + y.y + z.z > most) most = x.x + y.y + z.z, best = {x, y, z};
    }
  } while (std::next_permutation(order.begin(), order.end()));
  return best;
}

/// Rotation from the axes' frame; the angle is below 90 degrees.
base::Quat rotationOf(const Axes& a) {
  const double w = 0.5 * std::sqrt(1 + a[0].x + a[1].y + a[2].z), s = 0.25 / w;
  return base::Quat{w, (a[1].z - a[2].y) * s, (a[2].x - a[0].z) * s, (a[0].y - a[1].x) * s}.normalized();
}

/// True if all triangles are on the faces of the bounding box along the axes, and enclose its volume once.
bool boundsBox(const TriangleMesh& mesh, const Axes& axes) {
  const std::pair<Vec3d, Vec3d> corners = boundsAlong(mesh, axes);
  const Vec3d &low = corners.first, &high = corners.second, size = high - low;
  const double shortest = std::min({size.x, size.y, size.z}), volume = size.x * size.y * size.z;
  double largest = 0;
  for (const std::uint32_t i : mesh.indices) {
    const Vec3d& v = mesh.vertices[i];
    largest = std::max({largest, std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)});
  }
  const double rounding = std::min(kBoxRounding * largest, kBoxRoundingOfEdge * shortest);
  const auto facesOf = [&](std::uint32_t vertex) { // bits of the faces on which it is
    const Vec3d p = along(axes, mesh.vertices[vertex]);
    unsigned faces = 0;
    for (int k = 0; k < 3; ++k)
      faces |= (p[k] - low[k] <= rounding ? 1u : 0u) << (2 * k) | (high[k] - p[k] <= rounding ? 2u : 0u) << (2 * k);
    return faces;
  };
  for (std::size_t t = 0; t + 2 < mesh.indices.size(); t += 3)
    if ((facesOf(mesh.indices[t]) & facesOf(mesh.indices[t + 1]) & facesOf(mesh.indices[t + 2])) == 0) return false;
  return volume > 0 && std::fabs(signedVolume(mesh) - volume) <= kBoxVolume * volume;
}

} // namespace

std::optional<MeshBox> exactBox(const base::TriangleMesh& mesh) {
  const Vec3d first = largestNormal(mesh, {});
  const Vec3d second = norm(first) > 0 ? largestNormal(mesh, normalized(first)) : Vec3d{};
  if (!(norm(second) > 0)) return {};
  Axes axes{Vec3d{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const bool aligned = boundsBox(mesh, axes);
  if (!aligned) {
    const Vec3d x = normalized(first), y = normalized(second - x * dot(second, x));
    if (const auto [low, high] = boundsAlong(mesh, {x, y, cross(x, y)}); !(high.z > low.z)) return {};
    axes = nearestToFrame(edgeDirections(mesh, {x, y, cross(x, y)}));
    if (!boundsBox(mesh, axes)) return {};
  }
  const auto [low, high] = boundsAlong(mesh, axes);
  return MeshBox{fromAxes(axes, (low + high) * 0.5), (high - low) * 0.5, aligned ? base::Quat{} : rotationOf(axes)};
}

} // namespace grouser::spheredecomp
