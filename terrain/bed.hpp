// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "terrain/floor_grains.hpp"
#include "terrain/layers.hpp"
#include "terrain/random_bed.hpp"

#include <optional>
#include <variant>

namespace grouser::terrain {

/// Options of a bed: layered or random arrangement, smooth or rough floor.
struct BedOptions {
  std::variant<LayerOptions, RandomBedOptions> grains;
  std::optional<FloorGrainOptions> floorGrains;

  double smallestRadius() const, largestRadius() const; ///< [m]
  double meanRadius() const;                            ///< by number, at the surface [m]
  double meanVolume() const;                            ///< by number, at the surface [m3]
};

/// Same as planBed() for LayerOptions and RandomBedOptions; `grains` counts the movable grains.
BedPlan planBed(const HeightField& surface, const BedOptions& options);
/// Number of fixed grains on the floor.
std::int64_t fixedGrains(const BedPlan& plan, const BedOptions& options);
/// Returns all grains of the bed, the fixed grains of the floor first.
std::vector<Seed> layBed(const HeightField& surface, const BedOptions& options);

} // namespace grouser::terrain
