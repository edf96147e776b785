// SPDX-License-Identifier: BSD-3-Clause
#include "contact/shape_points.hpp"

#include "base/math.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

namespace grouser::contact {

using base::Vec3d;

namespace {

constexpr int kCellsOfEdge = 24, kMinCells = 4, kMaxCells = 48; ///< cells between two edges
constexpr int kAround = 512;                                    ///< points around a cylinder
constexpr int kRings = 12;                                      ///< rings of points on the end of a cylinder
constexpr int kLatitudes = 96;                                  ///< rings of points on a sphere

/// Inset of edge points within their face [half of the face], so that a face does not press along its edges while an
/// adjacent face lies on a plane.
constexpr double kInset = 0.005;

/// Cells of an interval between two edges, and weight of node k: half at either end (trapezoidal rule).
int cellsOf(double length, double spacing) {
  return std::clamp(static_cast<int>(std::ceil(length / spacing - 1e-9)), kMinCells, kMaxCells);
}
double shareOf(int k, int cells) { return (k == 0 || k == cells ? 0.5 : 1.0) / cells; }
double nodeOf(int k, int cells) { return (1 - kInset) * (2.0 * k / cells - 1); } ///< position of node k [half interval]

class Points {
public:
  void put(const Vec3d& at, double area, const Vec3d& normal) {
    all_.push_back({at.as<float>(), 0, static_cast<float>(area), mainDirection(normal)});
  }

  void box(const Vec3d& half) {
    const double spacing = 2 * std::max({half.x, half.y, half.z}) / kCellsOfEdge;
    for (int axis = 0; axis < 3; ++axis) {
      const int u = (axis + 1) % 3, v = (axis + 2) % 3;
      const int nu = cellsOf(2 * half[u], spacing), nv = cellsOf(2 * half[v], spacing);
      for (const double side : {-1.0, 1.0})
        for (int i = 0; i <= nu; ++i)
          for (int j = 0; j <= nv; ++j) {
            Vec3d at, normal;
            at[axis] = side * half[axis], normal[axis] = side;
            at[u] = half[u] * nodeOf(i, nu), at[v] = half[v] * nodeOf(j, nv);
            put(at, 4 * half[u] * half[v] * shareOf(i, nu) * shareOf(j, nv), normal);
          }
    }
  }

  /// Side of a cylinder or cone about z, with radius `low` at its lower and `high` at its upper end.
  void side(double low, double high, double half) {
    const double slant = std::sqrt((low - high) * (low - high) + 4 * half * half);
    const int cells = cellsOf(slant, std::max(low, high) / 8);
    for (int i = 0; i < kAround; ++i) {
      const double angle = 2 * base::kPi * (i + 0.5) / kAround;
      const Vec3d out{base::cos(angle), base::sin(angle), 0};
      const Vec3d normal = (out * (2 * half) + Vec3d{0, 0, low - high}) * (1 / slant);
      for (int j = 0; j <= cells; ++j) {
        const double at = nodeOf(j, cells), radius = 0.5 * (low + high) + 0.5 * at * (high - low);
        put(out * radius + Vec3d{0, 0, half * at}, 2 * base::kPi * radius / kAround * slant * shareOf(j, cells),
            normal);
      }
    }
  }

  /// End of a cylinder or cone about z, at height z.
  void end(double radius, double z) {
    if (!(radius > 0)) return;
    const double step = radius / kRings;
    for (int ring = 0; ring <= kRings; ++ring) {
      const double r = ring * step, inner = std::max(0.0, r - 0.5 * step), outer = std::min(radius, r + 0.5 * step);
      const int around = ring == kRings ? kAround : std::max(1, 6 * ring);
      const double area = base::kPi * (outer * outer - inner * inner) / around;
      for (int k = 0; k < around; ++k) {
        const double angle = 2 * base::kPi * (k + 0.5) / around;
        put(Vec3d{base::cos(angle), base::sin(angle), 0} * (r * (1 - kInset)) + Vec3d{0, 0, z}, area, {0, 0, z});
      }
    }
  }

  /// Two halves of a sphere about the ends of a segment along z.
  void caps(double radius, double half) {
    const double step = base::kPi / kLatitudes;
    for (int k = 0; k < kLatitudes; ++k) {
      const double from = k * step, middle = from + 0.5 * step, across = base::sin(middle), along = base::cos(middle);
      const int around = std::max(4, static_cast<int>(2 * kLatitudes * across));
      const double area = 2 * base::kPi * radius * radius * (base::cos(from) - base::cos(from + step)) / around;
      for (int i = 0; i < around; ++i) {
        const double angle = 2 * base::kPi * (i + 0.5 * (k % 2)) / around;
        const Vec3d out{across * base::cos(angle), across * base::sin(angle), along};
        put(out * radius + Vec3d{0, 0, along > 0 ? half : -half}, area, out);
      }
    }
  }

  /// Bisects the longest edge of a triangle until no edge exceeds `spacing`. Each corner of a piece receives a third of
  /// the piece's area.
  void triangle(const std::array<Vec3d, 3>& corners, double spacing,
                const std::function<bool(const Vec3d&)>& isInside) {
    const Vec3d twice = cross(corners[1] - corners[0], corners[2] - corners[0]);
    if (!(norm(twice) > 0)) return;
    std::map<std::array<double, 3>, double> areas; // [corner] area [m2]; adjacent pieces share corners
    std::vector<std::array<Vec3d, 3>> pieces{corners};
    while (!pieces.empty()) {
      const std::array<Vec3d, 3> piece = pieces.back();
      pieces.pop_back();
      std::size_t at = 0; // the edge from corner `at` to the next one is the longest
      double longest = 0;
      for (std::size_t k = 0; k < 3; ++k)
        if (const double edge = norm(piece[(k + 1) % 3] - piece[k]); edge > longest) longest = edge, at = k;
      const Vec3d &a = piece[at], &b = piece[(at + 1) % 3], &c = piece[(at + 2) % 3];
      if (longest <= spacing) {
        const double third = norm(cross(b - a, c - a)) / 6;
        for (const Vec3d& corner : piece) areas[{corner.x, corner.y, corner.z}] += third;
        continue;
      }
      const Vec3d middle = (a + b) * 0.5;
      pieces.push_back({a, middle, c}), pieces.push_back({middle, b, c});
    }
    const Vec3d centre = (corners[0] + corners[1] + corners[2]) * (1.0 / 3);
    const Vec3d outwards = twice * (1e-3 * spacing / norm(twice));
    for (const auto& [at, area] : areas) {
      const Vec3d corner{at[0], at[1], at[2]}, point = corner + (centre - corner) * kInset;
      if (!isInside(point + outwards)) put(point, area, twice);
    }
  }

  std::vector<SurfaceSample> take() { return std::move(all_); }

private:
  std::vector<SurfaceSample> all_;
};

} // namespace

std::vector<SurfaceSample> shapePoints(const SurfaceGeometry& shape) {
  Points points;
  const Vec3d& half = shape.half;
  if (shape.shape == SurfaceShape::box) points.box(half);
  const bool isCone = shape.shape == SurfaceShape::cone;
  if (isCone || shape.shape == SurfaceShape::cylinder) {
    const double tip = isCone ? half.y : half.x;
    points.side(half.x, tip, half.z), points.end(half.x, -half.z), points.end(tip, half.z);
  }
  if (shape.shape == SurfaceShape::capsule) {
    points.caps(half.x, half.z);
    if (half.z > 0) points.side(half.x, half.x, half.z);
  }
  return points.take();
}

std::vector<SurfaceSample> meshPoints(const base::TriangleMesh& mesh, double spacing,
                                      const std::function<bool(const Vec3d&)>& isInside) {
  Points points;
  for (std::size_t t = 0; t + 2 < mesh.indices.size(); t += 3)
    points.triangle(
        {mesh.vertices[mesh.indices[t]], mesh.vertices[mesh.indices[t + 1]], mesh.vertices[mesh.indices[t + 2]]},
        spacing, isInside);
  return points.take();
}

} // namespace grouser::contact
