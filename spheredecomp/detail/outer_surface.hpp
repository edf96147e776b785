// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "spheredecomp/mesh_query.hpp"

#include <vector>

namespace grouser::spheredecomp::detail {

/// A point of the outer surface that represents a small piece of it.
struct SurfaceSample {
  Vec3d point;
  Vec3d normal;  ///< outward
  double area{}; ///< [m2]
};

/// The surface of the union of a mesh's shells: its triangles without the parts that lie inside another shell.
/// Triangles that are cut by others are divided down to `resolution` and sorted piece by piece.
class OuterSurface {
public:
  /// @param mesh  closed and welded; @param resolution  length [m] to which intersection curves are resolved
  OuterSurface(const TriangleMesh& mesh, double resolution);

  const MeshQuery& solid() const { return solid_; }     ///< all shells: winding numbers
  const MeshQuery& surface() const { return surface_; } ///< outer triangles only: distances

  /// Outward normal of the mesh's triangle that an outer triangle is part of.
  const Vec3d& normal(std::uint32_t outerTriangle) const { return solid_.normal(parent_[outerTriangle]); }

  /// Area of the outer surface [m2]. Faces that coincide count once.
  double area() const { return area_; }

  /// Volume of the union of the shells [m3]; where shells intersect, to the resolution of the intersection curves.
  double volume() const { return volume_; }

  /// Points about `spacing` [m] apart, whose areas add up to area(). The order follows the mesh.
  std::vector<SurfaceSample> samples(double spacing) const;

private:
  MeshQuery solid_, surface_;
  std::vector<std::uint32_t> parent_;
  std::vector<double> weight_; ///< 1 / number of coinciding faces
  double area_{}, volume_{};
};

} // namespace grouser::spheredecomp::detail
