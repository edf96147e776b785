// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/position.hpp"
#include "base/vec.hpp"
#include "terrain/height_field.hpp"

#include <array>
#include <functional>
#include <vector>

namespace grouser::terrain {

class Grains;

/// Structure of a bed, measured within a column through its middle, two mean diameters away from floor, surface and
/// walls, where grains are ordered or loose, but not from periodic boundaries.
struct BedStructure {
  double porosity{};                                ///< [-] share of points that lie in no grain
  double porosityError{};                           ///< [-] standard error: points are drawn at random
  double coordination{};                            ///< [-] contacts a grain, fixed grains among the partners
  double rattlers{};                                ///< [-] share of the grains with fewer than two contacts
  double order{};                                   ///< [-] share of the grains in crystalline surroundings: see below
  double meanDiameter{};                            ///< [m] by number
  double settledHeight{};                           ///< [m] mean of the undisturbed surface
  double highest{}, lowest{};                       ///< [m] of that surface
  double thickness{};                               ///< [m] mean of the surface above the floor
  std::int64_t grains{};                            ///< number of grains measured
  std::vector<double> distance, radialDistribution; ///< [mean diameters], [-]
  std::vector<double> depth, porosityAtDepth;       ///< [m] below the surface, [-]; of the whole depth
};

/// A grain at rest.
struct LyingGrain {
  base::Vec3d centre; ///< [m]
  double radius;      ///< [m]
  bool fixed;
};

/// A bed's limits.
struct BedExtent {
  Rectangle walls;
  std::array<bool, 2> periodic;                      ///< along x, y: no walls there, and grains go on beyond
  std::function<double(double x, double y)> floor;   ///< [m]
  std::function<double(double x, double y)> surface; ///< [m]
};

/// Heights of a bed at 64 x 64 places.
struct BedHeights {
  double mean{}, highest{}, lowest{}; ///< of the surface [m]
  double thickness{};                 ///< mean of the surface above the floor [m]
};
BedHeights heightsOf(const BedExtent& extent);

/// Order is judged as by ten Wolde, Ruiz-Montero and Frenkel (1996, J. Chem. Phys. 104, 9932) with bond-orientational
/// order of degree 6 (Steinhardt, Nelson and Ronchetti 1983): two neighbours nearer than 1.4 times the sum of their
/// radii are alike where the normalised product of their order vectors exceeds 0.7; a grain with at least seven alike
/// neighbours is in crystalline surroundings.
/// The same on every rank, device and number of threads: `grains` are sorted by id.
BedStructure measureBed(const std::vector<LyingGrain>& grains, const BedExtent& extent);

/// Measures a running bed with the same result on all ranks: at most about 60,000 of its grains.
BedStructure measureBed(const Grains& grains, const BedExtent& extent);

} // namespace grouser::terrain
