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
  double timeLimit{};               ///< [s]; 0: no settling
  double kineticEnergy{};           ///< [-] mean kinetic energy per grain / (m g radius)
  std::optional<double> forceRatio; ///< [-] mean resultant force on a grain / weight; empty: not checked
  bool spins = true;                ///< includes rotational energy; false if grains with one contact may spin about
                                    ///< its normal forever, or are prepared almost without friction
};

/// Bed composed of copies of one settled tile.
struct TileSetup {
  std::shared_ptr<const GroundSetup> ground;   ///< ground of a single tile: level, with periodic boundaries
  std::array<double, 2> size{}, terrainSize{}; ///< [m] along x, y
  std::array<std::int64_t, 2> copies{};
  std::array<bool, 2> periodic{}; ///< periodicity of the whole terrain
  terrain::Rectangle walls;       ///< walls of the whole bed
  double floorHeight{};           ///< floor of the whole bed [m]
  std::string inTheWay;           ///< message if a surface of the scene reaches into the settled tile
};

/// Preparation of a bed with a given porosity: the grains settle with a different friction.
struct PreparationSetup {
  double porosity{};                         ///< target porosity [-]
  std::shared_ptr<const GroundSetup> sample; ///< small bed of the same grains, for friction trials
  std::string place;                         ///< "scene.toml:14: terrain.porosity = 0.3 [-]", for messages
  std::string origin; ///< all data that determine the friction bit for bit, as text; empty: unknown
};

/// Bed of grains below a height map.
struct BedSetup {
  terrain::BedOptions options;
  terrain::Rectangle walls; ///< inner faces [m]
  double fall{};            ///< maximum drop height of its loose grains [m]
  double restEnergy{};      ///< m g radius of a mean grain [J], reference of kinetic energies
  int material{};           ///< index of its material in the model
  SettleSetup settle;
  std::optional<PreparationSetup> preparation;
  std::optional<double> densest; ///< solid fraction [-] above which the bed counts as crystallised; empty: no check
  bool cache{};                  ///< true: store the settled bed, and reuse stored beds
  std::string origin;            ///< all data that determine the settled bed bit for bit, as text
  std::optional<TileSetup> tile;
  /// Ground for settling without the objects placed on the bed afterwards. Null: the bed settles in the complete scene.
  /// See isMadeOfState().
  std::shared_ptr<const GroundSetup> alone;
};

/// Grains placed together on a settled bed.
struct PlacedGrains {
  std::string place; ///< location of their section, for messages: "scene.toml:14: grain.0"
  std::vector<terrain::GrainSpec> grains;
  std::optional<double> aboveBed; ///< height of their lowest point above the highest grain below them [m]
};

/// All grains of a scene.
struct GrainsSetup {
  terrain::GrainModel model;
  terrain::Boundaries boundaries;
  std::vector<std::string> wallNames;    ///< wall names of the boundaries in messages: "plane 0"
  std::vector<terrain::GrainSpec> start; ///< grains listed in the scene; empty for a bed
  std::optional<BedSetup> bed;
  std::vector<PlacedGrains> onBed; ///< their ids follow the bed's ids
  Sources sources;
  terrain::PartitionOptions partition;  ///< without the communicator
  contact::GrainPartMaterials partLaws; ///< laws of each material against the parts of the vehicle or the meshes
  bool manyKinds{};                     ///< grains differ in radius or material
  std::vector<std::string> materials;   ///< names of the grains' materials
  std::optional<double> impactSpeed;    ///< impact speed for the time step with hertz contacts [m/s]

  /// True if a resumed run creates its grains from the saved ones: with objects placed on a settled bed, or a copied
  /// tile, the bed need not settle again.
  bool isMadeOfState() const { return bed && (bed->alone || bed->tile); }
};

/// Ground of a scene with a vehicle or grains.
struct GroundSetup {
  std::optional<terrain::Rectangle> area;      ///< extent of the terrain
  std::optional<terrain::HeightField> surface; ///< surface of the height-map
  std::optional<terrain::HeightField> rigid;   ///< rigid ground, or the floor of the grains
  std::vector<SurfaceSetup> surfaces;          ///< for contact with grains: moving or named planes, boxes, ...
  std::vector<Obstacle> obstacles;             ///< for contact with parts of the vehicle
  std::optional<GrainsSetup> grains;
  /// Creates a ground that is neither granular nor rigid; empty: see makeGround(). The arguments must outlive it.
  std::function<std::unique_ptr<Ground>(const GroundSetup&, const base::Exec&)> otherKind;
};

} // namespace grouser::coupling
