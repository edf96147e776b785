// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/sphere_set.hpp"

#include <cstddef>
#include <string>

namespace grouser::spheredecomp {

using base::SphereSet;
using base::TriangleMesh;

inline constexpr double kSmallestRadius = 1e-6, kLargestRadius = 1e3; ///< of spheres [m]
inline constexpr double kMostLatticePoints = 5e7;                     ///< maximum number of lattice points

/// Resolution of a decomposition: a radius, or a count from which the radius follows.
struct DecompositionOptions {
  double radius{};           ///< sphere radius [m]; 0: from targetCount
  std::size_t targetCount{}; ///< wanted number of spheres; used when radius is 0
  double spacingRatio{1.0};  ///< lattice spacing / radius [-], in [0.2, 1.5]
  /// Surface spheres are added until the surface dips no more than this between them [radius]. Tested at points 0.33
  /// spacing apart; between those it may dip up to (sqrt(2 maxDip) + 0.165)^2 / 2.
  double maxDip{0.05};
  double flatTolerance{0.01}; ///< a flat disc may stand this much out of the mesh [radius]
  double smallest{0.2};       ///< spheres shrink to this share of the radius where the part is thin [-]
  bool thin{false};           ///< the part is thin in places: finer fits, discs and samples there
  std::size_t most{};         ///< surface spheres beyond which the cut stops, unfinished; 0: no limit
  bool interior{true};        ///< also fill the inside with lattice spheres (contacts need the surface only)
};

/// Cuts a closed mesh into spheres of one radius on a lattice. Shells may overlap: only the outer surface of their
/// union becomes surface. Each lattice point inside that is nearer to the surface than radius + spacing/2 moves along
/// the surface normal to the depth of one radius; near edges, to where the sphere fits; where the part is thinner than
/// a sphere, the sphere shrinks. Holes that remain are closed by spheres under points of the surface. Deterministic for
/// any thread count.
/// @param mesh  closed, outward, welded (see importMesh)
/// @param name  kept in the result and named in errors
/// Throws base::InputError when the options are out of range, the mesh is not closed, or the radius is too coarse
/// (above half the longest side of the bounding box) or too fine for the part (more than 50 million lattice points).
SphereSet decompose(const TriangleMesh& mesh, const std::string& name, const DecompositionOptions& options);

/// Version of the results of decompose(). Sets are cached between runs under cutOrigin(): increase it in every commit
/// that changes any bit of a set. CutVersion in tests/spheredecomp/cut_version_test.cpp detects such changes.
inline constexpr int kCutVersion = 1;

/// All inputs of the spheres of decompose(), as text: version, every option, and a hash of the mesh. Equal texts mean
/// bitwise equal spheres; the set's name is not included.
std::string cutOrigin(const TriangleMesh& mesh, const DecompositionOptions& options);

/// Number of lattice points that spheres of `radius` require at the default spacing; decompose() refuses more than
/// kMostLatticePoints.
double latticePoints(const TriangleMesh& mesh, double radius);

} // namespace grouser::spheredecomp
