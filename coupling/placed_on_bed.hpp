// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "coupling/mechanism_setup.hpp"
#include "coupling/settled_ground.hpp"
#include "terrain/grain_state.hpp"

#include <vector>

/// Surfaces, meshes and grains placed on a settled bed.
namespace grouser::coupling {

/// Lift of each object from its position in the scene to above_bed over the highest grain under it [m]; 0 if the scene
/// gives its height. Surfaces in their order, then sections of grains. Grains under an object are those within its
/// bounding rectangle along x and y, so it touches none. Throws InputError if there are none. Collective, with the same
/// result on all ranks.
std::vector<double> liftsOnto(const terrain::Grains& bed, const GroundSetup& scene, const base::Comm& comm);
/// Applies the lifts. Throws InputError if they belong to another scene.
void lift(GroundSetup& scene, const std::vector<double>& lifts);

/// Lift of a mechanism so that each of its shapes is at least aboveBed over the highest grain under it [m]. Throws
/// InputError if no grain is under any of them. Collective, with the same result on all ranks.
double liftOnto(const terrain::Grains& bed, const GroundSetup& scene, const MechanismSetup& mechanism,
                const base::Comm& comm);

/// Throws InputError if a surface or mesh overlaps a grain of the settled bed, or a placed grain a mesh or wall. All
/// ranks call it.
void requireRoom(const terrain::Grains& bed, const GroundSetup& scene, const base::Comm& comm);

/// Throws InputError if a body of a mechanism overlaps a grain at the start. `model` as in addBodyParts(). All ranks
/// call it.
void requireRoom(const terrain::Grains& grains, const MechanismSetup& mechanism, const multibody::Model& model,
                 const base::Comm& comm);

/// Extends a settled bed to the walls, surfaces, materials and radii of the whole scene. `ground`: before, the bed
/// alone; after, the same grains in the scene, with their positions and contact springs. If larger grains are placed on
/// the bed, positions are rounded to their units.
void extendBedToScene(LaidGround& ground, const GroundSetup& scene, const base::Exec& exec, const base::Comm& comm);
/// The same for a saved state, whose rows this rank has: grains of the scene at those positions.
LaidGround groundAt(const GroundSetup& scene, const terrain::GrainState& rows, const base::Exec& exec,
                    const base::Comm& comm);

/// Adds the grains placed on the bed, with the following ids. Throws InputError if one overlaps a grain or a surface by
/// more than run.max_overlap.
void putGrains(LaidGround& ground, const GroundSetup& scene);

} // namespace grouser::coupling
