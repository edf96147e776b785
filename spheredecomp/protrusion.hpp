// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/math.hpp"
#include "spheredecomp/decompose.hpp"

namespace grouser::spheredecomp {

/// How far the surface of a set stands out of its mesh where that is worst.
struct Protrusion {
  double distance{}; ///< [m], >= 0
  base::Vec3d place; ///< centre of the sphere, in the mesh's frame [m]
};

/// Permitted protrusion of a part's spheres, and the size that touches them.
struct ProtrusionLimit {
  double permitted{};                   ///< [m], > 0
  double contactSize{};                 ///< [m], > 0: of the smallest that touches it
  double permittedDip{base::kInfinity}; ///< depth of the set below the surface where spheres shrink, that of the
                                        ///< default cut leaves it [m]
  bool automatic{}; ///< the radius is the default: a finer cut may replace it. Else the set is measured alone
};

/// Spheres of a finer cut at most; beyond, a default radius is refused.
inline constexpr double kSphereBudget = 1e5;

/// The largest protrusion of a set. Exact for spheres under a flat or convex surface, an upper bound where the surface
/// is concave: of balls about points of each disc (its centre, its rim and a ring half-way), their radius less the
/// depth of the point.
Protrusion largestProtrusion(const TriangleMesh& mesh, const SphereSet& set);

/// decompose(), and how far the set stands out. With an automatic radius a mesh whose set stands out more than
/// permitted, as thin sheets, wedges and tips do, is cut anew by spheres no larger than what touches it, which shrink
/// as far as the part is thin. Throws base::InputError where that needs more than kSphereBudget spheres.
SphereSet decomposeWithin(const TriangleMesh& mesh, const std::string& name, const DecompositionOptions& options,
                          const ProtrusionLimit& limit, Protrusion& protrusion);

/// Whether decomposeWithin() returns the cut of decompose().
bool meets(const ProtrusionLimit& limit, const SphereSet& set, const DecompositionOptions& options,
           const Protrusion& protrusion);

/// A cut as it is reported: of a part or mesh, whose largest protrusion plans print and warnings name.
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
/// Warns of an explicit radius whose protrusion exceeds the limit; else empty.
std::string protrusionWarning(const CutReport& report);

/// Inputs of the result beside cutOrigin(), as text.
std::string limitOrigin(const ProtrusionLimit& limit);

} // namespace grouser::spheredecomp
