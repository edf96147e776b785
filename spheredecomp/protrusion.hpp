// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/math.hpp"
#include "spheredecomp/decompose.hpp"

namespace grouser::spheredecomp {

/// Largest protrusion of a set's surface from its mesh.
struct Protrusion {
  double distance{}; ///< [m], >= 0
  base::Vec3d place; ///< centre of the sphere, in the mesh's frame [m]
};

/// Permitted protrusion of a part's spheres, and the contact size.
struct ProtrusionLimit {
  double permitted{};                   ///< [m], > 0
  double contactSize{};                 ///< [m], > 0: size of the smallest contact partner
  double permittedDip{base::kInfinity}; ///< depth of the set below the surface where spheres shrink, that of the
                                        ///< default cut leaves it [m]
  bool automatic{}; ///< the radius is the default: a finer cut may replace it. Otherwise only measured
};

/// Maximum number of spheres of a finer cut; beyond, a default radius is rejected.
inline constexpr double kSphereBudget = 1e5;

/// The largest protrusion of a set. Exact for spheres under a flat or convex surface, an upper bound where the surface
/// is concave: of balls about points of each disc (its centre, its rim and a ring half-way), their radius less the
/// depth of the point.
Protrusion largestProtrusion(const TriangleMesh& mesh, const SphereSet& set);

/// decompose() with a measurement of the protrusion. With an automatic radius, a mesh whose set protrudes more than
/// permitted (thin sheets, wedges, tips) is cut again by spheres no larger than the contact size, which shrink where
/// the part is thin. Throws base::InputError if that needs more than kSphereBudget spheres.
SphereSet decomposeWithin(const TriangleMesh& mesh, const std::string& name, const DecompositionOptions& options,
                          const ProtrusionLimit& limit, Protrusion& protrusion);

/// True if decomposeWithin() returns the cut of decompose().
bool meets(const ProtrusionLimit& limit, const SphereSet& set, const DecompositionOptions& options,
           const Protrusion& protrusion);

/// Report of a decomposition with its largest protrusion, for plans and warnings.
struct CutReport {
  std::string name;
  std::string key; ///< scene key of the radius
  double radius{}; ///< [m]
  std::size_t spheres{};
  Protrusion protrusion;
  ProtrusionLimit limit;
};

/// "shoe.obj: 600 spheres of 0.02 m, largest protrusion 0.16 mm at (...) m, permitted 0.77 mm".
std::string protrusionLine(const CutReport& report);
/// Warning for an explicit radius whose protrusion exceeds the limit; else empty.
std::string protrusionWarning(const CutReport& report);

/// Inputs of the result beside cutOrigin(), as text.
std::string limitOrigin(const ProtrusionLimit& limit);

} // namespace grouser::spheredecomp
