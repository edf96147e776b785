// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/array.hpp"
#include "base/sphere_set.hpp"

#include <cstdint>

namespace grouser::contact {

/// Contact shape of a surface sphere: a disc of radius `flat` about `centre`, normal to `normal`, swept by a ball of
/// `radius`. On a face its top coincides with the mesh plane, without bumps between spheres; next to an edge `flat` is
/// 0 and the sphere rounds the edge.
struct Disc {
  base::Vec3f centre;
  float radius;
  base::Vec3f normal;
  float flat;
};

/// Distance from a ball's centre to a disc's core, with the outward direction.
struct DiscDistance {
  base::Vec3f normal; ///< from the part to the ball
  float distance;     ///< [m]; a ball of radius R overlaps by R + radius - distance
};

GROUSER_HD DiscDistance distanceTo(const Disc& disc, const base::Vec3d& point) {
  const base::Vec3f apart = (point - disc.centre.as<double>()).as<float>();
  base::Vec3f core = apart;
  if (disc.flat > 0) {
    const base::Vec3f along = apart - disc.normal * dot(apart, disc.normal);
    const float size = norm(along);
    core = size <= disc.flat ? apart - along : apart - along * (disc.flat / size);
  }
  const float distance = norm(core);
  return {distance > 0 ? core * (1.0f / distance) : disc.normal, distance};
}

/// Conservative test without a square root; true if a ball does not touch a disc.
GROUSER_HD bool outOfReach(const Disc& disc, const base::Vec3d& point, double ballRadius) {
  const double reach = ballRadius + static_cast<double>(disc.radius) + static_cast<double>(disc.flat) + 1e-7;
  return norm2(point - disc.centre.as<double>()) > reach * reach;
}

/// Static look-up table of a part in its own frame: lists for each cell the discs that a ball centred in it may touch.
struct SurfaceGridView {
  const Disc* disc{nullptr};
  const std::uint32_t* start{nullptr}; ///< [cells + 1]
  const std::uint32_t* entry{nullptr}; ///< disc indices, ascending within a cell
  base::Vec3d low;
  double perEdge{};
  base::Vec3i cells;

  /// False if a ball is outside the table and therefore has no contact.
  GROUSER_HD bool reaches(const base::Vec3d& p, double radius) const {
    const base::Vec3d u = (p - low) * perEdge;
    const double r = radius * perEdge;
    return u.x > -r && u.y > -r && u.z > -r && u.x < cells.x + r && u.y < cells.y + r && u.z < cells.z + r;
  }
  /// Index of the cell that contains `p`; -1 outside the table, where contact is impossible.
  GROUSER_HD std::int64_t cellAt(const base::Vec3d& p) const {
    const base::Vec3d u = (p - low) * perEdge;
    if (!(u.x >= 0 && u.y >= 0 && u.z >= 0 && u.x < cells.x && u.y < cells.y && u.z < cells.z)) return -1;
    return (static_cast<std::int64_t>(u.x) * cells.y + static_cast<std::int64_t>(u.y)) * cells.z +
           static_cast<std::int64_t>(u.z);
  }
};

/// Look-up table for balls of radius up to `ballRadius` [m].
///
/// A disc is omitted from a cell if another disc of the same plane is nearer for every ball centre in that cell: only
/// the nearest disc of a plane makes contact, so the table does not change the result.
class SurfaceGrid {
public:
  SurfaceGrid() = default;
  /// `cellEdge` [m] is increased if the table would exceed about 600,000 cells.
  SurfaceGrid(const base::Exec& exec, const base::SphereSet& set, double ballRadius, double cellEdge);
  SurfaceGridView view() const;
  std::size_t bytes() const { return disc_.bytes() + start_.bytes() + entry_.bytes(); }
  std::size_t entries() const { return entry_.size(); }

private:
  base::Array<Disc> disc_;
  base::Array<std::uint32_t> start_, entry_;
  base::Vec3d low_;
  double perEdge_{};
  base::Vec3i cells_;
};

/// Surface sample of a part, tested against other surfaces; represents a share of the surface area.
struct SurfaceSample {
  base::Vec3f centre;
  float radius;          ///< [m]
  float area;            ///< [m2]
  std::uint32_t cluster; ///< main direction of its normal in the part's frame: 0..5 = -x, +x, -y, +y, -z, +z
};

inline constexpr int kClusters = 6;
/// Returns the cluster of a surface with this normal, in the part frame.
std::uint32_t mainDirection(const base::Vec3d& normal);

/// Returns the discs and samples of a sphere set, in its order.
std::vector<Disc> discsOf(const base::SphereSet& set);
std::vector<SurfaceSample> surfaceSamplesOf(const base::SphereSet& set);

/// Bounding radius of the set about the frame origin [m].
double enclosingRadius(const base::SphereSet& set);

} // namespace grouser::contact
