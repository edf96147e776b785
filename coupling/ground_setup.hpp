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

/// When a bed counts as at rest.
struct SettleSetup {
  double timeLimit{};               ///< [s]; 0: the bed is not settled
  double kineticEnergy{};           ///< [-] mean kinetic energy a grain over m g radius
  std::optional<double> forceRatio; ///< [-] mean resultant force on a grain over its weight; empty: not asked
  bool spins = true;                ///< kinetic energy of spin counts, too: not where grains may lie on one contact
                                    ///< and spin about its normal for ever, or are prepared with next to no friction
};

/// A bed that is one settled tile, copied.
struct TileSetup {
  std::shared_ptr<const GroundSetup> ground;   ///< of the tile alone: level, with periodic boundaries
  std::array<double, 2> size{}, terrainSize{}; ///< [m] along x, y
  std::array<std::int64_t, 2> copies{};
  std::array<bool, 2> periodic{}; ///< of the whole terrain
  terrain::Rectangle walls;       ///< of the whole bed
  double floorHeight{};           ///< of the whole bed [m]
  std::string inTheWay;           ///< the message where a surface of the scene reaches into the settled tile
};

/// How a bed comes to a porosity: by another friction while it settles.
struct PreparationSetup {
  double porosity{};                         ///< wanted [-]
  std::shared_ptr<const GroundSetup> sample; ///< a small bed of the same grains, to try frictions on
  std::string place;                         ///< "scene.toml:14: terrain.porosity = 0.3 [-]", for messages
  std::string origin; ///< all that makes the bits of the friction found, as text; empty: not known
};

/// A bed of grains, laid under a height-map.
struct BedSetup {
  terrain::BedOptions options;
  terrain::Rectangle walls; ///< inner faces [m]
  double fall{};            ///< that its loose grains have to fall at most [m]
  double restEnergy{};      ///< m g radius of a mean grain [J], that kinetic energies are compared with
  int material{};           ///< of its grains, among those of the model
  SettleSetup settle;
  std::optional<PreparationSetup> preparation;
  std::optional<double> densest; ///< solid fraction [-] above which the bed has crystallised; empty: not asked
  bool cache{};                  ///< keep the settled bed for later runs, and take it from one
  std::string origin;            ///< all that makes the bits of the settled bed, as text
  std::optional<TileSetup> tile;
  /// The ground in which it settles, where more is put on it afterwards: without that, as if the scene ended with the
  /// bed. Null: it settles in the scene as it is.
  std::shared_ptr<const GroundSetup> alone;
};

/// Grains that are put on a settled bed together.
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
  std::vector<terrain::GrainSpec> start; ///< where the scene sets them one by one; empty for a bed
  std::optional<BedSetup> bed;
  std::vector<PlacedGrains> onBed; ///< with the ids that follow the bed's
  Sources sources;
  terrain::PartitionOptions partition;  ///< but for the ranks
  contact::GrainPartMaterials partLaws; ///< of each material against the parts of the vehicle or the meshes
  bool manyKinds{};                     ///< grains differ in radius or material
  std::vector<std::string> materials;   ///< of the grains, by name
  std::optional<double> impactSpeed;    ///< for which the step was chosen, where there are hertz contacts [m/s]

  /// Whether a run that goes on makes its grains of the saved ones: where something was put on a settled bed, or where
  /// a tile was copied, it need not settle again.
  bool isMadeOfState() const { return bed && (bed->alone || bed->tile); }
};

/// What a scene's vehicle or grains stand on.
struct GroundSetup {
  std::optional<terrain::Rectangle> area;      ///< of the terrain
  std::optional<terrain::HeightField> surface; ///< as the height-map says
  std::optional<terrain::HeightField> rigid;   ///< what is rigid: the ground itself, or the floor below the grains
  std::vector<SurfaceSetup> surfaces;          ///< that grains meet: planes that move or have a name, boxes, ...
  std::vector<Obstacle> obstacles;             ///< that parts of the vehicle meet
  std::optional<GrainsSetup> grains;
  /// Makes a kind of ground that is neither of grains nor rigid; empty: see makeGround(). What it is given outlives it.
  std::function<std::unique_ptr<Ground>(const GroundSetup&, const base::Exec&)> otherKind;
};

} // namespace grouser::coupling
