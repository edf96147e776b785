// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/scene/scene.hpp"
#include "runs/storage/sphere_cache.hpp"
#include "spheredecomp/protrusion.hpp"

#include <vector>

/// Figures of a scene on which the time of its run depends.
namespace grouser::forecast {

/// Grains of the small bed that frictions are tried on, with its floor; 0 without a requested porosity.
double sampleGrains(const scene::Scene& scene, double timeStep);

/// Largest expected grain speed [m/s]: with the track of a vehicle, or with a surface that is moved.
double speedOf(const scene::Scene& scene);

/// Spheres of the vehicle's sets of a scene with so many grains, each set once; 0 where some are still to be cut.
/// `cuts` receives their reports.
double keptSpheres(const scene::Scene& scene, double grains, storage::SphereCache kept,
                   std::vector<spheredecomp::CutReport>& cuts);

/// Returns true if the cache holds the sphere sets of all scene and body meshes that have contacts. `cuts` receives
/// their reports.
bool keptMeshes(const scene::Scene& scene, double grains, double timeStep, storage::SphereCache kept,
                std::vector<spheredecomp::CutReport>& cuts);

} // namespace grouser::forecast
