// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "coupling/mechanism_setup.hpp"
#include "coupling/settled_ground.hpp"
#include "terrain/grain_state.hpp"

#include <vector>

/// What a scene puts on its bed once that has settled alone: surfaces, meshes, grains.
namespace grouser::coupling {

/// How far each thing is lifted from where the scene gives it, so that it stands above_bed over the highest grain under
/// it [m]; 0 where the scene gives its height. Surfaces in their order, then sections of grains. What lies under a
/// thing is what the rectangle along x and y covers that holds it: so it touches nothing. Throws InputError where no
/// grain is under it. All ranks call it, and all get the same.
std::vector<double> liftsOnto(const terrain::Grains& bed, const GroundSetup& scene, const base::Comm& comm);
/// Lifts them. Throws InputError when the lifts are of another scene.
void lift(GroundSetup& scene, const std::vector<double>& lifts);

/// How far to lift a mechanism, so that each of its shapes is at least aboveBed over the highest grain under it [m].
/// Throws InputError where no grain is under any of them. All ranks call it, and all get the same.
double liftOnto(const terrain::Grains& bed, const GroundSetup& scene, const MechanismSetup& mechanism,
                const base::Comm& comm);

/// Throws InputError where a surface or mesh would stand in a grain of the settled bed, or a placed grain in a mesh or
/// wall: with the numbers, and what helps. All ranks call it.
void requireRoom(const terrain::Grains& bed, const GroundSetup& scene, const base::Comm& comm);

/// Throws InputError where a body of a mechanism stands in a grain at the start. `model` as in addBodyParts(). All
/// ranks call it.
void requireRoom(const terrain::Grains& grains, const MechanismSetup& mechanism, const multibody::Model& model,
                 const base::Comm& comm);

/// Gives the grains of a settled bed the walls, surfaces, materials and radii of the whole scene: `ground` holds the
/// bed alone before, and the same grains as the scene knows them after, where they lie and with the springs of their
/// contacts. Where larger grains are put on the bed, its places are rounded to their units.
void takeIntoScene(LaidGround& ground, const GroundSetup& scene, const base::Exec& exec, const base::Comm& comm);
/// The same of a saved state, whose rows this rank has: grains of the scene at those places.
LaidGround groundAt(const GroundSetup& scene, const terrain::GrainState& rows, const base::Exec& exec,
                    const base::Comm& comm);

/// Adds the grains that are put on the bed, with the ids that follow. Throws InputError where one would lie in a grain
/// or a surface deeper than run.max_overlap.
void putGrains(LaidGround& ground, const GroundSetup& scene);

} // namespace grouser::coupling
