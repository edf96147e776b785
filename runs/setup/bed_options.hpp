// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/scene/scene.hpp"
#include "terrain/bed.hpp"
#include "terrain/height_field.hpp"

#include <optional>
#include <string>
#include <vector>

namespace grouser::setup {

/// The ground's surface from the height-map. Throws InputError if that cannot be read.
terrain::HeightField readSurface(const scene::Scene& scene);

/// The rigid floor under grains, at any height: the ground, or below a bed its shape or a plane, for which the
/// height-map is not read. Empty without terrain.
std::optional<terrain::HeightField> floorShape(const scene::Scene& scene);

/// Warnings and notes on a valid height-map.
struct TerrainRemarks {
  std::vector<std::string> warnings; ///< edges so steep that a bed may not settle on them: place and slope
  std::vector<std::string> notes;    ///< colour, transparent pixels
};
TerrainRemarks terrainRemarks(const scene::Scene& scene);

/// Options of the scene's bed.
terrain::BedOptions bedOptions(const scene::Scene& scene);

} // namespace grouser::setup
