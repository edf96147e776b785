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

/// The terrain as it was laid: rigid ground, or grains on a rigid floor, or grains alone. How it acts on a vehicle says
/// Ground. A const LaidGround keeps what it has, but its grains can be stepped.
struct LaidGround {
  std::optional<terrain::HeightField> surface; ///< as the height-map says; empty without [terrain]
  std::optional<terrain::HeightField> rigid;   ///< the ground itself, or the floor below a bed; empty without [terrain]
  std::unique_ptr<terrain::Grains> grains;     ///< null without grains
  std::optional<terrain::Rectangle> walls;     ///< around a bed; empty without one
  /// Of a settled bed, before the vehicle touched it; null without a bed, and before keepSurface().
  std::shared_ptr<const terrain::BedSurface> undisturbed;
  std::optional<terrain::BedStructure> structure; ///< of that bed; empty where it was not settled
};

/// Names of the surfaces that are no meshes, in their order.
std::vector<std::string> namesOfShapes(const GroundSetup& setup);

/// Lays the grains and places the walls; nothing moves yet. Where `start` is given these are its grains, else they are
/// laid as the setup says, around what stands there. On several ranks each takes the grains of its subdomain.
LaidGround layGround(const GroundSetup& setup, const base::Exec& exec, const base::Comm& comm = {},
                     const std::vector<terrain::GrainSpec>* start = nullptr);
/// Whether a surface of the scene is where a ball would be; a bed is laid around those.
bool isTaken(const GroundSetup& setup, const base::Vec3d& centre, double radius);

/// Of a ground with a bed: takes its surface as it lies now for the undisturbed one, or `heights` of one taken earlier,
/// with the radius of its largest grains [m].
void keepSurface(LaidGround& ground, const base::Exec& exec);
void keepSurface(LaidGround& ground, const std::vector<double>& heights, double radius);

/// Heights of the bed as it lies now, at the nodes of a surface that was kept [m]. All ranks call it.
std::vector<double> surfaceNow(const LaidGround& ground, const base::Exec& exec);

/// The limits of its bed, whose surface as it lies is given. Refers to both.
terrain::BedExtent extentOf(const LaidGround& ground, const terrain::BedSurface& surface);
/// Measures the bed, whose surface has been kept.
terrain::BedStructure structureOf(const LaidGround& ground);
/// Throws SimulationError where the bed has crystallised.
void checkStructure(const BedSetup& bed, const terrain::BedStructure& structure);

/// Height of the undisturbed bed, or of the rigid ground; null where there is neither.
std::function<double(double x, double y)> surfaceHeight(const LaidGround& ground);

} // namespace grouser::coupling
