// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/enum_words.hpp"
#include "base/vec.hpp"
#include "vehicle/gear_shapes.hpp"

#include <optional>
#include <string>
#include <vector>

namespace grouser::vehicle {

using base::Vec3d;

/// Mass and principal moments of inertia about the centre of mass, along the part frame axes.
struct MassSpec {
  double mass{}; ///< [kg]
  Vec3d inertia; ///< (I_xx, I_yy, I_zz) [kg m2]
};

/// Mass data of a part with a surface mesh.
struct SurfaceSpec : MassSpec {
  std::string mesh; ///< mesh file in the spec's mesh folder
};

/// Track shoe, with its centre of mass on the pin line. Shoe frame: origin midway between the two pin axes, x along the
/// track (forward in ground contact), y left, z towards the inside of the loop. The pins are at x = +-pitch/2, z = 0.
struct ShoeSpec : SurfaceSpec {
  int count{};            ///< shoes per track [-]
  double pitch{};         ///< distance between the two pin axes [m]
  double plateTop{};      ///< z of the wheel path (upper plate face) [m]
  double padBottom{};     ///< z of the pad plate's lower face [m]; reference for sinkage
  double grouserHeight{}; ///< grouser height below the pad [m]
  double halfLength{};    ///< half length of plate and pad along x [m]
  double padHalfWidth{};  ///< outer |y| of the pads [m]
  double hornHeight{};    ///< guide horn height above the plate [m]; scale of the thrown-track alarm
  double maximumFold{};   ///< maximum fold angle between neighbouring shoes [rad]
  double pinDamping{};    ///< viscous moment in each pin joint [N m s/rad]
};

/// Drive sprocket, at the rear or in front. Sprocket frame: origin on the axle, y along the axle; gap k is at the angle
/// 2 pi k / teeth from +x towards +z.
struct SprocketSpec : SurfaceSpec {
  int teeth{}; ///< [-]
};

struct RoadWheelSpec : SurfaceSpec {
  int count{};      ///< wheels per track [-]
  double radius{};  ///< [m]
  double firstX{};  ///< axle position of the rearmost wheel, relative to the sprocket axle [m]
  double spacing{}; ///< [m]
  double z{};       ///< axle height above the sprocket axle [m]
};

/// Suspension of the road wheels.
enum class Suspension {
  sprung, ///< wheels on arms with torsion bars
  rigid   ///< wheels on arms fixed to the hull
};

/// Trailing arm, with its pivot ahead of and above the wheel axle. Its centre of mass is at its middle.
struct ArmSpec : MassSpec {
  Suspension suspension = Suspension::sprung; ///< rigid: stiffness, damping and preload are ignored
  double length{};                            ///< pivot to axle [m]
  double pivotAngle{};                        ///< elevation angle of the pivot seen from the axle [rad]
  double stiffness{};                         ///< torsion bar [N m/rad]
  double damping{};                           ///< [N m s/rad]
  double preload{}; ///< vertical wheel load supported by the torsion bar in the design position [N]
};

/// Return rollers. Without positions there are no rollers, and no mesh is required.
struct RollerSpec : SurfaceSpec {
  double radius{};          ///< [m]
  std::vector<double> x, z; ///< axle positions relative to the sprocket axle [m]
};

struct IdlerSpec : SurfaceSpec {
  double radius{};        ///< [m]
  double x{}, z{};        ///< drawn axle position [m]; the wrap computes the exact x, which must be in the slide range
  double slideMin{};      ///< stop towards the sprocket, relative to the wrap position [m], < 0
  double slideMax{};      ///< stop away from the sprocket [m], > 0
  double stiffness{};     ///< tensioner spring [N/m]
  double damping{};       ///< [N s/m]
  double preload{};       ///< spring force at the wrap position [N]
  double stopStiffness{}; ///< [N/m]
  double stopDamping{};   ///< [N s/m]
  double carrierMass{};   ///< [kg]
  Vec3d carrierInertia;   ///< [kg m2]
};

struct ChassisSpec : SurfaceSpec {
  Vec3d centre; ///< centre of mass relative to the middle of the sprocket axle line [m]
};

/// Engine and gear of each sprocket. If one engine drives both sprockets, enter half its torque for each.
struct EngineSpec {
  std::vector<double> speed;  ///< shaft speeds [rad/s], increasing
  std::vector<double> torque; ///< full-load torque at these speeds [N m]
  double ratio{};             ///< engine speed / sprocket speed [-]
  double efficiency = 1;      ///< gear efficiency [-]
  double governedSpeed{};     ///< maximum shaft speed under the governor [rad/s]
  double droop{};             ///< shaft speed range of the governor from zero to full torque [rad/s]
  double brakeTorque = 0;     ///< maximum braking torque on a sprocket that is faster than commanded [N m]
  double inertia{};           ///< inertia of engine and gearing, reflected to the sprocket [kg m2]
};

/// Contacts between parts, and with the ground.
struct ContactSpec {
  double foundationModulus{};       ///< force = modulus * sum(area * overlap) [N/m3]
  std::optional<double> padModulus; ///< modulus of the shoes on rigid ground [N/m3]; empty: foundationModulus
  double relaxationTime{};          ///< foundation damping: stress = modulus * (overlap + relaxationTime * rate) [s]
  double tangentialRatio{};         ///< tangential / normal stiffness [-]
  double frictionInside{};          ///< shoes against wheels, sprocket, idler [-]
  double frictionGround{};          ///< shoes against ground [-]

  double onGround() const { return padModulus.value_or(foundationModulus); } ///< modulus of a shoe on rigid ground
};

/// Constant data of a tracked vehicle with two identical tracks, at y = +-trackOffset. Vehicle frame: x forward, y
/// left, z up, origin at the middle of the sprocket axle line.
struct VehicleSpec {
  std::string name;
  std::string meshFolder; ///< absolute or relative to the working folder
  double trackOffset{};   ///< [m]
  ChassisSpec chassis;
  ShoeSpec shoe;
  SprocketSpec sprocket;
  RoadWheelSpec roadWheel;
  ArmSpec arm;
  RollerSpec roller;
  IdlerSpec idler;
  ContactSpec contact;
  std::optional<EngineSpec> engine; ///< empty if the file has no [engine]
  std::optional<GearShapes> shapes; ///< empty if the file has no [shapes]

  /// True if the sprocket is in front, i.e. the idler is behind it.
  bool sprocketInFront() const { return idler.x < 0; }
  /// Direction along x in which the tensioner pushes the idler, away from the sprocket: 1 or -1.
  double outward() const { return sprocketInFront() ? -1 : 1; }
  /// Radius of the smallest wheel that rolls in the track: road wheel, roller or idler [m].
  double smallestWheel() const;
  /// Track-ground contact length: from the rearmost to the foremost road wheel axle [m].
  double groundRun() const { return roadWheel.spacing * (roadWheel.count - 1); }
  /// x of the foremost road wheel axle [m].
  double lastWheelX() const { return roadWheel.firstX + groundRun(); }
  /// Height of the pin line in ground contact [m], with the wheels on the plates.
  double groundPinHeight() const { return roadWheel.z - roadWheel.radius - shoe.plateTop; }
  /// Height of the lowest points [m]: the grouser tips in ground contact.
  double groundHeight() const { return groundPinHeight() + shoe.padBottom - shoe.grouserHeight; }
  /// Effective pitch radius [m], i.e. mean travel per radian of the sprocket: teeth x pitch / (2 pi).
  double pitchRadius() const;
  /// Sum over all parts of both tracks and the hull [kg].
  double totalMass() const;
  /// Radius of the engaged pins [m]: pitch / (2 sin(pi / teeth)).
  double sprocketPinRadius() const;
  /// Radius of the pins on the idler [m].
  double idlerPinRadius() const;
};

} // namespace grouser::vehicle

namespace grouser::base {

template <> struct EnumWords<vehicle::Suspension> {
  using E = vehicle::Suspension;
  static constexpr EnumWord<E> list[] = {{E::sprung, "sprung"}, {E::rigid, "rigid"}};
};

} // namespace grouser::base
