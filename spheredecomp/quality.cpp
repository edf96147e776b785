// SPDX-License-Identifier: BSD-3-Clause
#include "spheredecomp/quality.hpp"

#include "base/math.hpp"
#include "spheredecomp/detail/outer_surface.hpp"
#include "spheredecomp/detail/point_grid.hpp"
#include "spheredecomp/detail/rounded_disc.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace grouser::spheredecomp {
namespace {

using base::SetSphere;
using base::Vec3d;
using detail::OuterSurface;
using detail::PointGrid;
using detail::SurfaceSample;

/// Points of the set's surface deeper than this are on the inner side of a hollow shell [radius].
constexpr double kInnerSide = 0.75;
/// Number of sampled directions per sphere.
constexpr int kDirections = 96;

/// Surface spheres of a set, with spatial search.
struct Shape {
  const SphereSet& set;
  bool discs; ///< rounded discs, or plain spheres
  double reach{};
  PointGrid grid;

  Shape(const SphereSet& s, bool d) : set(s), discs(d), grid(s.spacing) {
    for (std::size_t i = 0; i < set.surfaceCount; ++i) {
      grid.add(set.spheres[i].centre, static_cast<std::uint32_t>(i));
      const double r = set.spheres[i].radius + (discs ? set.spheres[i].flat : 0);
      reach = r > reach ? r : reach;
    }
  }
  double distance(std::uint32_t i, const Vec3d& p) const {
    return discs ? detail::discDistance(set.spheres[i], p) : detail::ballDistance(set.spheres[i], p);
  }
  /// Distance from p to the union [m], negative inside. The search radius grows until the nearest sphere is certain.
  double distance(const Vec3d& p) const {
    for (double range = 0.125 * set.radius;; range *= 4) {
      double best = 1e300;
      grid.each(p, reach + range, [&](std::uint32_t i) {
        const double d = distance(i, p);
        best = d < best ? d : best;
      });
      if (best <= range || range > 1e3) return best;
    }
  }
  bool coveredByOther(std::uint32_t self, const Vec3d& p, double margin) const {
    return grid.any(p, reach, [&](std::uint32_t i) { return i != self && distance(i, p) < -margin; });
  }
};

/// Uniformly distributed directions (Fibonacci spiral).
std::vector<Vec3d> directions() {
  std::vector<Vec3d> result;
  const double golden = base::kPi * (3 - std::sqrt(5.0));
  for (int i = 0; i < kDirections; ++i) {
    const double z = 1 - (2 * i + 1.0) / kDirections, r = std::sqrt(1 - z * z);
    result.push_back({r * base::cos(golden * i), r * base::sin(golden * i), z});
  }
  return result;
}

/// Point of a sphere's (or rounded disc's) surface with outward normal `direction`.
Vec3d surfacePoint(const SetSphere& s, bool discs, const Vec3d& direction) {
  Vec3d p = s.centre + direction * s.radius;
  const Vec3d across = direction - s.normal * dot(direction, s.normal);
  const double length = norm(across);
  if (discs && length > 0) p += across * (s.flat / length);
  return p;
}

SurfaceDistance measureSurface(const OuterSurface& outer, const std::vector<SurfaceSample>& samples,
                               const Shape& shape) {
  SurfaceDistance result;
  std::vector<double> dips(samples.size());
#pragma omp parallel for schedule(dynamic, 256)
  for (std::int64_t i = 0; i < static_cast<std::int64_t>(samples.size()); ++i)
    dips[static_cast<std::size_t>(i)] = shape.distance(samples[static_cast<std::size_t>(i)].point);
  double square = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    result.meshToSet = std::max(result.meshToSet, std::abs(dips[i]));
    square += samples[i].area * dips[i] * dips[i];
  }
  result.rms = std::sqrt(square / outer.area());

  // From the set to the mesh: sample directions about each sphere, and the top of its disc.
  const std::vector<Vec3d> spread = directions();
  std::vector<std::pair<double, double>> farthest(shape.set.surfaceCount); // inside, outside
#pragma omp parallel for schedule(dynamic, 16)
  for (std::int64_t i = 0; i < static_cast<std::int64_t>(shape.set.surfaceCount); ++i) {
    const auto self = static_cast<std::uint32_t>(i);
    const SetSphere& s = shape.set.spheres[self];
    auto& in = farthest[self].first;
    auto& out = farthest[self].second;
    auto consider = [&](const Vec3d& p) {
      if (shape.coveredByOther(self, p, 1e-6 * s.radius)) return;
      const double d = outer.surface().closest(p).distance;
      if (!outer.solid().inside(p))
        out = std::max(out, d);
      else if (d < kInnerSide * shape.set.radius)
        in = std::max(in, d);
    };
    consider(s.centre + s.normal * s.radius);
    for (const Vec3d& direction : spread) consider(surfacePoint(s, shape.discs, direction));
  }
  for (const auto& [in, out] : farthest) {
    result.setToMesh = std::max({result.setToMesh, in, out});
    result.protrusion = std::max(result.protrusion, out);
  }
  return result;
}

/// Volume of the union of all spheres [m3]: on columns `step` apart, the exact length within the spheres.
double unionVolume(const SphereSet& set, double step) {
  Vec3d low{1e300, 1e300, 1e300}, high = -low;
  for (const SetSphere& s : set.spheres) {
    const Vec3d r{s.radius, s.radius, s.radius};
    low = base::min(low, s.centre - r), high = base::max(high, s.centre + r);
  }
  const auto nx = static_cast<std::int64_t>((high.x - low.x) / step) + 1,
             ny = static_cast<std::int64_t>((high.y - low.y) / step) + 1;
  auto at = [&](double origin, std::int64_t i) { return origin + (static_cast<double>(i) + 0.5) * step; };
  std::vector<std::vector<std::pair<double, double>>> columns(static_cast<std::size_t>(nx * ny));
  for (const SetSphere& s : set.spheres) {
    const auto i0 = static_cast<std::int64_t>((s.centre.x - s.radius - low.x) / step);
    const auto j0 = static_cast<std::int64_t>((s.centre.y - s.radius - low.y) / step);
    for (std::int64_t i = i0; i < nx && at(low.x, i) <= s.centre.x + s.radius; ++i)
      for (std::int64_t j = j0; j < ny && at(low.y, j) <= s.centre.y + s.radius; ++j) {
        const double dx = at(low.x, i) - s.centre.x, dy = at(low.y, j) - s.centre.y;
        const double h2 = s.radius * s.radius - dx * dx - dy * dy;
        if (h2 <= 0) continue;
        const double h = std::sqrt(h2);
        columns[static_cast<std::size_t>(i * ny + j)].emplace_back(s.centre.z - h, s.centre.z + h);
      }
  }
  double sum = 0;
  for (auto& column : columns) {
    std::sort(column.begin(), column.end());
    double top = -1e300;
    for (const auto& [a, b] : column) {
      if (b > top) sum += b - std::max(a, top);
      top = std::max(top, b);
    }
  }
  return sum * step * step;
}

} // namespace

Quality measure(const TriangleMesh& mesh, const SphereSet& set) {
  const OuterSurface outer(mesh, set.spacing / 6);
  const std::vector<SurfaceSample> samples = outer.samples(0.3 * set.spacing);
  Quality quality;
  quality.surfaceCount = set.surfaceCount;
  quality.interiorCount = set.spheres.size() - set.surfaceCount;
  quality.discs = measureSurface(outer, samples, Shape(set, true));
  quality.spheres = measureSurface(outer, samples, Shape(set, false));
  const auto [low, high] = bounds(mesh);
  const double extent = 0.5 * (high.x - low.x + high.y - low.y);
  quality.volumeRatio = unionVolume(set, std::min(0.2 * set.radius, extent / 200)) / outer.volume();
  double area = 0;
  for (const SetSphere& s : set.spheres) area += s.area;
  quality.areaRatio = area / outer.area();
  return quality;
}

std::string report(const SphereSet& set, const Quality& q) {
  auto line = [](const char* name, const SurfaceDistance& d) {
    return fmt::format(
        "  {:<14} {:.3f} mm ({:.3f} mesh to set, {:.3f} set to mesh); rms {:.3f} mm, protrusion {:.3f} mm\n", name,
        1e3 * d.hausdorff(), 1e3 * d.meshToSet, 1e3 * d.setToMesh, 1e3 * d.rms, 1e3 * d.protrusion);
  };
  double smallest = set.radius;
  for (const SetSphere& s : set.spheres) smallest = std::min(smallest, s.radius);
  const std::string shrunk =
      smallest < 0.999 * set.radius
          ? fmt::format("  smallest       radius {:.4g} mm (spheres shrink where the part is thin)\n", 1e3 * smallest)
          : "";
  return fmt::format("{}: {} spheres ({} surface, {} interior), radius {:.4g} mm, spacing {:.4g} mm\n"
                     "{}"
                     "  mesh           volume {:.6g} m3, outer area {:.6g} m2\n"
                     "  volume ratio   {:.4f} (union of spheres / mesh), area ratio {:.8f}\n"
                     "  Hausdorff distance to the mesh\n",
                     set.name, set.spheres.size(), q.surfaceCount, q.interiorCount, 1e3 * set.radius, 1e3 * set.spacing,
                     shrunk, set.meshVolume, set.meshArea, q.volumeRatio, q.areaRatio) +
         line("rounded discs", q.discs) + line("plain spheres", q.spheres);
}

} // namespace grouser::spheredecomp
