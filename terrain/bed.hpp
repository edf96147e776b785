// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "terrain/floor_grains.hpp"
#include "terrain/layers.hpp"
#include "terrain/random_bed.hpp"

#include <optional>
#include <variant>

namespace grouser::terrain {

/// Arrangement of a bed: in layers or at random, on a floor that is smooth or rough.
struct BedOptions {
  std::variant<LayerOptions, RandomBedOptions> grains;
  std::optional<FloorGrainOptions> floorGrains;

  double smallestRadius() const, largestRadius() const; ///< [m]
  double meanRadius() const;                            ///< by number, at the surface [m]
  double meanVolume() const;                            ///< by number, at the surface [m3]
};

/// As the overloads of LayerOptions and RandomBedOptions; `grains` counts those that move.
BedPlan planBed(const HeightField& surface, const BedOptions& options);
/// Number of fixed grains on the floor.
std::int64_t fixedGrains(const BedPlan& plan, const BedOptions& options);
/// All grains of the bed; fixed grains of the floor first.
std::vector<Seed> layBed(const HeightField& surface, const BedOptions& options);

} // namespace grouser::terrain
