// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "coupling/mechanism_setup.hpp"
#include "coupling/settled_ground.hpp"
#include "terrain/grain_state.hpp"

#include <vector>

/// Surfaces, meshes and grains placed on a settled bed.
namespace grouser::coupling {

/// Lift of each object from its position in the scene to above_bed above the highest grain below it [m]; 0 if the scene
/// specifies its height. Order: surfaces, then sections of grains. Grains below an object are those within its bounding
/// rectangle in x and y, so it touches no grain. Throws InputError if no grain is below it. Collective, with the same
/// result on all ranks.
std::vector<double> liftsOnto(const terrain::Grains& bed, const GroundSetup& scene, const base::Comm& comm);
/// Applies the lifts. Throws InputError if they belong to another scene.
void lift(GroundSetup& scene, const std::vector<double>& lifts);

/// Lift of a mechanism so that each of its shapes is at least aboveBed above the highest grain below it [m]. Throws
/// InputError if no grain is below any shape. Collective, with the same result on all ranks.
double liftOnto(const terrain::Grains& bed, const GroundSetup& scene, const MechanismSetup& mechanism,
                const base::Comm& comm);

/// Throws InputError if a surface or mesh overlaps a grain of the settled bed, or if a placed grain overlaps a mesh or
/// wall. Collective.
void requireRoom(const terrain::Grains& bed, const GroundSetup& scene, const base::Comm& comm);

/// Throws InputError if a body of a mechanism initially overlaps a grain. `model` as in addBodyParts(). Collective.
/// Uses the initial poses.
void requireRoom(const terrain::Grains& grains, const MechanismSetup& mechanism, const multibody::Model& model,
                 const base::Comm& comm);

/// Extends a settled bed to the walls, surfaces, materials and radii of the whole scene. `ground`: on entry the bed
/// alone; on return the same grains in the scene, with their positions and contact springs. If larger grains are placed
/// on the bed, positions are rounded to the coarser units of these grains.
void extendBedToScene(LaidGround& ground, const GroundSetup& scene, const base::Exec& exec, const base::Comm& comm);
/// Same for a saved state, given this rank's rows: creates the grains of the scene at their saved positions.
LaidGround groundAt(const GroundSetup& scene, const terrain::GrainState& rows, const base::Exec& exec,
                    const base::Comm& comm);

/// Adds the grains placed on the bed; their ids follow those of the bed. Throws InputError if one of them overlaps a
/// grain or a surface by more than run.max_overlap.
void putGrains(LaidGround& ground, const GroundSetup& scene);

} // namespace grouser::coupling
