// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/vec.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace grouser::base {

/// One sphere of a decomposed part, in the part's mesh frame.
///
/// A surface sphere is a rounded disc: a disc of radius `flat` about `centre`, perpendicular to `normal`, inflated by
/// `radius`. The union of the rounded discs is the part's surface within the tolerances of the decomposition. A ball of
/// radius R at c contacts the nearest rounded disc: q = centre + the component of (c - centre) perpendicular to
/// `normal`, limited to the length `flat`; overlap R + radius - |c - q|, outward normal (c - q) / |c - q|. Over a face
/// this reproduces the face's plane exactly, without bumps between spheres.
struct SetSphere {
  Vec3d centre;    ///< [m]
  double radius{}; ///< [m]; the set's radius, or less if the part is thinner than a sphere
  Vec3d normal; ///< outward unit normal of the mesh face above the sphere; zero for an interior sphere. If the part is
                ///< as thin as the sphere, one sphere represents both sides and has the normal of one side
  double offset{}; ///< [m]: the plane of this face is normal . x = offset; normal . centre + radius <= offset, with
                   ///< equality except for spheres moved deeper at an edge or a concave corner
  double flat{};   ///< [m] >= 0, radius of the disc; 0 next to a convex edge, which the sphere itself rounds
  double area{};   ///< [m2] outer mesh area represented by this sphere, >= 0; the sum over a set is the outer mesh area
  bool surface() const { return norm2(normal) > 0; }
};

/// Sphere decomposition of a rigid part: surface spheres first, then interior spheres.
struct SphereSet {
  std::string name;
  std::vector<SetSphere> spheres;
  std::size_t surfaceCount{};
  double spacing{};    ///< [m] lattice spacing
  double radius{};     ///< [m] sphere radius, the largest of the set
  double meshVolume{}; ///< [m3] volume of the union of the mesh's shells
  double meshArea{};   ///< [m2] area of the outer surface of this union
};

/// Scalar properties of a set, without spheres and name, for files and messages between ranks.
struct SphereSetFigures {
  std::uint64_t spheres, surfaceCount;
  double spacing, radius, meshVolume, meshArea;
};
inline SphereSetFigures figuresOf(const SphereSet& set) {
  return {set.spheres.size(), set.surfaceCount, set.spacing, set.radius, set.meshVolume, set.meshArea};
}
inline void setFigures(SphereSet& set, const SphereSetFigures& f) {
  set.surfaceCount = f.surfaceCount, set.spacing = f.spacing, set.radius = f.radius;
  set.meshVolume = f.meshVolume, set.meshArea = f.meshArea;
}

/// Triangle mesh: vertices [m], counter-clockwise seen from outside.
struct TriangleMesh {
  std::vector<Vec3d> vertices;
  std::vector<std::uint32_t> indices; ///< 3 per triangle
};

} // namespace grouser::base
