// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/vec.hpp"
#include "runs/setup/contact_pairs.hpp"
#include "terrain/grains.hpp"

#include <optional>
#include <string>
#include <vector>

namespace grouser::setup {

/// Rigid contact partners of grains: walls, floor and surfaces.
struct Surroundings {
  struct Wall {
    base::Vec3d normal;
    double offset;
    std::string material;
    std::string name{};               ///< name in messages: "plane 0"
    std::optional<double> friction{}; ///< replaces the friction of the materials [-]
  };
  std::vector<Wall> walls;
  std::optional<terrain::HeightField> floor;
  std::string floorMaterial;
  std::vector<SceneSurface> surfaces{};
};

/// Walls and floor of the terrain, planes and surfaces, in the order of the grains' boundaries. `bedWalls`: rectangle
/// enclosed by the walls of a bed.
Surroundings surroundingsOf(const scene::Scene& scene, const ContactPairs& pairs,
                            const std::optional<terrain::HeightField>& floor, const terrain::Rectangle& bedWalls);

/// The grains' constants, and their walls, floor and surfaces with their laws.
terrain::GrainModel grainModel(const scene::Scene& scene, const GrainKinds& kinds, double timeStep,
                               const Surroundings& surroundings, terrain::Boundaries& boundaries);

} // namespace grouser::setup
