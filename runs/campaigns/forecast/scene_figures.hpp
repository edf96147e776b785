// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/scene/scene.hpp"
#include "runs/storage/sphere_cache.hpp"
#include "spheredecomp/protrusion.hpp"

#include <vector>

/// Properties of a scene that determine its run time.
namespace grouser::forecast {

/// Number of grains, including its floor, of the small bed for the friction search; 0 without a porosity.
double sampleGrains(const scene::Scene& scene, double timeStep);

/// Largest expected grain speed [m/s], caused by the tracks of a vehicle or by a moving surface.
double speedOf(const scene::Scene& scene);

/// Number of spheres in the vehicle's unique sets, for a scene with `grains` grains; 0 if a set is not cached. `cuts`
/// receives the reports on the sets.
double keptSpheres(const scene::Scene& scene, double grains, storage::SphereCache kept,
                   std::vector<spheredecomp::CutReport>& cuts);

/// Returns true if the cache contains the sphere sets of all scene and body meshes that have contacts. `cuts` receives
/// the reports on the sets.
bool keptMeshes(const scene::Scene& scene, double grains, double timeStep, storage::SphereCache kept,
                std::vector<spheredecomp::CutReport>& cuts);

} // namespace grouser::forecast
