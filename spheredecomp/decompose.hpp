// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/sphere_set.hpp"

#include <cstddef>
#include <string>

namespace grouser::spheredecomp {

using base::SphereSet;
using base::TriangleMesh;

inline constexpr double kSmallestRadius = 1e-6, kLargestRadius = 1e3; ///< sphere radius limits [m]
inline constexpr double kMaxLatticePoints = 5e7;                      ///< maximum number of lattice points

/// Options of a decomposition: a sphere radius, or a target count that determines the radius, and limits.
struct DecompositionOptions {
  double radius{};           ///< sphere radius [m]; 0: from targetCount
  std::size_t targetCount{}; ///< target number of spheres; used if radius is 0
  double spacingRatio{1.0};  ///< lattice spacing / radius [-], in [0.2, 1.5]
  /// Maximum depth of the dips between surface spheres [radius]; spheres are added until no dip is deeper at the tested
  /// points, which are 0.33 spacing apart. Between these points a dip may reach (sqrt(2 maxDip) + 0.165)^2 / 2.
  double maxDip{0.05};
  double flatTolerance{0.01}; ///< maximum protrusion of a flat disc from the mesh [radius]
  double smallest{0.2};       ///< minimum sphere radius at thin places of the part, relative to the radius [-]
  bool thin{false};           ///< true: the part has thin places, which receive finer fits, discs and samples
  std::size_t most{};         ///< number of surface spheres above which decompose() stops unfinished; 0: no limit
  bool interior{true};        ///< true: also fill the interior with lattice spheres (contacts need the surface only)
};

/// Decomposes a closed mesh into spheres of one radius on a lattice. Shells may overlap: only the outer surface of
/// their union is used. Each inner lattice point nearer to the surface than radius + spacing/2 moves along the surface
/// normal to a depth of one radius, or near edges to the nearest place where the sphere fits. If the part is thinner
/// than the sphere, the sphere shrinks. Spheres under points of the surface close the remaining holes. The result does
/// not depend on the thread count.
/// @param mesh  closed, outward, welded (see importMesh)
/// @param name  stored in the result and used in error messages
/// Throws base::InputError if the options are out of range, the mesh is not closed, or the radius is too coarse (above
/// half the longest side of the bounding box) or too fine for the part (more than 50 million lattice points).
SphereSet decompose(const TriangleMesh& mesh, const std::string& name, const DecompositionOptions& options);

/// Version of the results of decompose(), part of cutOrigin(), by which sets are cached between runs. Increment it in
/// every commit that changes any bit of a set; CutVersion in tests/spheredecomp/cut_version_test.cpp detects this.
inline constexpr int kCutVersion = 1;

/// Returns all inputs of decompose() as text: version, every option, and a hash of the mesh. Equal texts imply bitwise
/// equal spheres; the set's name is not included.
std::string cutOrigin(const TriangleMesh& mesh, const DecompositionOptions& options);

/// Returns the number of lattice points required for spheres of `radius` at the default spacing; decompose() rejects
/// more than kMaxLatticePoints.
double latticePoints(const TriangleMesh& mesh, double radius);

} // namespace grouser::spheredecomp
