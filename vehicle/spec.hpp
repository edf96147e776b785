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

/// Mass and principal moments of inertia about the centre of mass, axes along the part's frame.
struct MassSpec {
  double mass{}; ///< [kg]
  Vec3d inertia; ///< (I_xx, I_yy, I_zz) [kg m2]
};

/// A part with a surface.
struct SurfaceSpec : MassSpec {
  std::string mesh; ///< mesh file in the spec's mesh folder
};

/// Track shoe. Centre of mass on the pin line. Its frame: origin in the middle between the two pin axes, x along the
/// track (forward in ground contact), y left, z towards the inside of the loop. The pins lie at x = +-pitch/2, z = 0.
struct ShoeSpec : SurfaceSpec {
  int count{};            ///< shoes per track [-]
  double pitch{};         ///< distance of the two pin axes [m]
  double plateTop{};      ///< z of the wheel plate's face, on which wheels roll [m]
  double padBottom{};     ///< z of the pad plate's lower face [m]; sinkage is measured from here
  double grouserHeight{}; ///< how far the grousers reach below the pad [m]
  double halfLength{};    ///< half length of plate and pad along x [m]
  double padHalfWidth{};  ///< pads reach to this |y| [m]
  double hornHeight{};    ///< guide horn above the plate [m]; scale of the thrown-track alarm
  double maximumFold{};   ///< largest angle between neighbours that the plates clear [rad]
  double pinDamping{};    ///< viscous moment in each pin joint [N m s/rad]
};

/// Drive sprocket, at the rear or in front. Its frame: origin on the axle, y along it; gap k lies at the angle 2 pi k /
/// teeth from +x towards +z.
struct SprocketSpec : SurfaceSpec {
  int teeth{}; ///< [-]
};

struct RoadWheelSpec : SurfaceSpec {
  int count{};      ///< per track [-]
  double radius{};  ///< [m]
  double firstX{};  ///< axle of the rearmost wheel, from the sprocket's axle [m]
  double spacing{}; ///< [m]
  double z{};       ///< axle height over the sprocket's axle [m]
};

/// Suspension of the road wheels.
enum class Suspension {
  sprung, ///< on arms with torsion bars
  rigid   ///< on arms fixed to the hull
};

/// Trailing arm: from a pivot ahead of and above the wheel's axle. Its centre of mass lies in its middle.
struct ArmSpec : MassSpec {
  Suspension suspension = Suspension::sprung; ///< rigid: stiffness, damping and preload are ignored
  double length{};                            ///< pivot to axle [m]
  double pivotAngle{};                        ///< of the pivot over the horizontal through the axle [rad]
  double stiffness{};                         ///< torsion bar [N m/rad]
  double damping{};                           ///< [N m s/rad]
  double preload{}; ///< vertical load on the wheel that the bar carries in the drawn position [N]
};

/// Without positions there are no rollers, and no mesh is required.
struct RollerSpec : SurfaceSpec {
  double radius{};          ///< [m]
  std::vector<double> x, z; ///< axles from the sprocket's axle [m]
};

struct IdlerSpec : SurfaceSpec {
  double radius{}; ///< [m]
  double x{}, z{}; ///< drawn axle position [m]; the wrap computes the exact x, which must lie within the slide's range
  double slideMin{};      ///< stop towards the sprocket, relative to the wrap's place [m], < 0
  double slideMax{};      ///< stop away from it [m], > 0
  double stiffness{};     ///< tensioner spring [N/m]
  double damping{};       ///< [N s/m]
  double preload{};       ///< spring force at the wrap's place [N]
  double stopStiffness{}; ///< [N/m]
  double stopDamping{};   ///< [N s/m]
  double carrierMass{};   ///< [kg]
  Vec3d carrierInertia;   ///< [kg m2]
};

struct ChassisSpec : SurfaceSpec {
  Vec3d centre; ///< centre of mass from the middle of the sprockets' axle line [m]
};

/// Engine and gear of each sprocket. If one engine drives both, half of its torque each.
struct EngineSpec {
  std::vector<double> speed;  ///< shaft speeds [rad/s], increasing
  std::vector<double> torque; ///< full load at these speeds [N m]
  double ratio{};             ///< speed of the engine over that of the sprocket [-]
  double efficiency = 1;      ///< of the gear [-]
  double governedSpeed{};     ///< maximum shaft speed under the governor [rad/s]
  double droop{};             ///< shaft speed range of the governor from zero to full torque [rad/s]
  double brakeTorque = 0;     ///< maximum braking torque on a sprocket faster than commanded [N m]
  double inertia{};           ///< of engine and gearing, reflected to the sprocket [kg m2]
};

/// Contacts between parts, and with the ground.
struct ContactSpec {
  double foundationModulus{}; ///< force = modulus * sum(area * overlap) [N/m3]
  double relaxationTime{};    ///< damping of the foundation: stress = modulus * (overlap + time * rate) [s]
  double tangentialRatio{};   ///< tangential over normal stiffness [-]
  double frictionInside{};    ///< shoes against wheels, sprocket, idler [-]
  double frictionGround{};    ///< shoes against ground [-]
};

/// Constant data of a tracked vehicle. Vehicle frame: x forward, y left, z up, origin in the middle of the sprockets'
/// axle line. The two tracks are identical, at y = +-trackOffset.
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
  std::optional<EngineSpec> engine; ///< if the file has one
  std::optional<GearShapes> shapes; ///< if the file has them

  /// True if the sprocket is in front, i.e. the idler lies behind it.
  bool sprocketInFront() const { return idler.x < 0; }
  /// Direction along x in which the tensioner pushes the idler, away from the sprocket: 1 or -1.
  double outward() const { return sprocketInFront() ? -1 : 1; }
  /// Radius of the smallest wheel that rolls in the track [m].
  double smallestWheel() const;
  /// Track-ground contact length: from the rearmost road wheel's axle to the foremost one's [m].
  double groundRun() const { return roadWheel.spacing * (roadWheel.count - 1); }
  /// x of the foremost road wheel's axle [m].
  double lastWheelX() const { return roadWheel.firstX + groundRun(); }
  /// Height of the pin line in ground contact [m]: wheels stand on the plates.
  double groundPinHeight() const { return roadWheel.z - roadWheel.radius - shoe.plateTop; }
  /// Height of the lowest points, the grousers in ground contact [m].
  double groundHeight() const { return groundPinHeight() + shoe.padBottom - shoe.grouserHeight; }
  /// Mean travel per radian of the sprocket [m]: teeth x pitch / (2 pi).
  double pitchRadius() const;
  /// Sum over all parts, both tracks [kg].
  double totalMass() const;
  /// Radius of engaged pins [m]: pitch / (2 sin(pi / teeth)).
  double sprocketPinRadius() const;
  /// Radius of the pins that lie on the idler [m].
  double idlerPinRadius() const;
};

} // namespace grouser::vehicle

namespace grouser::base {

template <> struct EnumWords<vehicle::Suspension> {
  using E = vehicle::Suspension;
  static constexpr EnumWord<E> list[] = {{E::sprung, "sprung"}, {E::rigid, "rigid"}};
};

} // namespace grouser::base
