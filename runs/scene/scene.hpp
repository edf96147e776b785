// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/vec.hpp"
#include "contact/mixing.hpp"
#include "runs/scene/choices.hpp"
#include "runs/scene/fluid_structs.hpp"
#include "runs/scene/mechanism_structs.hpp"
#include "runs/scene/surface_structs.hpp"
#include "vehicle/gear_shapes.hpp"
#include "vehicle/spec_source.hpp"

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace grouser::base {
class Document;
} // namespace grouser::base

/// A scene file as plain structs, one per section. Sections absent from the file are absent here. The tables of
/// *_section(s).cpp define units, ranges and help of all keys; `grouser fields` prints them.
namespace grouser::scene {

struct Soil; // soil.hpp

/// Default and minimum number of steps per shortest contact; `grouser study impact` measures their effect.
inline constexpr double kStepsPerContact = 20, kFewestStepsPerContact = 6;

/// [run]
struct RunSettings {
  double duration = 0;             ///< [s] simulated time after the bed has settled
  std::optional<double> timeStep;  ///< [s]; empty: chosen by setup::chooseTimeStep()
  std::optional<double> tolerance; ///< [m/s, rad/s] error tolerance of a mechanism's steps; empty: fixed steps
  double stepsPerContact = kStepsPerContact; ///< [-] steps per shortest contact, for the automatic step
  double stepsPerPeriod =
      20; ///< [-] minimum number of steps per period, turn or gap of a prescribed quantity, and per turn of a body
  base::Vec3d gravity{0, 0, -9.81};
  double outputInterval = 0.02;
  double frameInterval = 0.1;
  double checkpointInterval = 1.0; ///< [s]; 0: only at the end
  std::int64_t seed = 1;
  support::DeviceChoice device = support::DeviceChoice::automatic;
  /// Precision of the grains' forces.
  terrain::Precision precision = terrain::Precision::single;
  double impactSpeed = 1.0; ///< [m/s] impact speed for the time step of hertz materials and complementarity
  ContactMethod contact = ContactMethod::penalty; ///< method for contacts of grains
  std::optional<double> residual;                 ///< [m/s] tolerance of complementarity contacts; empty: 0.01 g dt
  int threads = 0;                                ///< 0: all
  /// Integrator of mechanisms; the next two members apply to rattle only.
  multibody::Integrator integrator = multibody::Integrator::kRattle;
  int integratorOrder = 2; ///< 2, 4, 6, 8
  multibody::Springs springs = multibody::Springs::kImplicit;
  std::optional<double> constraintTolerance; ///< [m], [rad] joint closure tolerance; empty: the solver's default
  double skin = 0.3;                         ///< [-] skin / grain radius
  std::optional<double> maxOverlap; ///< [-] overlap / grain radius that stops the run; empty: the default of GrainModel
  std::array<bool, 2> periodic{false, false};            ///< x, y
  std::optional<std::array<double, 2>> domainX, domainY; ///< [m] periodic boundaries; empty: the terrain's borders
  /// Maximum overlap of a grain when it enters the scene, and under its own weight [grain radius].
  double entryOverlap() const { return maxOverlap.value_or(terrain::GrainModel{}.maxEntryOverlap); }
  bool operator==(const RunSettings&) const = default;
};

/// [complementarity]
struct Complementarity {
  contact::ImpulseFriction friction = contact::ImpulseFriction::coulomb;
  contact::Compliance compliance = contact::Compliance::law;
  std::int64_t iterations = 200;
  double recovery = 0.1; ///< [m/s]
  bool strict = false;
  bool operator==(const Complementarity&) const = default;
};

/// [material.NAME]. After loading, all values that its law uses are set.
struct Material : contact::MaterialProperties {
  std::string name;
  std::string soil;                  ///< absolute path of the soil file after loading; empty: no soil
  std::string soilHash;              ///< hash of the soil file
  std::optional<double> grainRadius; ///< [m] grain radius that a soil is scaled to; set by loading
  bool operator==(const Material&) const = default;
};

/// [contact."first|second"]: parameters of a pair that replace those of the mixing rule.
struct ContactPair : contact::PairProperties {
  std::string first, second;
  bool operator==(const ContactPair&) const = default;
};

/// [[grain]]
struct Grain {
  base::Vec3d position, velocity, spin;
  double radius = 0;
  std::string material;
  bool fixed = false;
  std::optional<double> aboveBed{}; ///< [m] gap between its lowest point and the settled bed; replaces position z
  bool operator==(const Grain&) const = default;
};

/// [[grains]]: many grains at once.
struct GrainFill {
  FillForm form = FillForm::lattice;
  std::optional<base::Vec3d> low, high; ///< [m] corners of the box that contains the grains
  std::optional<double> radius;         ///< [m]
  std::optional<double> radiusTo;       ///< [m] maximum radius: radii are uniform from `radius` to this
  double spacing = 2.1;                 ///< [-] lattice spacing / largest radius
  double jitter = 0;                    ///< [-] random displacement / free gap of the lattice
  std::optional<std::int64_t> number;   ///< number of grains in a random fill
  std::optional<std::string> file;      ///< absolute path after loading
  base::Vec3d velocity, spin;
  std::string material;
  std::optional<double> aboveBed; ///< [m] gap between the lowest point and the settled bed
  std::vector<Grain> fromFile;    ///< grains of the file, read when the scene is loaded
  double smallestRadius() const;
  double largestRadius() const;
  bool operator==(const GrainFill&) const = default;
};
/// Grains of a text file with lines "x, y, z, r" [m], "x, y, z, r, vx, vy, vz" [m/s], or also "wx, wy, wz" [rad/s]. The
/// section provides values for missing columns. Throws InputError with the number of an invalid line.
std::vector<Grain> readGrainFile(const std::string& file, const GrainFill& fill);

/// [[source]]: grains that enter during the run.
struct Source {
  base::Vec3d low, high;      ///< [m] corners of the box of the initial centres
  base::Vec3d velocity, spin; ///< [m/s], [rad/s]
  double radius = 0;          ///< [m]
  std::string material;
  std::int64_t number = 1; ///< number of grains that enter together
  double every = 0;        ///< [s] time between entries
  double start = 0;        ///< [s] time of the first entry
  std::int64_t total = 1;  ///< total number of grains
  bool operator==(const Source&) const = default;
};

/// [terrain]: x in [0, size x], y in [-size y / 2, size y / 2].
struct Terrain {
  std::string heightmap;               ///< absolute path after loading
  std::array<double, 2> size{};        ///< [m] x, y
  std::array<double, 2> heightRange{}; ///< [m] heights of black and white
  terrain::Interpolation interpolation = terrain::Interpolation::monotone;
  TerrainKind kind = TerrainKind::granular;
  std::string material;
  std::string groundMaterial; ///< material of floor and walls; default: the bed's
  Arrangement arrangement = Arrangement::random;
  std::optional<double> grainRadius; ///< [m] set by loading for a granular bed
  std::optional<double> depth;       ///< [m]
  // Keys of a random arrangement.
  std::optional<terrain::RadiusLaw> radiusDistribution;        ///< set by loading
  std::optional<double> radiusSpread;                          ///< [-] set by loading if the distribution has a spread
  std::vector<double> sieveSize, sievePassing;                 ///< [m], [-]
  std::optional<double> porosity;                              ///< [-] requested porosity; empty: as poured
  std::optional<double> fineDepth, coarsening, coarsestRadius; ///< [m], [-], [m]; graded beds only
  // Keys of a lattice.
  std::optional<int> layers;
  std::optional<double> spacing, jitter; ///< [-] spacing / grain radius; displacement / free gap
  std::optional<double> packing;         ///< [-] expected solid fraction of the settled bed

  terrain::FloorShape floor = terrain::FloorShape::follow;
  bool floorGrains = true; ///< fixed grains make the floor rough
  bool walls = true;
  double wallFriction = 0;                   ///< [-] friction coefficient of the walls
  std::optional<std::array<double, 2>> tile; ///< [m] x, y; settle a piece of this size, then fill the terrain with it
  double settleTimeLimit = 3.0;
  double settleKineticEnergy = 1e-4;      ///< [-] mean kinetic energy per grain / (m g radius)
  std::optional<double> settleForceRatio; ///< [-] mean resultant force on a grain / grain weight; empty: no limit
  bool cache = true;                      ///< use the cache of settled beds
  bool granular() const { return kind == TerrainKind::granular; }
  bool deformable() const { return kind == TerrainKind::scm; }
  bool lattice() const { return arrangement == Arrangement::lattice; }
  bool operator==(const Terrain&) const = default;

  static constexpr double kSpacing = 2.1, kJitter = 0.9, kPacking = 0.6; ///< default values of a lattice
  static constexpr double kSpread = 0.25;                                ///< default spread of the radii
  static constexpr double kPoured = 0.41;                                ///< expected porosity of a poured bed [-]
};

/// [scm]: constants of a deformable soil. Empty constants come from the soil file.
struct Scm {
  SoilConstantsFrom constants = SoilConstantsFrom::published;
  int constantsDraw = 0; ///< sample of the soil file's constants within their intervals; 0: nominal
  std::optional<double> n, kc, kphi, cohesion, frictionAngle, shearDisplacement; ///< [-], [N/m^(n+1)], ..., [deg], [m]
  double unloadingStiffness = 0, unloadingGrowth = 0;                            ///< [N/m3], [N/m4]
  double elasticRatio = 10;                                                      ///< [-]
  double damping = 3e4;                                                          ///< [Pa s/m]
  std::optional<double> slipSinkage;        ///< [-]; empty: Lyasko's rule for the vehicle
  std::optional<double> maximumSlipSinkage; ///< [m]; empty: the height of the grousers
  double displacedShare = 0.5;              ///< [-]
  std::optional<double> reposeAngle;        ///< [deg]; empty: published, or phi
  std::optional<double> bulkDensity;        ///< [kg/m3]; empty: published, or of the soil's grains
  std::optional<double> nodeSpacing;        ///< [m]; empty: a quarter of the length of a shoe
  double deepest = 0.5;                     ///< [m] maximum sinkage
  bool operator==(const Scm&) const = default;
};

/// [vehicle]
struct Vehicle {
  std::string spec;                              ///< absolute path after loading
  std::optional<std::array<double, 2>> position; ///< [m] x, y of the midpoint of the sprockets; empty: on the terrain
  double heading = 0;                            ///< [deg] angle from the x axis, counter-clockwise
  double clearance = 0.002;                      ///< [m] gap between the lowest grouser and the ground at the start
  static constexpr double kSphereRadius = 0.02;  ///< [m] default
  std::optional<double> sphereRadius;            ///< [m] sphere radius of the parts; empty: kSphereRadius or finer
  double sphereRefinement = 1;                   ///< [-] divisor of all sphere radii and their limits
  std::string material; ///< contact material of the parts; empty: the grains' material with the friction of the spec
  double adhesion = 0;  ///< [-] adhesive force of parts without a material / that of a wall of the grains' material
  ChassisMount chassis = ChassisMount::free;
  Tracks tracks = Tracks::both;
  SoilContact soilContact = SoilContact::all; ///< parts in contact with grains
  std::vector<vehicle::SpecKey> specKeys;     ///< [spec.SECTION]: keys that replace values of the vehicle file
  std::optional<vehicle::GearContactModel> gearContactModel; ///< empty: shapes, if the vehicle file has them
  std::optional<double> hullSphereRadius;                    ///< [m]; empty: 0.02 or sphereRadius, the larger one
  std::optional<bool> hullTouches; ///< whether the hull has contacts; empty: see setup::hullTouches()
  bool operator==(const Vehicle&) const = default;

  vehicle::SpecSource source() const { return {spec, specKeys}; }
};

/// Sprocket speeds over time, linear between the points, constant outside.
struct SpeedTable {
  std::vector<double> time, left, right; ///< [s], [rad/s], [rad/s]
  bool operator==(const SpeedTable&) const = default;
};

/// [driver.torques]: sprocket torques over time, interpolated as in SpeedTable.
struct TorqueTable {
  std::vector<double> time, left, right; ///< [s], [N m], [N m]
  bool operator==(const TorqueTable&) const = default;
};

/// [driver.course]: hull speed, and a circle or a path of points, in closed loop.
struct Course {
  double speed{};                            ///< [m/s]
  double acceleration = 1;                   ///< [m/s2]
  std::optional<double> radius;              ///< [m] circle radius, positive to the left
  std::vector<double> x, y;                  ///< [m] points of a path
  std::optional<double> lookAhead;           ///< [m]; empty: distance from first to last road wheel
  double speedGain = 0.5, speedIntegral = 1; ///< [-], [1/s]
  double turnGain = 0.5, turnIntegral = 2;   ///< [-], [1/s]
  double maxSprocketSpeed = 100;             ///< [rad/s]
  bool operator==(const Course&) const = default;
};

/// [driver]
struct Driver {
  vehicle::SprocketDrive drive = vehicle::SprocketDrive::speed;
  std::optional<double> sprocketSpeed, left, right;      ///< [rad/s]
  std::optional<SpeedTable> table;                       ///< [driver.table]; its time starts with the drive
  std::optional<double> torque, leftTorque, rightTorque; ///< [N m]
  std::optional<TorqueTable> torqueTable;                ///< [driver.torques]
  std::optional<Course> course;                          ///< [driver.course]
  double tensionRamp = 0.15;
  double weightRamp = 0.3;
  std::optional<double> driveStart; ///< [s]; empty: once the vehicle is at rest
  std::optional<double> driveRamp;  ///< [s]; empty: 0.3 s for a constant speed, 0 for a table
  double restSpeed = 0.01;          ///< [m/s] speed of the hull's centre of mass along gravity
  double restLoad = 0.05;           ///< [-] deviation of ground force / weight from 1
  double restTimeLimit = 5;         ///< [s] time limit after the weight ramp
  bool operator==(const Driver&) const = default;

  /// Earliest start of the drive [s]: as given, or at the end of the tension and weight ramps.
  double driveBegins() const { return driveStart.value_or(tensionRamp + weightRamp); }
  double rampOfDrive() const { return table || torqueTable ? driveRamp.value_or(0) : rampOfChange(); } ///< [s]
  double rampOfChange() const { return driveRamp.value_or(0.3); } ///< [s] ramp from the former speeds in a branch
  /// The speeds as one table, whether given as constants or as a table.
  SpeedTable speeds() const;
  TorqueTable torques() const;
  /// Returns true if the driver does not prescribe the sprocket speeds.
  bool isFree() const { return course || drive == vehicle::SprocketDrive::torque; }
};

/// [hitch]: horizontal load on the hull from the start of the drive. Keys of other kinds are empty.
struct Hitch {
  vehicle::HitchKind kind = vehicle::HitchKind::force;
  std::optional<base::Vec3d> position; ///< [m] point in the vehicle frame; empty: middle of the track's rear axle
  double start = 0;                    ///< [s] time after the start of the drive
  double ramp = 0.3;                   ///< [s]
  std::optional<double> force, rate;   ///< [N], [N/s]
  std::optional<double> mass, friction, length; ///< [kg], [-], [m]; sled with rope
  std::optional<double> slip;                   ///< [-] slip imposed by a carriage
  std::optional<double> stiffness;              ///< [N/m] rope or carriage stiffness; empty: from the masses
  double dampingRatio = 0.7;                    ///< [-] damping ratio of rope or carriage
  bool operator==(const Hitch&) const = default;
  static constexpr double kLength = 3; ///< [m], default
};

/// [stop]: conditions that end a run of a vehicle before run.duration.
struct Stop {
  std::optional<double> distance; ///< [m] distance from the initial position
  std::optional<double> edge;     ///< [m] distance between a shoe and the edge of the terrain
  std::optional<double> immobile; ///< [s] duration without motion while driven
  bool operator==(const Stop&) const = default;
};

/// [[output.plot]]: a panel of figure.png, drawn as scale * (value - start) + offset, where start is the first value
/// with from_start, else 0.
struct PlotSection {
  std::string x = "time";
  std::vector<std::string> y, labels;
  bool sum = false; ///< one curve, the sum of y
  std::string xLabel = "time [s]", yLabel, title;
  double xScale = 1, xOffset = 0, yScale = 1, yOffset = 0;
  bool xFromStart = false, yFromStart = false;
  std::optional<std::array<double, 2>> xRange, yRange;
  std::vector<double> levels;           ///< heights of horizontal lines, in units of the axis
  std::vector<std::string> levelLabels; ///< one per level
  bool operator==(const PlotSection&) const = default;
};

/// [output]
struct Output {
  std::string folder;              ///< empty: out/NAME of the scene file
  std::vector<std::string> record; ///< bodies, joints, springs and drives of a mechanism in the rows; empty: all
  bool frames = true;
  bool contactForces = true;                     ///< contact force on each grain, in the frames
  bool shoeForces = false, gearContacts = false; ///< shoe forces, grain-part contacts, in the rows
  bool finalSurface = true;                      ///< bed surface at the end
  std::optional<bool> grainsCsv;                 ///< every grain in every row as text; empty: in small scenes
  bool picture = true;
  bool plots = true;
  int pictureWidth = 1600;
  std::optional<double> fieldsCell;                 ///< [m] cell edge of the soil fields; empty: no fields
  std::optional<base::Vec3d> fieldsLow, fieldsHigh; ///< [m] corners of the field box; empty: around the grains
  std::vector<PlotSection> panels;                  ///< panels of figure.png
  bool operator==(const Output&) const = default;
};

/// [parallel]: division of grains among ranks. It changes no bit of the results.
struct Parallel {
  std::optional<base::Vec3d> subdomains;   ///< number along x, y, z; 0: free; empty: automatic
  std::vector<double> cutsX, cutsY, cutsZ; ///< [m] initial positions of the cut planes; empty: automatic
  bool rebalance = true;                   ///< move the cuts if one rank has clearly more work than the others
  base::PeerUse peerMemory = base::PeerUse::automatic; ///< whether GPUs of one machine read each other's memory
  bool operator==(const Parallel&) const = default;
};

/// A scene file with overrides applied, checked as far as possible without building it.
struct Scene {
  std::filesystem::path file;
  std::vector<std::string> overrides;
  RunSettings run;
  std::vector<Material> materials;
  std::map<std::string, std::shared_ptr<const Soil>> soils; ///< soils by material name
  std::vector<ContactPair> contacts;
  std::vector<Grain> grains;
  std::vector<GrainFill> fills;
  std::vector<Source> sources;
  std::vector<Plane> planes;
  std::vector<BoxSection> boxes;
  std::vector<CylinderSection> cylinders;
  std::vector<MeshSection> meshes;
  std::optional<Terrain> terrain;
  std::optional<Scm> scm;
  std::optional<Complementarity> complementarity;
  std::optional<Fluid> fluid;
  MechanismSections mechanism;
  std::optional<Vehicle> vehicle;
  Driver driver;
  std::optional<Hitch> hitch;
  Stop stop;
  Output output;
  Parallel parallel;
  std::shared_ptr<const base::Document> document; ///< the file itself; null for a generated scene

  /// Throws InputError "file:line: section.key = value message" for errors found after loading, in the form of loading
  /// errors; `key` may be empty. The second form is for an entry of [[list]].
  [[noreturn]] void fail(const std::string& section, const std::string& key, const std::string& message) const;
  [[noreturn]] void fail(const std::string& list, std::size_t number, const std::string& key,
                         const std::string& message) const;
  [[noreturn]] void failMaterial(const std::string& name, const std::string& key, const std::string& message) const;
  /// "scene.toml:14: source.0", for messages of simulation errors that an entry of [[list]] causes.
  std::string placeOf(const std::string& list, std::size_t number) const;

  std::string name() const { return file.stem().string(); }
  /// Returns true on deformable soil.
  bool deformable() const { return terrain && terrain->deformable(); }
  /// The material `name`, which exists after loading.
  const Material& material(const std::string& name) const;
  /// The [contact] section of two materials, in either order; null if there is none.
  const ContactPair* contact(const std::string& a, const std::string& b) const;
};

} // namespace grouser::scene
