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
/// `radius`. The union of the rounded discs is the part's surface to the tolerances of the decomposition. A ball of
/// radius R at c touches the rounded disc nearest to it: q = centre + the part of (c - centre) perpendicular to
/// `normal`, shortened to the length `flat`; overlap R + radius - |c - q|, outward normal (c - q) / |c - q|. Above a
/// face this is the face's plane exactly, without the bumps between spheres.
struct SetSphere {
  Vec3d centre;    ///< [m]
  double radius{}; ///< [m]; the set's radius, smaller only where the part is thinner than a sphere
  Vec3d normal; ///< outward unit normal of the mesh face it lies under; zero for an interior sphere. Where the part is
                ///< as thin as the sphere, one sphere serves both sides and carries the normal of one of them
  double offset{}; ///< [m]: the plane of that face is normal . x = offset; normal . centre + radius <= offset, with
                   ///< equality but for spheres that an edge or a concave corner pushes deeper
  double flat{};   ///< [m] >= 0, radius of the disc; 0 next to a convex edge, where the sphere itself rounds the edge
  double area{}; ///< [m2] outer mesh area this sphere stands for; the sum over a set is the mesh's outer area; may be 0
  bool surface() const { return norm2(normal) > 0; }
};

/// A rigid part cut into spheres: surface spheres first, then interior ones.
struct SphereSet {
  std::string name;
  std::vector<SetSphere> spheres;
  std::size_t surfaceCount{};
  double spacing{};    ///< [m] lattice spacing
  double radius{};     ///< [m] sphere radius, the largest of the set
  double meshVolume{}; ///< [m3] of the union of the mesh's shells
  double meshArea{};   ///< [m2] of the outer surface of that union
};

/// Plain data of a set besides spheres and name, for files and other ranks.
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
  std::vector<std::uint32_t> indices; ///< 3 a triangle
};

} // namespace grouser::base
