// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "terrain/grains.hpp"

namespace grouser::scene {
struct Grain;
struct Scene;
} // namespace grouser::scene

namespace grouser::setup {

struct ContactPairs;

/// Positions of the periodic boundaries [m]: the borders of the terrain, or run.domain_x and run.domain_y.
terrain::PeriodicBoundaries periodicBoundaries(const scene::Scene& scene);

/// Throws InputError for the first grain or source that is not between the periodic boundaries.
void checkBetweenSides(const scene::Scene& scene, const std::vector<scene::Grain>& grains);

/// Throws InputError for a box, cylinder or mesh so close to a periodic boundary that grains would touch its image:
/// surfaces have no images (coupling::faultAtBoundaries()).
void checkSurfacesBetweenSides(const scene::Scene& scene, const ContactPairs& pairs);

/// Throws InputError unless `surface` is level along the periodic directions.
void checkLevelAcross(const scene::Scene& scene, const terrain::HeightField& surface);

} // namespace grouser::setup
