// SPDX-License-Identifier: BSD-3-Clause
#include "spheredecomp/mesh_query.hpp"

#include "base/math.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace grouser::spheredecomp {
namespace {

constexpr std::uint32_t kLeafSize = 4;
/// Depth of the traversal stack: each level halves the triangles, so 64 levels suffice for any mesh.
constexpr std::size_t kStack = 64;

/// Squared distance from a point to a box, 0 inside.
double boxDistance2(const Vec3d& low, const Vec3d& high, const Vec3d& p) {
  double sum = 0;
  for (int k = 0; k < 3; ++k) {
    const double d = p[k] < low[k] ? low[k] - p[k] : p[k] > high[k] ? p[k] - high[k] : 0;
    sum += d * d;
  }
  return sum;
}

/// Nearest point of the segment ab.
Vec3d closestOnSegment(const Vec3d& a, const Vec3d& b, const Vec3d& p) {
  const Vec3d ab = b - a;
  const double length2 = norm2(ab);
  const double t = length2 > 0 ? dot(p - a, ab) / length2 : 0;
  return t <= 0 ? a : t >= 1 ? b : a + ab * t;
}

/// Nearest point of the triangle abc: the foot of the perpendicular if it is inside, else on the nearest edge.
Vec3d closestOnTriangle(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& p) {
  const Vec3d ab = b - a, ac = c - a, n = cross(ab, ac);
  const double n2 = norm2(n);
  if (n2 > 0) {
    const Vec3d ap = p - a;
    const double v = dot(cross(ap, ac), n), w = dot(cross(ab, ap), n); // barycentric times n2
    if (v >= 0 && w >= 0 && v + w <= n2) return a + ab * (v / n2) + ac * (w / n2);
  }
  const std::array<Vec3d, 3> edges = {closestOnSegment(a, b, p), closestOnSegment(b, c, p), closestOnSegment(c, a, p)};
  std::size_t best = 0;
  for (std::size_t k = 1; k < 3; ++k)
    if (norm2(edges[k] - p) < norm2(edges[best] - p)) best = k;
  return edges[best];
}

/// Twice the signed area of (a, b, (x, y)) in the x-y plane. `positive`: sign of the area; for a point on the line, the
/// sign after a shift by a small (e, e^2). Evaluated from the vertex of lower index, so that two triangles have exactly
/// opposite values along their common edge.
double side(const Vec3d& a, std::uint32_t ia, const Vec3d& b, std::uint32_t ib, double x, double y, bool& positive) {
  if (ia > ib) {
    const double value = -side(b, ib, a, ia, x, y, positive);
    positive = !positive;
    return value;
  }
  const double value = (b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x);
  positive = value != 0 ? value > 0 : a.y != b.y ? a.y > b.y : b.x > a.x;
  return value;
}

} // namespace

MeshQuery::MeshQuery(TriangleMesh mesh) : mesh_(std::move(mesh)) {
  const auto count = static_cast<std::uint32_t>(mesh_.indices.size() / 3);
  normals_.resize(count);
  order_.resize(count);
  for (std::uint32_t t = 0; t < count; ++t) {
    const Vec3d n = cross(vertex(t, 1) - vertex(t, 0), vertex(t, 2) - vertex(t, 0));
    const double length = norm(n);
    normals_[t] = length > 0 ? n * (1 / length) : Vec3d{};
    order_[t] = t;
  }
  if (count == 0) return;
  nodes_.emplace_back();
  build(0, 0, count);
}

void MeshQuery::build(std::uint32_t node, std::uint32_t begin, std::uint32_t end) {
  Vec3d low = vertex(order_[begin], 0), high = low;
  for (std::uint32_t i = begin; i < end; ++i)
    for (int k = 0; k < 3; ++k)
      low = base::min(low, vertex(order_[i], k)), high = base::max(high, vertex(order_[i], k));
  nodes_[node] = {low, high, begin, end - begin};
  if (end - begin <= kLeafSize) return;

  // Split at the median along the longest side.
  const Vec3d size = high - low;
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  auto key = [&](std::uint32_t t) { return vertex(t, 0)[axis] + vertex(t, 1)[axis] + vertex(t, 2)[axis]; };
  std::sort(order_.begin() + begin, order_.begin() + end, [&](std::uint32_t a, std::uint32_t b) {
    const double ka = key(a), kb = key(b);
    return ka != kb ? ka < kb : a < b;
  });
  const std::uint32_t middle = begin + (end - begin) / 2, left = static_cast<std::uint32_t>(nodes_.size());
  nodes_[node].first = left;
  nodes_[node].count = 0;
  nodes_.resize(nodes_.size() + 2);
  build(left, begin, middle);
  build(left + 1, middle, end);
}

ClosestPoint MeshQuery::closest(const Vec3d& p, double limit) const {
  ClosestPoint best;
  best.triangle = kNone;
  double best2 = limit < 1e150 ? limit * limit : 1e300;
  std::array<std::pair<std::uint32_t, double>, kStack> stack;
  std::size_t depth = 0;
  if (!nodes_.empty()) stack[depth++] = {0, boxDistance2(nodes_[0].low, nodes_[0].high, p)};
  while (depth > 0) {
    const auto [index, distance2] = stack[--depth];
    if (distance2 > best2) continue;
    const Node& node = nodes_[index];
    if (node.count == 0) {
      // Push the nearer child last, so that it is visited first.
      const double l = boxDistance2(nodes_[node.first].low, nodes_[node.first].high, p);
      const double r = boxDistance2(nodes_[node.first + 1].low, nodes_[node.first + 1].high, p);
      const std::uint32_t near = l <= r ? 0 : 1;
      stack[depth++] = {node.first + 1 - near, near == 0 ? r : l};
      stack[depth++] = {node.first + near, near == 0 ? l : r};
      continue;
    }
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
      const std::uint32_t t = order_[i];
      const Vec3d q = closestOnTriangle(vertex(t, 0), vertex(t, 1), vertex(t, 2), p);
      const double d2 = norm2(q - p);
      if (d2 < best2 || (d2 == best2 && t < best.triangle)) best2 = d2, best.point = q, best.triangle = t;
    }
  }
  best.distance = best.triangle == kNone ? limit : sqrt(best2);
  return best;
}

bool MeshQuery::within(const Vec3d& p, double distance) const {
  const double limit2 = distance * distance;
  std::array<std::uint32_t, kStack> stack;
  std::size_t depth = 0;
  if (!nodes_.empty()) stack[depth++] = 0;
  while (depth > 0) {
    const Node& node = nodes_[stack[--depth]];
    if (boxDistance2(node.low, node.high, p) >= limit2) continue;
    if (node.count == 0) {
      stack[depth++] = node.first + 1;
      stack[depth++] = node.first;
      continue;
    }
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
      const std::uint32_t t = order_[i];
      if (norm2(closestOnTriangle(vertex(t, 0), vertex(t, 1), vertex(t, 2), p) - p) < limit2) return true;
    }
  }
  return false;
}

namespace {
/// Intersection of the vertical line through (x, y) with a triangle; returns false if there is none.
bool crossTriangle(const MeshQuery& query, std::uint32_t t, double x, double y, Crossing& crossing) {
  const auto* index = &query.mesh().indices[3 * t];
  const Vec3d &a = query.vertex(t, 0), &b = query.vertex(t, 1), &c = query.vertex(t, 2);
  bool sa, sb, sc;
  const double wc = side(a, index[0], b, index[1], x, y, sc);
  const double wa = side(b, index[1], c, index[2], x, y, sa);
  if (sa != sc) return false;
  const double wb = side(c, index[2], a, index[0], x, y, sb);
  if (sb != sc) return false;
  const double sum = wa + wb + wc;
  if (sum == 0) return false;
  crossing = {(wa * a.z + wb * b.z + wc * c.z) / sum, sc ? 1 : -1};
  return true;
}
} // namespace

template <class Visit> void MeshQuery::visitColumn(double x, double y, double zMin, Visit&& visit) const {
  std::array<std::uint32_t, kStack> stack;
  std::size_t depth = 0;
  if (!nodes_.empty()) stack[depth++] = 0;
  while (depth > 0) {
    const Node& node = nodes_[stack[--depth]];
    if (x < node.low.x || x > node.high.x || y < node.low.y || y > node.high.y || node.high.z < zMin) continue;
    if (node.count == 0) {
      stack[depth++] = node.first + 1;
      stack[depth++] = node.first;
      continue;
    }
    Crossing crossing;
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i)
      if (crossTriangle(*this, order_[i], x, y, crossing)) visit(crossing);
  }
}

void MeshQuery::column(double x, double y, std::vector<Crossing>& crossings) const {
  crossings.clear();
  visitColumn(x, y, -1e300, [&](const Crossing& c) { crossings.push_back(c); });
  std::sort(crossings.begin(), crossings.end(),
            [](const Crossing& a, const Crossing& b) { return a.z != b.z ? a.z > b.z : a.step > b.step; });
}

int MeshQuery::winding(const Vec3d& p) const {
  int sum = 0;
  visitColumn(p.x, p.y, p.z, [&](const Crossing& c) { sum += c.z > p.z ? c.step : 0; });
  return sum;
}

double MeshQuery::signedDistance(const Vec3d& p) const {
  const double d = closest(p).distance;
  return inside(p) ? -d : d;
}

void MeshQuery::overlapping(const Vec3d& low, const Vec3d& high, std::vector<std::uint32_t>& triangles) const {
  triangles.clear();
  std::array<std::uint32_t, kStack> stack;
  std::size_t depth = 0;
  auto apart = [&](const Vec3d& l, const Vec3d& h) {
    return l.x > high.x || h.x < low.x || l.y > high.y || h.y < low.y || l.z > high.z || h.z < low.z;
  };
  if (!nodes_.empty()) stack[depth++] = 0;
  while (depth > 0) {
    const Node& node = nodes_[stack[--depth]];
    if (apart(node.low, node.high)) continue;
    if (node.count == 0) {
      stack[depth++] = node.first + 1;
      stack[depth++] = node.first;
      continue;
    }
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
      const std::uint32_t t = order_[i];
      const Vec3d &a = vertex(t, 0), &b = vertex(t, 1), &c = vertex(t, 2);
      if (!apart(base::min(a, base::min(b, c)), base::max(a, base::max(b, c)))) triangles.push_back(t);
    }
  }
  std::sort(triangles.begin(), triangles.end());
}

} // namespace grouser::spheredecomp
