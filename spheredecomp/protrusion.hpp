// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/math.hpp"
#include "spheredecomp/decompose.hpp"

namespace grouser::spheredecomp {

/// Maximum protrusion of a set's surface from its mesh.
struct Protrusion {
  double distance{}; ///< [m], >= 0
  base::Vec3d place; ///< centre of the sphere, in the mesh's frame [m]
};

/// Permitted protrusion of a part's spheres, and contact size.
struct ProtrusionLimit {
  double permitted{};                   ///< [m], > 0
  double contactSize{};                 ///< [m], > 0: size of the smallest contact partner
  double permittedDip{base::kInfinity}; ///< permitted depth of dips of the default decomposition at places where
                                        ///< spheres shrink [m]; infinite: no limit
  bool automatic{}; ///< true: default radius, which may be reduced; false: protrusion is only measured
};

/// Maximum number of spheres of a finer decomposition; if more are required, a default radius is rejected.
inline constexpr double kSphereBudget = 1e5;

/// Returns the maximum protrusion of a set, computed as radius minus depth for balls at points of each disc (centre,
/// rim, and a ring half-way). Exact for spheres under a flat or convex surface; an upper bound under a concave surface.
Protrusion largestProtrusion(const TriangleMesh& mesh, const SphereSet& set);

/// Runs decompose() and measures the protrusion. With an automatic radius, a mesh with a set that protrudes more than
/// permitted (thin sheets, wedges, tips) is decomposed again into spheres no larger than the contact size, which shrink
/// at thin places. Throws base::InputError if this requires more than kSphereBudget spheres.
SphereSet decomposeWithin(const TriangleMesh& mesh, const std::string& name, const DecompositionOptions& options,
                          const ProtrusionLimit& limit, Protrusion& protrusion);

/// True if the result of decompose() is acceptable without a finer decomposition.
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

/// Report line: "shoe.obj: 600 spheres of 0.02 m, largest protrusion 0.16 mm at (...) m, permitted 0.77 mm".
std::string protrusionLine(const CutReport& report);
/// Warning if the protrusion with an explicit radius exceeds the limit; else empty.
std::string protrusionWarning(const CutReport& report);

/// Inputs of the result in addition to cutOrigin(), as text.
std::string limitOrigin(const ProtrusionLimit& limit);

} // namespace grouser::spheredecomp
