// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/exec.hpp"
#include "coupling/ground_setup.hpp"
#include "terrain/bed_structure.hpp"
#include "terrain/bed_surface.hpp"
#include "terrain/grains.hpp"
#include "terrain/height_field.hpp"

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace grouser::coupling {

/// The initial terrain: rigid ground, or grains on a rigid floor, or grains alone. Ground computes its contacts with a
/// vehicle. The grains of a const LaidGround can be stepped.
struct LaidGround {
  std::optional<terrain::HeightField> surface; ///< of the height-map; empty without [terrain]
  std::optional<terrain::HeightField> rigid;   ///< the ground itself, or the floor below a bed; empty without [terrain]
  std::unique_ptr<terrain::Grains> grains;     ///< null without grains
  std::optional<terrain::Rectangle> walls;     ///< around a bed; empty without one
  /// Surface of a settled bed before the vehicle touches it; null without a bed, and before keepSurface().
  std::shared_ptr<const terrain::BedSurface> undisturbed;
  std::optional<terrain::BedStructure> structure; ///< of that bed; empty if it was not settled
};

/// Names of the surfaces other than meshes, in their order.
std::vector<std::string> namesOfShapes(const GroundSetup& setup);

/// Lays the grains and places the walls; nothing moves yet. The grains are those of `start`, if given, else they are
/// laid according to the setup, around surfaces that stand there. Each rank takes the grains of its subdomain.
LaidGround layGround(const GroundSetup& setup, const base::Exec& exec, const base::Comm& comm = {},
                     const std::vector<terrain::GrainSpec>* start = nullptr);
/// Whether a surface of the scene overlaps a ball; a bed is laid around those.
bool isTaken(const GroundSetup& setup, const base::Vec3d& centre, double radius);

/// Stores the present surface of a bed as the undisturbed one, or `heights` of an earlier one, with the radius of its
/// largest grains [m].
void keepSurface(LaidGround& ground, const base::Exec& exec);
void keepSurface(LaidGround& ground, const std::vector<double>& heights, double radius);

/// Present heights of the bed at the nodes of the stored surface [m]. All ranks call it.
std::vector<double> surfaceNow(const LaidGround& ground, const base::Exec& exec);

/// The limits of its bed with the present surface. Refers to both arguments.
terrain::BedExtent extentOf(const LaidGround& ground, const terrain::BedSurface& surface);
/// Measures the bed after keepSurface().
terrain::BedStructure structureOf(const LaidGround& ground);
/// Throws SimulationError where the bed has crystallised.
void checkStructure(const BedSetup& bed, const terrain::BedStructure& structure);

/// Height of the undisturbed bed, or of the rigid ground; null where there is neither.
std::function<double(double x, double y)> surfaceHeight(const LaidGround& ground);

} // namespace grouser::coupling
