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

/// What a bed is made of, measured on grains as they lie. All of it within a column through the middle of the bed, two
/// mean diameters away from floor, surface and walls, but not from periodic boundaries: what is next to the former is
/// ordered or loose.
struct BedStructure {
  double porosity{};                                ///< [-] share of points that lie in no grain
  double porosityError{};                           ///< [-] standard error of that: points are drawn at random
  double coordination{};                            ///< [-] contacts a grain, fixed grains among the partners
  double rattlers{};                                ///< [-] share of the grains with fewer than two contacts
  double order{};                                   ///< [-] share of the grains in crystalline surroundings: see below
  double meanDiameter{};                            ///< [m] by number
  double settledHeight{};                           ///< [m] mean of the undisturbed surface
  double highest{}, lowest{};                       ///< [m] of that surface
  double thickness{};                               ///< [m] mean of the surface above the floor
  std::int64_t grains{};                            ///< that were looked at
  std::vector<double> distance, radialDistribution; ///< [mean diameters], [-]
  std::vector<double> depth, porosityAtDepth;       ///< [m] below the surface, [-]; of the whole depth
};

/// A grain as it lies.
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

/// How high a bed stands, of 64 x 64 places.
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

/// Of a running bed on all ranks, each of which gets the answer: at most about 60,000 grains of it.
BedStructure measureBed(const Grains& grains, const BedExtent& extent);

} // namespace grouser::terrain
