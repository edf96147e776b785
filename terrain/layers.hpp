// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "terrain/bed_plan.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace grouser::terrain {

/// Options of a bed in layers.
struct LayerOptions {
  double radius{}; ///< radius of every grain [m], > 0
  int layers{0};   ///< number of layers, >= 1, or 0: derived from `depth` (flat floor: at the lowest point)
  double depth{0}; ///< thickness of the settled bed [m], > 0; used if `layers` is 0
  /// Layers settle into each other's pockets. Near 2.1 they form a nearly regular packing with a smooth surface
  /// (scatter of 0.06 radii on level ground); from 2.6 with full jitter, a disordered packing (0.3 radii).
  double spacingInRadii{2.1}; ///< lattice spacing in x and y, and between layers on level ground [radii], (2, 10]
  double jitter{0.9};         ///< used fraction of the free gap, [0, 1] [-]
  double packing{0.6};        ///< expected solid fraction of the settled bed [-], in [0.3, 0.74]
  FloorShape floor{FloorShape::follow};
  double wallMargin{0};           ///< distance of the walls inside the height map's border [m], >= 0
  std::array<bool, 2> periodic{}; ///< along x, y: periodic borders instead of walls; the lattice closes there
  std::uint64_t seed{1};
};

/// Plans a bed whose settled surface approximates `surface`: the layer thickness is the grain volume / (area between
/// the walls x `packing`). Trial beds (5 and 8 layers, friction 0.5, level and 20 % slope, settled under gravity)
/// deviated from the height map by -0.4 to +1.0 radii; with the default options, by +0.03 radii. Cost O(grains). Throws
/// InputError if an option is out of range, or not even one grain fits between the walls.
BedPlan planBed(const HeightField& surface, const LayerOptions& options);

/// Places the grains of `planBed(surface, options)`, layer by layer from `lift` [m] above the floor, row by row (y),
/// along x.
///
/// Each layer is a square lattice in (x, y), every second one offset by half a spacing in both directions, with random
/// jitter in x, y and (upwards) z from (seed, id). A grain is at least 1/20 radius above the floor and at least
/// sqrt(3/2) spacings from the up to four grains below it: one spacing of height on level ground, more on a slope. No
/// two grains overlap, for any surface: grains of one layer, or of layers of equal offset, differ by a spacing less the
/// jitter in x or y, or are in one column, where each layer is higher than the second one below it by more than a
/// diameter.
std::vector<Seed> layGrains(const HeightField& surface, const LayerOptions& options, double lift = 0);

} // namespace grouser::terrain
