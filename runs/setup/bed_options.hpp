// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/scene/scene.hpp"
#include "terrain/bed.hpp"
#include "terrain/height_field.hpp"

#include <optional>
#include <string>
#include <vector>

namespace grouser::setup {

/// The ground surface from the height-map. Throws InputError if the height-map cannot be read.
terrain::HeightField readSurface(const scene::Scene& scene);

/// The rigid floor under grains, with an arbitrary height offset: rigid ground, or under a bed its surface or a plane
/// (without reading the height-map). Empty without terrain.
std::optional<terrain::HeightField> floorShape(const scene::Scene& scene);

/// Warnings and notes on a valid height-map.
struct TerrainRemarks {
  std::vector<std::string> warnings; ///< steep edges through which grains may pass during settling
  std::vector<std::string> notes;    ///< colour, transparent pixels, mapNotes()
};
TerrainRemarks terrainRemarks(const scene::Scene& scene);

/// Options of the scene's bed.
terrain::BedOptions bedOptions(const scene::Scene& scene);

} // namespace grouser::setup
