// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "contact/grain_part_contacts.hpp"
#include "coupling/obstacles.hpp"
#include "coupling/sources.hpp"
#include "coupling/surface_setup.hpp"
#include "terrain/bed.hpp"
#include "terrain/grains.hpp"
#include "terrain/height_field.hpp"

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace grouser::coupling {

class Ground;
struct GroundSetup;

/// Criteria for a settled bed.
struct SettleSetup {
  double timeLimit{};               ///< [s]; 0: the bed is not settled
  double kineticEnergy{};           ///< [-] mean kinetic energy a grain over m g radius
  std::optional<double> forceRatio; ///< [-] mean resultant force on a grain over its weight; empty: not asked
  bool spins = true;                ///< kinetic energy of spin counts too: not if grains on one contact may spin about
                                    ///< its normal for ever, or are prepared with almost no friction
};

/// A bed of copies of one settled tile.
struct TileSetup {
  std::shared_ptr<const GroundSetup> ground;   ///< of the tile alone: level, with periodic boundaries
  std::array<double, 2> size{}, terrainSize{}; ///< [m] along x, y
  std::array<std::int64_t, 2> copies{};
  std::array<bool, 2> periodic{}; ///< of the whole terrain
  terrain::Rectangle walls;       ///< of the whole bed
  double floorHeight{};           ///< of the whole bed [m]
  std::string inTheWay;           ///< message if a surface of the scene reaches into the settled tile
};

/// Preparation of a bed of given porosity: by another friction while it settles.
struct PreparationSetup {
  double porosity{};                         ///< wanted [-]
  std::shared_ptr<const GroundSetup> sample; ///< a small bed of the same grains, for trials of friction
  std::string place;                         ///< "scene.toml:14: terrain.porosity = 0.3 [-]", for messages
  std::string origin; ///< all data that determine the bits of the friction, as text; empty: unknown
};

/// A bed of grains, laid under a height-map.
struct BedSetup {
  terrain::BedOptions options;
  terrain::Rectangle walls; ///< inner faces [m]
  double fall{};            ///< largest fall of its loose grains [m]
  double restEnergy{};      ///< m g radius of a mean grain [J], the scale of kinetic energies
  int material{};           ///< of its grains, among those of the model
  SettleSetup settle;
  std::optional<PreparationSetup> preparation;
  std::optional<double> densest; ///< solid fraction [-] above which the bed has crystallised; empty: no check
  bool cache{};                  ///< store the settled bed for later runs, and reuse a stored one
  std::string origin;            ///< all data that determine the bits of the settled bed, as text
  std::optional<TileSetup> tile;
  /// The ground in which it settles if things are placed on it afterwards: without them. Null: it settles in the
  /// complete scene.
  std::shared_ptr<const GroundSetup> alone;
};

/// Grains placed on a settled bed together.
struct PlacedGrains {
  std::string place; ///< of their section, in messages: "scene.toml:14: grain.0"
  std::vector<terrain::GrainSpec> grains;
  std::optional<double> aboveBed; ///< height of their lowest point over the highest grain under them [m]
};

/// All grains of a scene.
struct GrainsSetup {
  terrain::GrainModel model;
  terrain::Boundaries boundaries;
  std::vector<std::string> wallNames;    ///< of the boundaries' walls, in messages: "plane 0"
  std::vector<terrain::GrainSpec> start; ///< grains listed in the scene; empty for a bed
  std::optional<BedSetup> bed;
  std::vector<PlacedGrains> onBed; ///< with the ids that follow the bed's
  Sources sources;
  terrain::PartitionOptions partition;  ///< without the ranks
  contact::GrainPartMaterials partLaws; ///< of each material against the parts of the vehicle or the meshes
  bool manyKinds{};                     ///< grains differ in radius or material
  std::vector<std::string> materials;   ///< of the grains, by name
  std::optional<double> impactSpeed;    ///< for the choice of the time step with hertz contacts [m/s]

  /// Whether a resumed run makes its grains from the saved ones: if things were placed on a settled bed, or a tile was
  /// copied, it need not settle again.
  bool isMadeOfState() const { return bed && (bed->alone || bed->tile); }
};

/// The ground under a scene's vehicle or grains.
struct GroundSetup {
  std::optional<terrain::Rectangle> area;      ///< of the terrain
  std::optional<terrain::HeightField> surface; ///< of the height-map
  std::optional<terrain::HeightField> rigid;   ///< the ground itself, or the floor below the grains
  std::vector<SurfaceSetup> surfaces;          ///< for contact with grains: planes that move or have a name, boxes, ...
  std::vector<Obstacle> obstacles;             ///< for contact with parts of the vehicle
  std::optional<GrainsSetup> grains;
  /// Creates a ground that is neither granular nor rigid; empty: see makeGround(). Its arguments must outlive it.
  std::function<std::unique_ptr<Ground>(const GroundSetup&, const base::Exec&)> otherKind;
};

} // namespace grouser::coupling
