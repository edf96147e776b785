// SPDX-License-Identifier: BSD-3-Clause
#include "spheredecomp/protrusion.hpp"

#include "base/error.hpp"
#include "base/math.hpp"
#include "spheredecomp/detail/outer_surface.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace grouser::spheredecomp {
namespace {

using base::SetSphere;
using base::Vec3d;

constexpr int kAround = 24;      // points of a ring about a disc's centre
constexpr int kMostTries = 4;    // finer cuts, each of half the radius
constexpr double kForced = 0.25; // radius of a sphere that fits nowhere [permitted]

/// How far the balls of a rounded disc stand out of the mesh, 0 or less where they do not [m].
double standsOut(const detail::OuterSurface& outer, const SetSphere& s) {
  const auto out = [&](const Vec3d& p) {
    const double depth = outer.surface().closest(p).distance;
    return s.radius + (outer.solid().inside(p) ? -depth : depth);
  };
  double most = out(s.centre);
  if (s.flat == 0) return most;
  const Vec3d other = s.normal.x * s.normal.x < 0.5 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0};
  const Vec3d u = normalized(cross(s.normal, other)) * s.flat, v = cross(s.normal, u);
  for (int k = 0; k < kAround; ++k) {
    const double angle = 2 * base::kPi * k / kAround;
    const Vec3d rim = u * base::cos(angle) + v * base::sin(angle);
    most = std::max({most, out(s.centre + rim), out(s.centre + rim * 0.5)});
  }
  return most;
}

/// How deep spheres that shrink may leave the surface above them [m]: one may serve both sides.
double dipWhereThin(const SphereSet& set, const DecompositionOptions& options) {
  const bool shrunk = std::any_of(set.spheres.begin(), set.spheres.end(),
                                  [&](const SetSphere& s) { return s.radius < 0.999 * set.radius; });
  return shrunk ? options.maxDip * set.radius : 0;
}

/// Spheres of radius r that cover a mesh are about this many.
double countOf(double area, double radius) { return area / (radius * radius); }

[[noreturn]] void refuse(const std::string& name, const Protrusion& worst, double radius, double needed,
                         const ProtrusionLimit& limit, double count) {
  throw base::InputError(fmt::format(
      "{}: is thin or pointed at ({:.4g}, {:.4g}, {:.4g}) m of its file, where spheres of {:.3g} m stand {:.3g} m out "
      "of "
      "it, more than the permitted {:.3g} m for contact with sizes of {:.3g} m; about {:.2g} spheres of {:.3g} m would "
      "be needed, more than {:.0e}: thicken the part, split it, use a box instead, or set sphere_radius and accept its "
      "protrusion",
      name, worst.place.x, worst.place.y, worst.place.z, radius, worst.distance, limit.permitted, limit.contactSize,
      count, needed, kSphereBudget));
}

} // namespace

Protrusion largestProtrusion(const TriangleMesh& mesh, const SphereSet& set) {
  const detail::OuterSurface outer(mesh, set.spacing / 6);
  std::vector<double> out(set.surfaceCount);
#pragma omp parallel for schedule(dynamic, 16)
  for (std::int64_t i = 0; i < static_cast<std::int64_t>(set.surfaceCount); ++i)
    out[static_cast<std::size_t>(i)] = standsOut(outer, set.spheres[static_cast<std::size_t>(i)]);
  Protrusion worst;
  for (std::size_t i = 0; i < out.size(); ++i)
    if (out[i] > worst.distance) worst = {out[i], set.spheres[i].centre};
  return worst;
}

bool meets(const ProtrusionLimit& limit, const SphereSet& set, const DecompositionOptions& options,
           const Protrusion& protrusion) {
  return protrusion.distance <= limit.permitted && dipWhereThin(set, options) <= limit.permittedDip;
}

SphereSet decomposeWithin(const TriangleMesh& mesh, const std::string& name, const DecompositionOptions& options,
                          const ProtrusionLimit& limit, Protrusion& protrusion) {
  SphereSet set = decompose(mesh, name, options);
  protrusion = largestProtrusion(mesh, set);
  if (!limit.automatic || meets(limit, set, options, protrusion)) return set;
  DecompositionOptions fine = options;
  fine.thin = true;
  fine.maxDip = 0.02;
  fine.flatTolerance = 0.005;
  // Fewer, larger spheres where those of the contact's size would be too many: up to twice as large.
  const double cheapest = std::sqrt(set.meshArea / kSphereBudget);
  fine.radius = std::min(options.radius, std::clamp(cheapest, limit.contactSize, 2 * limit.contactSize));
  for (int tries = 0; tries < kMostTries; ++tries) {
    const double count = countOf(set.meshArea, fine.radius);
    if (count > 1.0001 * kSphereBudget) refuse(name, protrusion, set.radius, fine.radius, limit, count);
    fine.smallest = std::min(0.2, kForced * limit.permitted / fine.radius);
    set = decompose(mesh, name, fine);
    protrusion = largestProtrusion(mesh, set);
    if (protrusion.distance <= limit.permitted) return set;
    fine.radius *= 0.5;
  }
  refuse(name, protrusion, set.radius, fine.radius, limit, countOf(set.meshArea, fine.radius));
}

std::string protrusionLine(const CutReport& r) {
  const Vec3d& p = r.protrusion.place;
  return fmt::format(
      "{}: {} spheres of {:.3g} m, largest protrusion {:.2g} mm at ({:.3g}, {:.3g}, {:.3g}) m, permitted "
      "{:.2g} mm",
      r.name, r.spheres, r.radius, 1e3 * r.protrusion.distance, p.x, p.y, p.z, 1e3 * r.limit.permitted);
}

std::string protrusionWarning(const CutReport& r) {
  if (r.limit.automatic || r.protrusion.distance <= r.limit.permitted) return "";
  const Vec3d& p = r.protrusion.place;
  return fmt::format("the spheres of {} stand out of its mesh by up to {:.2g} mm, at ({:.3g}, {:.3g}, {:.3g}) m, more "
                     "than the permitted {:.2g} mm: it acts that much thicker there; remove {}, or lower it",
                     r.name, 1e3 * r.protrusion.distance, p.x, p.y, p.z, 1e3 * r.limit.permitted, r.key);
}

std::string limitOrigin(const ProtrusionLimit& limit) {
  return limit.automatic ? fmt::format("permitted protrusion {}, dip {}\ncontact size {}\nbudget {}\n", limit.permitted,
                                       limit.permittedDip, limit.contactSize, kSphereBudget)
                         : "measured\n";
}

} // namespace grouser::spheredecomp
