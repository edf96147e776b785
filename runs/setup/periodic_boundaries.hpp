// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/scene/scene.hpp"
#include "terrain/grains.hpp"

namespace grouser::setup {

/// Where the sides stand that `run.periodic` joins [m]: at the borders of the terrain, or where run.domain_x and
/// run.domain_y say. InputError: a height-map that does not fit together across them.
terrain::PeriodicBoundaries periodicBoundaries(const scene::Scene& scene);

/// The way between two places, or between one and the nearest image of the other.
base::Vec3d toNearestImage(const terrain::PeriodicBoundaries& sides, base::Vec3d way);

/// Grains and sources must lie between the sides. Throws InputError that names the first that does not.
void checkBetweenSides(const scene::Scene& scene, const std::vector<scene::Grain>& grains);

/// Boxes, cylinders and meshes have no images, so none may begin where grains would feel one: see faultAtBoundaries().
/// Throws InputError.
void checkSurfacesBetweenSides(const scene::Scene& scene);

/// `surface` must be as high at one periodic boundary as at the other, all along: level in that direction.
void checkLevelAcross(const scene::Scene& scene, const terrain::HeightField& surface);

} // namespace grouser::setup
