// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "terrain/bed_plan.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace grouser::terrain {

/// Options of a bed in layers.
struct LayerOptions {
  double radius{}; ///< of every grain [m], > 0
  int layers{0};   ///< >= 1, or 0: as many as `depth` needs. With a flat floor: at the lowest point
  double depth{0}; ///< thickness of the settled bed [m], > 0; used when `layers` is 0
  /// Layers fall into each other's pockets: near 2.1 they settle to a nearly regular packing with a smooth surface
  /// (scatter of 0.06 radii on level ground), from 2.6 with full jitter to a disordered one (0.3 radii).
  double spacingInRadii{2.1}; ///< of the lattice, in x and y and between layers on level ground [-], in (2, 10]
  double jitter{0.9};         ///< share of the free gap that a grain may use, [0, 1] [-]
  double packing{0.6};        ///< solid fraction expected once settled [-], in [0.3, 0.74]
  FloorShape floor{FloorShape::follow};
  double wallMargin{0};           ///< walls stand this far inside the height-map's border [m], >= 0
  std::array<bool, 2> periodic{}; ///< along x, y: no walls; the borders are periodic and the lattice closes there
  std::uint64_t seed{1};
};

/// Plans a bed whose settled surface comes close to `surface`: grains' volume over wall-to-wall area and `packing`
/// gives the thickness of a layer. Trial beds (5 and 8 layers, friction 0.5, level and 20 % slope, settled under
/// gravity) came to lie -0.4 to +1.0 radii from the height-map, with the default options +0.03. O(grains). InputError:
/// an option out of its range, no room for one grain between the walls.
BedPlan planBed(const HeightField& surface, const LayerOptions& options);

/// Lays the grains of `planBed(surface, options)`, layer by layer from `lift` [m] above the floor, row by row (y) and
/// along x.
///
/// Each layer is a square lattice in (x, y), every second one offset by half a spacing both ways, jittered in x, y and
/// (upwards) z by random numbers of (seed, id). A grain keeps a twentieth of a radius from the floor and at least
/// sqrt(3/2) spacings from the up to four grains it will rest on; on level ground that is one spacing of height, on a
/// slope as much more as the slope needs. No two grains ever overlap, whatever the surface: grains of one layer, or of
/// layers of equal offset, differ by a spacing less the jitter in x or y, or stand in one column, where each layer is
/// higher than the last but one by more than a diameter.
std::vector<Seed> layGrains(const HeightField& surface, const LayerOptions& options, double lift = 0);

} // namespace grouser::terrain
