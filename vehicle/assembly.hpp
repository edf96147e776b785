// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "multibody/model.hpp"
#include "multibody/state.hpp"
#include "vehicle/driver.hpp"
#include "vehicle/hitch.hpp"
#include "vehicle/spec.hpp"
#include "vehicle/wrap.hpp"

#include <string>
#include <vector>

namespace grouser::vehicle {

enum class Side { kLeft, kRight };

/// "left" or "right".
const char* sideName(Side side);

enum class PartKind { kChassis, kShoe, kSprocket, kRoadWheel, kRoller, kIdler };

/// A rigid part with a surface. Its mesh stands in the part frame P; the body frame B has its origin in the centre of
/// mass.
struct Part {
  std::string name; ///< "left shoe 12"
  PartKind kind{};
  int body{};        ///< index into the model's bodies
  std::string mesh;  ///< file name in the spec's mesh folder; parts of one kind share it
  int track = -1;    ///< index into Assembly::tracks, -1 for the chassis
  base::Pose pose_B; ///< X_BP
};

/// Two parts of one track that can touch: indices into Assembly::parts.
struct PartPair {
  int shoe{};
  int other{}; ///< sprocket, road wheel, roller or idler
};

/// Where one track's bodies, joints and springs are in the model.
struct Track {
  Side side{};
  double y{};             ///< of its middle in the vehicle frame [m]
  std::vector<int> shoes; ///< bodies, in the order of the wrap
  std::vector<int>
      shoeJoints;          ///< joint i holds shoe i (A) and shoe i+1 (B); its angle is the fold, positive about a wheel
  std::vector<int> wheels; ///< bodies, rearmost first
  std::vector<int> arms;   ///< bodies
  std::vector<int> armJoints;  ///< chassis to arm, positive about +y: the wheel goes up; rigid arms do not turn
  std::vector<int> armSprings; ///< axis springs; none of rigid arms
  std::vector<int> rollers;    ///< bodies
  int sprocket{}, sprocketJoint{}, drive{}; ///< body, joint (positive is forward), drive by speed
  int torque = -1;                          ///< drive by torque, where that is meant
  int carrier{}, slideJoint{}, tensioner{}; ///< body, joint (positive is away from the sprocket), axis spring
  int idler{};                              ///< body
  std::vector<int> shoeParts;               ///< indices into Assembly::parts, in the order of `shoes`
};

/// Rails that a free hull may run on.
enum class HullGuide {
  none,
  pitching, ///< it moves along, rises and pitches, and does not sway, yaw or roll
  level     ///< nor pitch
};

struct AssemblyOptions {
  base::Pose pose_W;                 ///< of the vehicle frame in the world at the start: X_WV
  base::Vec3d velocity;              ///< of the whole vehicle at the start, world components [m/s]
  bool fixChassis = false;           ///< the chassis never moves
  HullGuide guide = HullGuide::none; ///< of a chassis that moves; along the axes of the vehicle frame at the start
  bool left = true;                  ///< build the left track
  bool right = true;                 ///< build the right track
  SprocketDrive drive = SprocketDrive::speed;
};

/// A vehicle, exactly wrapped, ready to be stepped: every joint is closed at the start, every spring at its drawn
/// place. Each ring of shoes has one spherical and one universal joint, half a loop apart; all others are revolutes. A
/// plane ring of revolutes alone has three constraints too many, which is just what these two leave out.
struct Assembly {
  VehicleSpec spec;
  Wrap wrap;
  multibody::Model model;
  int chassis{};
  std::vector<Track> tracks;    ///< left before right
  std::vector<Part> parts;      ///< the chassis first
  std::vector<PartPair> pairs;  ///< every shoe with every wheel of its track
  std::vector<int> groundParts; ///< parts that touch the ground: all shoes
  double mass{};                ///< of all moving bodies [kg]
};

/// Build the vehicle. Throws base::InputError when the track does not close (wrap) or no track is asked for.
Assembly assemble(const VehicleSpec& spec, const AssemblyOptions& options = {});

/// Place of the vehicle frame so that the lowest grousers stand `clearance` over a level ground of height
/// `groundHeight`; (x, y) is the middle of the sprockets' axle line, `heading` turns from +x towards +y [rad].
base::Pose placeOnGround(const VehicleSpec& spec, double x, double y, double groundHeight, double clearance,
                         double heading);

/// The same on inclined ground of height `groundHeight` at (x, y), that rises by `ahead` along the heading and by
/// `left` to its left [-]; `clearance` is square to it. The hull's x axis lies over the heading.
base::Pose placeOnSlope(const VehicleSpec& spec, double x, double y, double groundHeight, double clearance,
                        double heading, double ahead, double left);

/// Turn the driver's wishes into loads: gravity, preload factors of tensioners and arms, drive speeds. `gravity` is the
/// full gravity of the scene [m/s2]; wrenches in `loads` are left alone.
void applyControls(const Assembly& vehicle, const Controls& controls, const base::Vec3d& gravity,
                   multibody::Loads& loads);

/// The hull as a driver sees it.
HullMotion hullMotion(const Assembly& vehicle, const multibody::State& state);

/// A point of the hull, given in the vehicle frame [m], as a hitch sees it.
HitchMotion hitchMotion(const Assembly& vehicle, const multibody::State& state, const base::Vec3d& point);

/// Has the engines give the torques that their governors find at the sprockets' speeds.
void addEngineTorques(const Assembly& vehicle, const multibody::State& state, Controls& controls);

/// Pose of a part in the world.
base::Pose partPose(const Part& part, const multibody::State& state);

} // namespace grouser::vehicle
