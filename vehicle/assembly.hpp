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

/// A rigid part with a surface. Its mesh is given in the part frame P; the body frame B has its origin at the centre of
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

/// Indices of one track's bodies, joints and springs in the model.
struct Track {
  Side side{};
  double y{};             ///< of its middle in the vehicle frame [m]
  std::vector<int> shoes; ///< bodies, in the order of the wrap
  std::vector<int>
      shoeJoints;          ///< joint i holds shoe i (A) and shoe i+1 (B); its angle is the fold, positive about a wheel
  std::vector<int> wheels; ///< bodies, rearmost first
  std::vector<int> arms;   ///< bodies
  std::vector<int> armJoints;               ///< chassis to arm, positive about +y (wheel up); rigid arms do not rotate
  std::vector<int> armSprings;              ///< axis springs; none for rigid arms
  std::vector<int> rollers;                 ///< bodies
  int sprocket{}, sprocketJoint{}, drive{}; ///< body, joint (positive is forward), drive by speed
  int torque = -1;                          ///< drive by torque, if used
  int carrier{}, slideJoint{}, tensioner{}; ///< body, joint (positive is away from the sprocket), axis spring
  int idler{};                              ///< body
  std::vector<int> shoeParts;               ///< indices into Assembly::parts, in the order of `shoes`
};

/// Optional guides of a free hull.
enum class HullGuide {
  none,
  pitching, ///< free in x, z and pitch; no sway, yaw or roll
  level     ///< no pitch either
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

/// An assembled vehicle with exactly wrapped tracks: every joint is closed at the start, every spring at its drawn
/// position. Each ring of shoes has one spherical and one universal joint, half a loop apart; all others are revolutes.
/// A plane ring of revolutes has three redundant constraints, which these two joints remove.
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

/// Builds the vehicle. Throws base::InputError if the track does not close (wrap) or no track is selected.
Assembly assemble(const VehicleSpec& spec, const AssemblyOptions& options = {});

/// Pose of the vehicle frame with the lowest grousers `clearance` above level ground of height `groundHeight`; (x, y)
/// is the middle of the sprockets' axle line, `heading` turns from +x towards +y [rad].
base::Pose placeOnGround(const VehicleSpec& spec, double x, double y, double groundHeight, double clearance,
                         double heading);

/// The same on inclined ground of height `groundHeight` at (x, y) with slopes `ahead` along the heading and `left` to
/// its left [-]; `clearance` is normal to it. The hull's x axis lies above the heading.
base::Pose placeOnSlope(const VehicleSpec& spec, double x, double y, double groundHeight, double clearance,
                        double heading, double ahead, double left);

/// Converts driver controls to loads: gravity, preload factors of tensioners and arms, drive speeds. `gravity` is the
/// full gravity of the scene [m/s2]; wrenches in `loads` are unchanged.
void applyControls(const Assembly& vehicle, const Controls& controls, const base::Vec3d& gravity,
                   multibody::Loads& loads);

/// Hull motion for the driver.
HullMotion hullMotion(const Assembly& vehicle, const multibody::State& state);

/// Motion of a hull point for the hitch; `point` in the vehicle frame [m].
HitchMotion hitchMotion(const Assembly& vehicle, const multibody::State& state, const base::Vec3d& point);

/// Adds the engine torques from the governors at the present sprocket speeds.
void addEngineTorques(const Assembly& vehicle, const multibody::State& state, Controls& controls);

/// Pose of a part in the world.
base::Pose partPose(const Part& part, const multibody::State& state);

} // namespace grouser::vehicle
