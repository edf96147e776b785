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

/// Name of a side: "left" or "right".
const char* sideName(Side side);

enum class PartKind { kChassis, kShoe, kSprocket, kRoadWheel, kRoller, kIdler };

/// Rigid part with a surface. The coordinates of its mesh are in the part frame P; the body frame B has its origin at
/// the centre of mass.
struct Part {
  std::string name; ///< "left shoe 12"
  PartKind kind{};
  int body{};        ///< index into the model's bodies
  std::string mesh;  ///< file name in the spec's mesh folder; the same for all parts of a kind
  int track = -1;    ///< index into Assembly::tracks, -1 for the chassis
  base::Pose pose_B; ///< X_BP
};

/// Pair of parts of one track that may be in contact: indices into Assembly::parts.
struct PartPair {
  int shoe{};
  int other{}; ///< sprocket, road wheel, roller or idler
};

/// Indices of one track's bodies, joints and springs in the model.
struct Track {
  Side side{};
  double y{};             ///< y of the track's mid-plane in the vehicle frame [m]
  std::vector<int> shoes; ///< bodies, in the order of the wrap
  std::vector<int>
      shoeJoints;          ///< joint i connects shoe i (A) and shoe i+1 (B); its angle is the fold, > 0 about a wheel
  std::vector<int> wheels; ///< bodies, rearmost first
  std::vector<int> arms;   ///< bodies
  std::vector<int> armJoints;               ///< chassis to arm, positive about +y (wheel up); fixed for rigid arms
  std::vector<int> armSprings;              ///< axis springs; none for rigid arms
  std::vector<int> rollers;                 ///< bodies
  int sprocket{}, sprocketJoint{}, drive{}; ///< body, joint (positive is forward), speed drive
  int torque = -1;                          ///< torque drive; -1 if there is none
  int carrier{}, slideJoint{}, tensioner{}; ///< body, joint (positive is away from the sprocket), axis spring
  int idler{};                              ///< body
  std::vector<int> shoeParts;               ///< indices into Assembly::parts, in the order of the wrap
};

/// Optional motion guides of a free hull.
enum class HullGuide {
  none,
  pitching, ///< free in x, z and pitch; no sway, yaw or roll
  level     ///< as pitching, but without pitch
};

struct AssemblyOptions {
  base::Pose pose_W;                 ///< initial pose of the vehicle frame in the world, X_WV
  base::Vec3d velocity;              ///< initial velocity of the whole vehicle, world components [m/s]
  bool fixChassis = false;           ///< true: the chassis is immovable
  HullGuide guide = HullGuide::none; ///< guide of a moving chassis, along the initial axes of the vehicle frame
  bool left = true;                  ///< build the left track
  bool right = true;                 ///< build the right track
  SprocketDrive drive = SprocketDrive::speed;
};

/// Assembled vehicle with exactly wrapped tracks: all joints are initially closed, all springs at their drawn
/// positions. Each ring of shoes has one spherical and one universal joint, half a loop apart; all others are revolute.
/// A planar ring of revolute joints has three redundant constraints, which these two joints remove.
struct Assembly {
  VehicleSpec spec;
  Wrap wrap;
  multibody::Model model;
  int chassis{};
  std::vector<Track> tracks;    ///< left before right
  std::vector<Part> parts;      ///< the chassis first
  std::vector<PartPair> pairs;  ///< each shoe with each wheel of its track
  std::vector<int> groundParts; ///< parts in contact with the ground: all shoes
  double mass{};                ///< mass of all moving bodies [kg]
};

/// Builds the vehicle. Throws base::InputError if the track loop does not close (wrap) or no track is selected.
Assembly assemble(const VehicleSpec& spec, const AssemblyOptions& options = {});

/// Pose of the vehicle frame with the lowest grousers at `clearance` above level ground of height `groundHeight`. (x,
/// y): middle of the sprocket axle line; `heading`: from +x towards +y [rad].
base::Pose placeOnGround(const VehicleSpec& spec, double x, double y, double groundHeight, double clearance,
                         double heading);

/// Pose on inclined ground of height `groundHeight` at (x, y), with slopes `ahead` along the heading and `left` to the
/// left of it [-]; `clearance` is normal to the ground. The heading is the horizontal projection of the hull's x axis.
base::Pose placeOnSlope(const VehicleSpec& spec, double x, double y, double groundHeight, double clearance,
                        double heading, double ahead, double left);

/// Converts driver controls to loads: gravity, preload factors of tensioners and arms, drive speeds. The wrenches in
/// `loads` do not change. `gravity`: gravity of the scene after its ramp [m/s2].
void applyControls(const Assembly& vehicle, const Controls& controls, const base::Vec3d& gravity,
                   multibody::Loads& loads);

/// Returns the hull motion for the driver.
HullMotion hullMotion(const Assembly& vehicle, const multibody::State& state);

/// Returns the motion of a hull point for the hitch; `point` in the vehicle frame [m].
HitchMotion hitchMotion(const Assembly& vehicle, const multibody::State& state, const base::Vec3d& point);

/// Adds the governed engine torques at the current sprocket speeds.
void addEngineTorques(const Assembly& vehicle, const multibody::State& state, Controls& controls);

/// Returns the pose of a part in the world.
base::Pose partPose(const Part& part, const multibody::State& state);

} // namespace grouser::vehicle
