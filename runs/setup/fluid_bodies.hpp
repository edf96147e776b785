// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "coupling/fluid_domain_setup.hpp"
#include "coupling/mechanism_setup.hpp"

#include <vector>

namespace grouser::scene {
struct Scene;
} // namespace grouser::scene

namespace grouser::setup {

/// Markers of a shape, in its frame: in layers from half a spacing below its surface down to `depth` [m]. Layers of a
/// box, cylinder or sphere are parallel to its surface; those of other shapes are points of a lattice. `flat`: only the
/// layer through the middle along this axis of the shape (0, 1, 2), or -1.
std::vector<base::Vec3d> shapeMarkers(const coupling::BodyShape& shape, double spacing, double depth, int flat = -1);

/// Bodies with shapes. Throws InputError where a shape is thinner than the spacing, or in two dimensions no box or
/// cylinder across the plane.
std::vector<coupling::BodyInFluid> bodiesInFluid(const scene::Scene& scene, const coupling::MechanismSetup& mechanism,
                                                 const fluid::FluidModel& model);

/// Distance from the nearest of the bodies as they stand at the start [m]; infinite without.
double distanceFromBodies(const coupling::MechanismSetup& mechanism, const base::Vec3d& p);

} // namespace grouser::setup
