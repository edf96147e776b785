// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "spheredecomp/mesh_query.hpp"

#include <vector>

namespace grouser::spheredecomp::detail {

/// Sample point of the outer surface with the area it represents.
struct SurfaceSample {
  Vec3d point;
  Vec3d normal;  ///< outward
  double area{}; ///< [m2]
};

/// Outer surface of the union of a mesh's shells: the triangles of the mesh without their parts inside another shell.
/// Intersected triangles are subdivided down to `resolution`, and each piece is classified.
class OuterSurface {
public:
  /// @param mesh  closed and welded; @param resolution  resolution of intersection curves [m]
  OuterSurface(const TriangleMesh& mesh, double resolution);

  const MeshQuery& solid() const { return solid_; }     ///< all shells: winding numbers
  const MeshQuery& surface() const { return surface_; } ///< outer triangles only: distances

  /// Outward normal of the mesh triangle that contains an outer triangle.
  const Vec3d& normal(std::uint32_t outerTriangle) const { return solid_.normal(parent_[outerTriangle]); }

  /// Area of the outer surface [m2]. Coincident faces count once.
  double area() const { return area_; }

  /// Volume of the union of the shells [m3]; its accuracy is the resolution of the intersection curves of shells.
  double volume() const { return volume_; }

  /// Returns points about `spacing` [m] apart, in the order of the mesh; the sum of their areas is area().
  std::vector<SurfaceSample> samples(double spacing) const;

private:
  MeshQuery solid_, surface_;
  std::vector<std::uint32_t> parent_;
  std::vector<double> weight_; ///< 1 / number of coincident faces
  double area_{}, volume_{};
};

} // namespace grouser::spheredecomp::detail
