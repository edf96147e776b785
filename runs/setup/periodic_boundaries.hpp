// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "terrain/grains.hpp"

namespace grouser::scene {
struct Grain;
struct Scene;
} // namespace grouser::scene

namespace grouser::setup {

struct ContactPairs;

/// Where the sides stand that `run.periodic` joins [m]: at the borders of the terrain, or where run.domain_x and
/// run.domain_y say. InputError: a height-map that does not fit together across them.
terrain::PeriodicBoundaries periodicBoundaries(const scene::Scene& scene);

/// Grains and sources must lie between the sides. Throws InputError that names the first that does not.
void checkBetweenSides(const scene::Scene& scene, const std::vector<scene::Grain>& grains);

/// Boxes, cylinders and meshes have no images, so none may begin where grains would feel one: see
/// coupling::faultAtBoundaries(). Throws InputError.
void checkSurfacesBetweenSides(const scene::Scene& scene, const ContactPairs& pairs);

/// `surface` must be as high at one periodic boundary as at the other, all along: level in that direction.
void checkLevelAcross(const scene::Scene& scene, const terrain::HeightField& surface);

} // namespace grouser::setup
