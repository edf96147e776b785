// SPDX-License-Identifier: BSD-3-Clause
#include "vehicle/hull_clearance.hpp"

#include "base/math.hpp"
#include "spheredecomp/mesh_query.hpp"
#include "vehicle/wrap.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <string>
#include <utility>
#include <vector>

namespace grouser::vehicle {
namespace {

using base::TriangleMesh;
using Polygon = std::vector<PlanePoint>; ///< convex

constexpr double kTouching = 1e-3; ///< tolerated overlap [m]

/// Track part: outline in the track plane, and extent across it.
struct TrackPart {
  std::string name;
  Polygon corners; ///< outline of a shoe
  PlanePoint centre;
  double radius = 0; ///< radius of a wheel
  double halfWidth;
};

double halfWidthOf(const TriangleMesh& mesh) {
  double most = 0;
  for (const Vec3d& v : mesh.vertices) most = std::max(most, std::fabs(v.y));
  return most;
}

std::vector<TrackPart> trackParts(const VehicleSpec& s, const PartMeshes& meshes, const Wrap& wrap) {
  std::vector<TrackPart> parts;
  const double shoeWidth = halfWidthOf(meshes.shoe);
  for (int i = 0; i < s.shoe.count; ++i) {
    const PlanePoint c = wrap.shoeCentre(i);
    const double angle = wrap.shoeAngle(i), ax = base::cos(angle), az = base::sin(angle);
    TrackPart shoe{fmt::format("shoe {}", i), {}, c, 0, shoeWidth};
    for (const auto& [u, w] : {std::pair{-1, s.shoe.padBottom - s.shoe.grouserHeight},
                               {1, s.shoe.padBottom - s.shoe.grouserHeight},
                               {1, s.shoe.plateTop},
                               {-1, s.shoe.plateTop}})
      shoe.corners.push_back({c.x + u * s.shoe.halfLength * ax - w * az, c.z + u * s.shoe.halfLength * az + w * ax});
    parts.push_back(std::move(shoe));
  }
  const auto wheel = [&](std::string name, double x, double z, double radius, const TriangleMesh& mesh) {
    parts.push_back({std::move(name), {}, {x, z}, radius, halfWidthOf(mesh)});
  };
  wheel("sprocket", 0, 0, s.sprocketPinRadius(), meshes.sprocket);
  wheel("idler", wrap.idlerX, s.idler.z, s.idler.radius, meshes.idler);
  for (int i = 0; i < s.roadWheel.count; ++i)
    wheel(fmt::format("road wheel {}", i), s.roadWheel.firstX + i * s.roadWheel.spacing, s.roadWheel.z,
          s.roadWheel.radius, meshes.roadWheel);
  for (std::size_t i = 0; i < s.roller.x.size(); ++i)
    wheel(fmt::format("roller {}", i), s.roller.x[i], s.roller.z[i], s.roller.radius, meshes.roller);
  return parts;
}

/// Section of a triangle with y in [from, to], seen along y.
Polygon slice(const std::array<Vec3d, 3>& triangle, double from, double to) {
  std::vector<Vec3d> points(triangle.begin(), triangle.end());
  for (const double sign : {1.0, -1.0}) {
    const double bound = sign > 0 ? from : -to;
    std::vector<Vec3d> kept;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Vec3d &a = points[i], &b = points[(i + 1) % points.size()];
      const double da = sign * a.y - bound, db = sign * b.y - bound;
      if (da >= 0) kept.push_back(a);
      if ((da < 0) != (db < 0)) kept.push_back(a + (b - a) * (da / (da - db)));
    }
    points = std::move(kept);
  }
  Polygon flat;
  for (const Vec3d& p : points) flat.push_back({p.x, p.z});
  return flat;
}

/// Minimum shift along an edge normal that separates two shapes [m]; negative if they do not overlap.
double overlapOf(const Polygon& a, const Polygon& b) {
  double least = base::kInfinity;
  for (const Polygon* shape : {&a, &b})
    for (std::size_t i = 0; i < shape->size(); ++i) {
      const PlanePoint p = (*shape)[i], q = (*shape)[(i + 1) % shape->size()];
      const double length = std::sqrt((q.x - p.x) * (q.x - p.x) + (q.z - p.z) * (q.z - p.z));
      if (!(length > 1e-12)) continue;
      const double nx = (q.z - p.z) / length, nz = (p.x - q.x) / length;
      const auto range = [&](const Polygon& points) {
        double low = base::kInfinity, high = -base::kInfinity;
        for (const PlanePoint& c : points)
          low = std::min(low, nx * c.x + nz * c.z), high = std::max(high, nx * c.x + nz * c.z);
        return std::pair{low, high};
      };
      const auto [lowA, highA] = range(a);
      const auto [lowB, highB] = range(b);
      least = std::min({least, highA - lowB, highB - lowA});
    }
  return least;
}

/// Overlap of a polygon and a disc [m]; negative if they do not overlap.
double depthInDisc(const Polygon& polygon, PlanePoint centre, double radius) {
  double nearest = base::kInfinity;
  bool inside = polygon.size() > 2;
  double turn = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const PlanePoint p = polygon[i], q = polygon[(i + 1) % polygon.size()];
    const double ex = q.x - p.x, ez = q.z - p.z, px = centre.x - p.x, pz = centre.z - p.z, length2 = ex * ex + ez * ez;
    const double share = length2 > 0 ? std::clamp((px * ex + pz * ez) / length2, 0.0, 1.0) : 0.0;
    const double dx = px - share * ex, dz = pz - share * ez, side = ex * pz - ez * px;
    nearest = std::min(nearest, std::sqrt(dx * dx + dz * dz));
    if (side * turn < 0 || length2 == 0) inside = false;
    if (side != 0) turn = side;
  }
  return radius - (inside && turn != 0 ? 0.0 : nearest);
}

/// Penetration of a track part at `offset` into the hull [m]: the smaller of its values in and across the track plane;
/// infinite if the part is inside the hull, negative without overlap.
double depthOf(const spheredecomp::MeshQuery& query, const TrackPart& part, double offset) {
  if (query.inside({part.centre.x, offset, part.centre.z})) return base::kInfinity;
  const TriangleMesh& hull = query.mesh();
  const double from = offset - part.halfWidth, to = offset + part.halfWidth;
  double deepest = -base::kInfinity, low = base::kInfinity, high = -base::kInfinity;
  for (std::size_t t = 0; t + 2 < hull.indices.size(); t += 3) {
    const std::array<Vec3d, 3> triangle{hull.vertices[hull.indices[t]], hull.vertices[hull.indices[t + 1]],
                                        hull.vertices[hull.indices[t + 2]]};
    const Polygon seen = slice(triangle, from + kTouching, to - kTouching);
    if (seen.size() < 2) continue;
    const double depth = part.radius > 0 ? depthInDisc(seen, part.centre, part.radius) : overlapOf(seen, part.corners);
    deepest = std::max(deepest, depth);
    if (depth <= kTouching) continue;
    for (const Vec3d& v : triangle) low = std::min(low, v.y), high = std::max(high, v.y);
  }
  return std::min({deepest, high - from, to - low});
}

struct Clash {
  std::string part; ///< "left shoe 3"
  double depth;     ///< penetration [m]; infinite: completely inside
};

std::optional<Clash> clashAt(const spheredecomp::MeshQuery& hull, const std::vector<TrackPart>& parts, double offset) {
  for (const double side : {1.0, -1.0})
    for (const TrackPart& part : parts)
      if (const double depth = depthOf(hull, part, side * offset); depth > kTouching)
        return Clash{(side > 0 ? "left " : "right ") + part.name, depth};
  return {};
}

} // namespace

std::optional<SpecFault> hullFault(const VehicleSpec& s, const PartMeshes& meshes) {
  const std::optional<Wrap> wrap = findWrap(s);
  if (!wrap) return {};
  const std::vector<TrackPart> parts = trackParts(s, meshes, *wrap);
  const spheredecomp::MeshQuery hull(meshes.chassis);
  const std::optional<Clash> clash = clashAt(hull, parts, s.trackOffset);
  if (!clash) return {};
  std::string what = std::isfinite(clash->depth)
                         ? fmt::format("[m] makes the hull {} and the {} overlap by {:.1f} mm", s.chassis.mesh,
                                       clash->part, 1e3 * clash->depth)
                         : fmt::format("[m] places the {} inside the hull {}", clash->part, s.chassis.mesh);
  constexpr double kStep = 0.01, kMax = 5; // [m]
  for (double offset = std::floor(s.trackOffset / kStep + 1) * kStep; offset <= kMax; offset += kStep)
    if (!clashAt(hull, parts, offset))
      return SpecFault{"vehicle", "track_offset", fmt::format("{}; set vehicle.track_offset = {:.2f}", what, offset)};
  return SpecFault{"vehicle", "track_offset", what + "; no larger value removes the overlap: use another hull mesh"};
}

} // namespace grouser::vehicle
