// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "terrain/grain_model.hpp"
#include "terrain/rigid_surface.hpp"

#include <array>
#include <cmath>
#include <optional>
#include <vector>

/// Initial grains and surroundings of a scene, in addition to the GrainModel.
namespace grouser::terrain {

/// Initial state of one grain; its id is its index in the list.
struct GrainSpec {
  base::Vec3d position; ///< [m]
  base::Vec3d velocity; ///< [m/s]
  base::Vec3d spin;     ///< [rad/s]
  double radius{0};     ///< [m], at most the model's; 0: the model's
  int material{0};      ///< index in the model's materials
  /// Fixed grain: never moves, without mass or weight; models rough ground. Velocity and spin must be zero. Fixed
  /// grains may overlap each other.
  bool fixed{false};
};

/// Positions [m] of the lower and upper periodic boundary along x and y. Grains that leave through one enter through
/// the other, and interact across them.
using PeriodicBoundaries = std::array<std::optional<std::array<double, 2>>, 2>;
/// Reduces the vector between two positions to that of the nearest image.
inline base::Vec3d toNearestImage(const PeriodicBoundaries& sides, base::Vec3d way) {
  for (std::size_t a = 0; a < 2; ++a) {
    if (!sides[a]) continue;
    const double period = (*sides[a])[1] - (*sides[a])[0];
    double& d = way[static_cast<int>(a)];
    d -= period * std::floor(d / period + 0.5);
  }
  return way;
}

/// Rigid surroundings of the grains: plane walls, a height-field floor, and movable surfaces; at most 32 in
/// total.
struct Boundaries {
  std::vector<Wall> walls;
  std::optional<HeightField> floor;
  PeriodicBoundaries periodic{}; ///< walls, floor and surfaces are not replicated: they must match at both boundaries
  std::vector<RigidSurface> surfaces{};

  /// Maximum floor contacts of a grain of `radius` [m]: several if the floor has tighter hollows.
  int floorPlaces(double radius) const;
  /// Number of boundaries with contact springs: walls, floor contacts, surfaces. `radius`: largest grain radius [m].
  int count(double radius) const { return static_cast<int>(walls.size() + surfaces.size()) + floorPlaces(radius); }
};

/// Laws against walls, floor and surfaces, [walls, floor, surfaces][materials].
std::vector<contact::ContactLaw> boundaryLaws(const GrainModel& model, const Boundaries& boundaries);

} // namespace grouser::terrain
