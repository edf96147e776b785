// SPDX-License-Identifier: BSD-3-Clause
#include "spheredecomp/protrusion.hpp"

#include "base/error.hpp"
#include "base/math.hpp"
#include "base/rounded.hpp"
#include "spheredecomp/detail/outer_surface.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace grouser::spheredecomp {
namespace {

using base::SetSphere;
using base::Vec3d;

constexpr int kAround = 24;      // points per ring about a disc's centre
constexpr int kMaxTries = 4;     // finer decompositions, each with half the radius
constexpr double kForced = 0.25; // radius of a sphere if no sphere fits [permitted]

/// Protrusion of the balls that represent a rounded disc [m]; <= 0 if they are inside the mesh.
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

bool isShrunk(const SetSphere& s, const SphereSet& set) { return s.radius < 0.999 * set.radius; }

/// Depth of dips in the surface above shrunken spheres [m]; one sphere may represent both sides.
double dipWhereThin(const SphereSet& set, const DecompositionOptions& options) {
  const bool shrunk =
      std::any_of(set.spheres.begin(), set.spheres.end(), [&](const SetSphere& s) { return isShrunk(s, set); });
  return shrunk ? options.maxDip * set.radius : 0;
}

/// Approximate number of spheres that cover a mesh; thin sheets require up to a quarter more.
double countOf(double area, double radius) { return 1.25 * area / (radius * radius); }

/// Reason and location of an insufficient default decomposition.
struct Cause {
  Vec3d place;
  std::string fault;
};

Cause causeOf(const SphereSet& set, const Protrusion& worst, const DecompositionOptions& options,
              const ProtrusionLimit& limit) {
  if (worst.distance > limit.permitted)
    return {worst.place, fmt::format("its spheres of {:.3g} m protrude by {:.3g} m, more than the permitted {:.3g} m",
                                     set.radius, worst.distance, limit.permitted)};
  const auto smallest = std::min_element(set.spheres.begin(), set.spheres.end(),
                                         [](const SetSphere& a, const SetSphere& b) { return a.radius < b.radius; });
  return {smallest->centre,
          fmt::format("its spheres of {:.3g} m shrink there and leave dips of up to {:.3g} m, more than the permitted "
                      "{:.3g} m",
                      set.radius, dipWhereThin(set, options), limit.permittedDip)};
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

namespace {

/// A radius that a user can set, with its result.
struct Remedy {
  double radius{}, protrusion{}; ///< [m]
  std::size_t spheres{};
};

/// The radius with the smallest protrusion: the default, or a half, quarter, ... of it within the sphere budget.
Remedy bestRadius(const TriangleMesh& mesh, const std::string& name, DecompositionOptions options,
                  const Remedy& byDefault) {
  Remedy best = byDefault;
  const double meshArea = area(mesh);
  options.most = static_cast<std::size_t>(kSphereBudget);
  for (;;) {
    options.radius = std::stod(base::roundedDown(0.5 * options.radius, 3));
    if (countOf(meshArea, options.radius) > kSphereBudget || latticePoints(mesh, options.radius) > kMaxLatticePoints)
      return best;
    const SphereSet set = decompose(mesh, name, options);
    if (set.surfaceCount > options.most) return best;
    const double protrusion = largestProtrusion(mesh, set).distance;
    if (protrusion < best.protrusion) best = {set.radius, protrusion, set.spheres.size()};
  }
}

/// Rejects a mesh; the message offers a radius for which the error is known.
[[noreturn]] void refuse(const std::string& name, const Cause& cause, const ProtrusionLimit& limit,
                         const Remedy& remedy, const std::string& finer) {
  throw base::InputError(fmt::format(
      "{}: the mesh is thin or pointed at ({:.4g}, {:.4g}, {:.4g}), in metres: {} for a contact size of {:.3g} m, "
      "and {}; thicken the part, build it from boxes or other closed shapes, or set the sphere radius to {:.6g} m: {} "
      "spheres that protrude by {:.2g} m",
      name, cause.place.x, cause.place.y, cause.place.z, cause.fault, limit.contactSize, finer, remedy.radius,
      remedy.spheres, remedy.protrusion));
}

} // namespace

SphereSet decomposeWithin(const TriangleMesh& mesh, const std::string& name, const DecompositionOptions& options,
                          const ProtrusionLimit& limit, Protrusion& protrusion) {
  SphereSet set = decompose(mesh, name, options);
  protrusion = largestProtrusion(mesh, set);
  if (!limit.automatic || meets(limit, set, options, protrusion)) return set;
  const Cause cause = causeOf(set, protrusion, options, limit);
  const Remedy byDefault{set.radius, protrusion.distance, set.spheres.size()};
  const double meshArea = set.meshArea;
  const auto refuseWith = [&](const std::string& finer) {
    refuse(name, cause, limit, bestRadius(mesh, name, options, byDefault), finer);
  };
  const std::string tooMany = fmt::format("a finer decomposition requires more than {:.0f} spheres", kSphereBudget);
  DecompositionOptions fine = options;
  fine.thin = true;
  fine.maxDip = 0.02;
  fine.flatTolerance = 0.005;
  fine.most = static_cast<std::size_t>(kSphereBudget);
  // If spheres of the contact size would be too many, use larger spheres, up to twice this size.
  const double cheapest = std::sqrt(countOf(meshArea, 1) / kSphereBudget);
  fine.radius = std::min(options.radius, std::clamp(cheapest, limit.contactSize, 2 * limit.contactSize));
  for (int tries = 0; tries < kMaxTries; ++tries) {
    if (countOf(meshArea, fine.radius) > 1.0001 * kSphereBudget) refuseWith(tooMany);
    fine.smallest = std::min(0.2, kForced * limit.permitted / fine.radius);
    set = decompose(mesh, name, fine);
    if (set.surfaceCount > fine.most) refuseWith(tooMany); // shrunken spheres at edges exceed the estimate
    protrusion = largestProtrusion(mesh, set);
    if (protrusion.distance <= limit.permitted) return set;
    fine.radius *= 0.5;
  }
  refuseWith(fmt::format("spheres of {:.3g} m still protrude by {:.3g} m", set.radius, protrusion.distance));
  return set; // unreachable
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
  return fmt::format(
      "the spheres of {} protrude from its mesh by up to {:.2g} mm, at ({:.3g}, {:.3g}, {:.3g}) m, more "
      "than the permitted {:.2g} mm, so contacts act on a thicker part; remove {} to choose the radius automatically",
      r.name, 1e3 * r.protrusion.distance, p.x, p.y, p.z, 1e3 * r.limit.permitted, r.key);
}

std::string limitOrigin(const ProtrusionLimit& limit) {
  return limit.automatic ? fmt::format("permitted protrusion {}, dip {}\ncontact size {}\nbudget {}\n", limit.permitted,
                                       limit.permittedDip, limit.contactSize, kSphereBudget)
                         : "measured\n";
}

} // namespace grouser::spheredecomp
