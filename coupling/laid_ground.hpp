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

/// Initial terrain: rigid ground, or grains on a rigid floor, or grains alone. The class Ground computes its contacts
/// with a vehicle. The grains of a const LaidGround can be stepped.
struct LaidGround {
  std::optional<terrain::HeightField> surface; ///< surface of the height-map; empty without [terrain]
  std::optional<terrain::HeightField> rigid;   ///< rigid ground, or the floor of a bed; empty without [terrain]
  std::unique_ptr<terrain::Grains> grains;     ///< null without grains
  std::optional<terrain::Rectangle> walls;     ///< walls around a bed; empty without a bed
  /// Surface of a settled bed before vehicle contact; null without a bed, and before keepSurface().
  std::shared_ptr<const terrain::BedSurface> undisturbed;
  std::optional<terrain::BedStructure> structure; ///< structure of that bed; empty if it was not settled
};

/// Names of the surfaces other than meshes, in order.
std::vector<std::string> namesOfShapes(const GroundSetup& setup);

/// Creates grains and walls; nothing moves yet. The grains are those of `start`, if given; otherwise they are placed
/// according to the setup, around existing surfaces. Each rank has the grains of its subdomain.
LaidGround layGround(const GroundSetup& setup, const base::Exec& exec, const base::Comm& comm = {},
                     const std::vector<terrain::GrainSpec>* start = nullptr);
/// True if a surface of the scene overlaps a ball; a bed is placed around such surfaces.
bool isTaken(const GroundSetup& setup, const base::Vec3d& centre, double radius);

/// Stores the current surface of a bed as the undisturbed one, or `heights` of an earlier one, with the radius of its
/// largest grains [m].
void keepSurface(LaidGround& ground, const base::Exec& exec);
void keepSurface(LaidGround& ground, const std::vector<double>& heights, double radius);

/// Current heights of the bed at the nodes of the stored surface [m]. Collective.
std::vector<double> surfaceNow(const LaidGround& ground, const base::Exec& exec);

/// Extent of the bed with the current surface. Refers to both arguments.
terrain::BedExtent extentOf(const LaidGround& ground, const terrain::BedSurface& surface);
/// Measures the bed; call after keepSurface().
terrain::BedStructure structureOf(const LaidGround& ground);
/// Throws SimulationError if the bed has crystallised.
void checkStructure(const BedSetup& bed, const terrain::BedStructure& structure);

/// Height of the undisturbed bed, or of the rigid ground; null without either.
std::function<double(double x, double y)> surfaceHeight(const LaidGround& ground);

} // namespace grouser::coupling
