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

/// Structure of a bed, measured in a central column that excludes two mean diameters next to floor, surface and walls,
/// where grains are ordered or loose, but not next to periodic boundaries.
struct BedStructure {
  double porosity{};                                ///< [-] fraction of sample points outside all grains
  double porosityError{};                           ///< [-] standard error due to random sample points
  double coordination{};                            ///< [-] contacts per grain, including contacts with fixed grains
  double rattlers{};                                ///< [-] fraction of grains with fewer than two contacts
  double order{};                                   ///< [-] fraction of grains in crystalline surroundings (see below)
  double meanDiameter{};                            ///< [m] mean over the grains
  double settledHeight{};                           ///< [m] mean of the undisturbed surface
  double highest{}, lowest{};                       ///< [m] extremes of that surface
  double thickness{};                               ///< [m] mean of the surface above the floor
  std::int64_t grains{};                            ///< number of grains measured
  std::vector<double> distance, radialDistribution; ///< [mean diameters], [-]: radial distribution function
  std::vector<double> depth, porosityAtDepth;       ///< [m] below the surface, [-]: porosity over the whole depth
};

/// Grain at rest.
struct LyingGrain {
  base::Vec3d centre; ///< [m]
  double radius;      ///< [m]
  bool fixed;
};

/// Extent of a bed.
struct BedExtent {
  Rectangle walls;
  std::array<bool, 2> periodic;                      ///< along x, y: periodic boundaries instead of walls
  std::function<double(double x, double y)> floor;   ///< [m]
  std::function<double(double x, double y)> surface; ///< [m]
};

/// Heights of a bed, sampled at 64 x 64 points.
struct BedHeights {
  double mean{}, highest{}, lowest{}; ///< heights of the surface [m]
  double thickness{};                 ///< mean height of the surface above the floor [m]
};
BedHeights heightsOf(const BedExtent& extent);

/// Measures the structure of a bed at rest. Order follows ten Wolde, Ruiz-Montero and Frenkel (1996, J. Chem. Phys.
/// 104, 9932) with bond-orientational order of degree 6 (Steinhardt, Nelson and Ronchetti 1983). Neighbours within 1.4
/// times the sum of their radii are connected if the normalised product of their order vectors exceeds 0.7; a grain
/// with at least seven connections is in crystalline surroundings.
/// The result is the same on every rank, device and number of threads: `grains` are sorted by id.
BedStructure measureBed(const std::vector<LyingGrain>& grains, const BedExtent& extent);

/// Measures a bed during a run, on at most about 60,000 of its grains. The result is the same on all ranks.
BedStructure measureBed(const Grains& grains, const BedExtent& extent);

} // namespace grouser::terrain
