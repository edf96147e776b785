// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/sphere_set.hpp"

#include <cstddef>
#include <string>

namespace grouser::spheredecomp {

using base::SphereSet;
using base::TriangleMesh;

/// Distances between surface A (outer surface of the mesh) and surface B (of the set) [m].
struct SurfaceDistance {
  double meshToSet{};  ///< maximum distance from a point of the mesh to the set's surface (one-sided Hausdorff)
  double setToMesh{};  ///< maximum distance from a point of the set's surface to the mesh
  double rms{};        ///< root mean square of meshToSet over the mesh's area
  double protrusion{}; ///< maximum distance of a point of the set's surface outside the mesh
  double hausdorff() const { return meshToSet > setToMesh ? meshToSet : setToMesh; }
};

/// Accuracy of a sphere set for its mesh.
struct Quality {
  std::size_t surfaceCount{};
  std::size_t interiorCount{};
  SurfaceDistance discs;   ///< set = rounded discs (SetSphere::flat), as used by contacts
  SurfaceDistance spheres; ///< set = plain spheres
  double volumeRatio{};    ///< volume of the union of all spheres / volume of the mesh [-]
  double areaRatio{};      ///< sum of SetSphere::area / outer area of the mesh [-]
};

/// Measures the accuracy by deterministic sampling at about a third of the spacing. Therefore the distances are lower
/// bounds; the maximum over the whole surface is larger by up to a few hundredths of the radius.
Quality measure(const TriangleMesh& mesh, const SphereSet& set);

/// Text report of the accuracy, a few lines with units.
std::string report(const SphereSet& set, const Quality& quality);

} // namespace grouser::spheredecomp
