// SPDX-License-Identifier: BSD-3-Clause
#include "scm/facets.hpp"

#include "base/math.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace grouser::scm {

namespace {

using contact::SurfaceShape;

/// Point of a meridian: distance from the axis, and height [m].
struct Ring {
  double radius, z;
};

std::vector<Facet> facetsOfBox(const Vec3d& half) {
  std::vector<Facet> facets;
  for (int a = 0; a < 3; ++a)
    for (const double side : {-1.0, 1.0}) {
      Facet f;
      f.normal[a] = side;
      const int b = (a + 1) % 3, c = (a + 2) % 3;
      for (const auto& [u, v] : {std::pair{-1, -1}, std::pair{1, -1}, std::pair{1, 1}, std::pair{-1, 1}}) {
        Vec3d p;
        p[a] = side * half[a], p[b] = u * half[b], p[c] = v * half[c];
        f.corners.push_back(p);
      }
      facets.push_back(std::move(f));
    }
  return facets;
}

/// Number of sides of a circle. Facets curved in two directions need fewer.
int sidesOf(double radius, double spacing, bool doublyCurved) {
  const double perimeter = 2 * base::kPi * radius;
  const double sides = doublyCurved ? std::clamp(2 * perimeter / spacing, 48.0, 240.0)
                                    : std::clamp(3 * perimeter / spacing, 96.0, 360.0);
  return 4 * static_cast<int>(std::ceil(sides / 4));
}

/// Meridian of a shape, from its lower to its upper end.
std::vector<Ring> meridianOf(const contact::SurfaceGeometry& g, int sides) {
  if (g.shape == SurfaceShape::cone) return {{g.half.x, -g.half.z}, {g.half.y, g.half.z}};
  if (g.shape != SurfaceShape::capsule) return {{g.half.x, -g.half.z}, {g.half.x, g.half.z}};
  std::vector<Ring> rings;
  const int quarter = sides / 4;
  const double turn = base::kPi / (2 * quarter), radius = g.half.x * (1 + turn * turn / 12); // zero mean error
  for (int half = 0; half < 2; ++half)
    for (int k = 0; k <= quarter; ++k) {
      if (half == 1 && k == 0 && !(g.half.z > 0)) continue;
      const double angle = turn * (half == 0 ? quarter - k : k), height = (half == 0 ? -1 : 1);
      const bool isPole = half == 0 ? k == 0 : k == quarter;
      rings.push_back({isPole ? 0 : radius * base::cos(angle), height * (g.half.z + radius * base::sin(angle))});
    }
  return rings;
}

std::vector<Facet> facetsOfRound(const contact::SurfaceGeometry& g, double spacing) {
  const int sides = sidesOf(g.half.x, spacing, g.shape == SurfaceShape::capsule);
  const double turn = 2 * base::kPi / sides, wider = ::sqrt(turn / base::sin(turn)); // equal area
  const std::vector<Ring> rings = meridianOf(g, sides);
  const auto at = [&](const Ring& ring, int k) {
    const double angle = turn * (k % sides);
    return Vec3d{wider * ring.radius * base::cos(angle), wider * ring.radius * base::sin(angle), ring.z};
  };
  std::vector<Facet> facets;
  for (std::size_t r = 0; r + 1 < rings.size(); ++r) {
    const Ring &low = rings[r], &high = rings[r + 1];
    for (int k = 0; k < sides; ++k) {
      Facet f;
      f.corners = {at(low, k)};
      if (low.radius > 0) f.corners.push_back(at(low, k + 1));
      if (high.radius > 0) f.corners.push_back(at(high, k + 1));
      f.corners.push_back(at(high, k));
      const Vec3d across = low.radius > 0 ? at(low, k + 1) - at(low, k) : at(high, k + 1) - at(high, k);
      const Vec3d normal = cross(across, at(high, k) - at(low, k));
      f.normal = normal * (1 / norm(normal));
      facets.push_back(std::move(f));
    }
  }
  for (const bool top : {false, true}) {
    const Ring& ring = top ? rings.back() : rings.front();
    if (!(ring.radius > 0)) continue;
    Facet f;
    f.normal = {0, 0, top ? 1.0 : -1.0};
    for (int k = 0; k < sides; ++k) f.corners.push_back(at(ring, k));
    facets.push_back(std::move(f));
  }
  return facets;
}

} // namespace

Solid solidOf(const contact::SurfaceGeometry& shape, double spacing, int part, int body) {
  const bool isBox = shape.shape == SurfaceShape::box;
  Solid solid{.part = part, .body = body, .half = halfExtent(shape), .isRound = !isBox};
  solid.isBall = shape.shape == SurfaceShape::capsule && shape.half.z == 0;
  solid.facets = isBox ? facetsOfBox(shape.half) : facetsOfRound(shape, spacing);
  return solid;
}

} // namespace grouser::scm
