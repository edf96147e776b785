// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "terrain/grain_model.hpp"
#include "terrain/rigid_surface.hpp"

#include <array>
#include <cmath>
#include <optional>
#include <vector>

/// Initial grains and surroundings of a scene, besides the GrainModel.
namespace grouser::terrain {

/// Initial state of one grain; its id is its place in the list.
struct GrainSpec {
  base::Vec3d position; ///< [m]
  base::Vec3d velocity; ///< [m/s]
  base::Vec3d spin;     ///< [rad/s]
  double radius{0};     ///< [m], at most the model's; 0: the model's
  int material{0};      ///< among the model's
  /// Never moves, whatever acts on it, and has neither mass nor weight: rough ground from which others bounce. Its
  /// velocity and spin must be zero. Fixed grains may overlap each other.
  bool fixed{false};
};

/// Positions [m] of the lower and upper periodic boundary along x and y. Grains that leave through one enter through
/// the other, and touch across them.
using PeriodicBoundaries = std::array<std::optional<std::array<double, 2>>, 2>;
/// Vector between two positions, or between one and the nearest image of the other.
inline base::Vec3d toNearestImage(const PeriodicBoundaries& sides, base::Vec3d way) {
  for (std::size_t a = 0; a < 2; ++a) {
    if (!sides[a]) continue;
    const double period = (*sides[a])[1] - (*sides[a])[0];
    double& d = way[static_cast<int>(a)];
    d -= period * std::floor(d / period + 0.5);
  }
  return way;
}

/// Rigid surroundings of the grains: plane walls, a height-field floor, and surfaces that may move; at most 32
/// together.
struct Boundaries {
  std::vector<Wall> walls;
  std::optional<HeightField> floor;
  PeriodicBoundaries periodic{}; ///< walls, floor and surfaces have no images: they must look alike at both
  std::vector<RigidSurface> surfaces{};

  /// Contacts that one grain may have with the floor: several where that has hollows tighter than `radius` [m].
  int floorPlaces(double radius) const;
  /// Boundaries that grains have springs with: walls, places of the floor, surfaces. `radius` [m]: the largest grain's.
  int count(double radius) const { return static_cast<int>(walls.size() + surfaces.size()) + floorPlaces(radius); }
};

/// Laws against walls, floor and surfaces, [walls, floor, surfaces][materials].
std::vector<contact::ContactLaw> boundaryLaws(const GrainModel& model, const Boundaries& boundaries);

} // namespace grouser::terrain
