// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/vec.hpp"

#include <limits>
#include <string>
#include <vector>

/// Rigid bodies in maximal coordinates, joined by constraints with Lagrange multipliers. The Model is constant while a
/// simulation runs; what changes is in State, what is imposed from outside in Loads (state.hpp), who advances is
/// Solver.
namespace grouser::multibody {

using base::Mat3d;
using base::Pose;
using base::Quat;
using base::Vec3d;

/// Index of the world (an immovable body whose frame is the world frame) in joints and springs.
inline constexpr int kWorld = -1;

struct Body {
  std::string name;
  double mass = 1;                     ///< [kg], > 0
  Mat3d inertia_B = Mat3d::identity(); ///< about the centre of mass, axes of the body frame [kg m2]
  Pose pose;                           ///< X_WB at the start; the body frame's origin is the centre of mass
  Vec3d v_WB;                          ///< velocity of the centre of mass at the start, world components [m/s]
  Vec3d w_WB;                          ///< angular velocity at the start, world components [rad/s]
  bool fixed = false;                  ///< never moves; mass and inertia are then not used
};

/// What a joint lets free. x, y, z are the axes of the joint frame; A carries one copy, B the other.
enum class JointType {
  kRevolute,  ///< turns about z
  kSpherical, ///< turns about the common origin
  kUniversal, ///< turns about z of A's frame and about x of B's frame, which stay perpendicular
  kPrismatic, ///< slides along z of A's frame
  kFixed,     ///< nothing
};

/// The degrees of freedom of B relative to A that the type leaves are measured from A to B: angle and slide grow when B
/// turns or moves in the positive sense of z while A stands still.
struct Joint {
  std::string name;
  JointType type = JointType::kRevolute;
  int bodyA = kWorld;
  int bodyB = 0;
  Pose frame_A; ///< joint frame in A's body frame (in the world if A is kWorld)
  Pose frame_B; ///< joint frame in B's body frame
  double damping =
      0; ///< on the free axis [N m s/rad] or [N s/m], >= 0; revolute and prismatic only. Implicit: any size.
};

/// Spring, damper, preload and end stops on the free axis of a revolute (SI: N m, rad) or prismatic joint (N, m).
/// Generalised force on B along +z (A gets the opposite), at axis position x (angle or slide):
///   F = loadFactor preload - stiffnessFactor stiffness (x - freePosition) - damping xdot,
/// and beyond a limit additionally -stopStiffness (x - limit) - stopDamping xdot, never pulling back into the stop.
/// Implicit in x and xdot: stable at any step; the numerical damping ratio of an undamped spring is omega dt / 2.
struct AxisSpring {
  std::string name;
  int joint = 0;
  double stiffness = 0;                                         ///< [N/m] or [N m/rad], >= 0
  double damping = 0;                                           ///< [N s/m] or [N m s/rad], >= 0
  double freePosition = 0;                                      ///< [m] or [rad]
  double preload = 0;                                           ///< force at freePosition [N] or [N m]
  double lowerLimit = -std::numeric_limits<double>::infinity(); ///< [m] or [rad]
  double upperLimit = std::numeric_limits<double>::infinity();  ///< [m] or [rad]
  double stopStiffness = 0;                                     ///< [N/m] or [N m/rad], >= 0
  double stopDamping = 0;                                       ///< [N s/m] or [N m s/rad], >= 0
};

/// Spring-damper between a point of A and a point of B. Force that pushes the points apart, at distance l:
///   F = loadFactor preload - stiffnessFactor stiffness (l - restLength) - damping ldot. Implicit, as AxisSpring.
struct PointSpring {
  std::string name;
  int bodyA = kWorld;
  int bodyB = 0;
  Vec3d point_A;         ///< in A's body frame (world if kWorld) [m]
  Vec3d point_B;         ///< in B's body frame [m]
  double stiffness = 0;  ///< [N/m], >= 0
  double damping = 0;    ///< [N s/m], >= 0
  double restLength = 0; ///< [m], >= 0
  double preload = 0;    ///< force at restLength, positive pushes apart [N]
};

/// Imposes the rate of a revolute's or prismatic's axis by a constraint; its torque [N m] or force [N] is the
/// multiplier.
struct Drive {
  std::string name;
  int joint = 0;
  double speed = 0; ///< at the start; Loads changes it in each step [rad/s] or [m/s]
  bool on = true;   ///< off: the axis is free
};

/// The mechanism. Every add... checks what it is given, throws base::InputError naming the part, and returns an index.
class Model {
public:
  int addBody(const Body& body);
  int addJoint(const Joint& joint);
  /// A joint whose two frames coincide at the start: `X_WJ` is the joint frame in the world, the bodies are where they
  /// were added.
  int addJointAt(const std::string& name, JointType type, int bodyA, int bodyB, const Pose& X_WJ, double damping = 0);
  int addAxisSpring(const AxisSpring& spring);
  int addPointSpring(const PointSpring& spring);
  int addDrive(const Drive& drive);

  const std::vector<Body>& bodies() const { return bodies_; }
  const std::vector<Joint>& joints() const { return joints_; }
  const std::vector<AxisSpring>& axisSprings() const { return axisSprings_; }
  const std::vector<PointSpring>& pointSprings() const { return pointSprings_; }
  const std::vector<Drive>& drives() const { return drives_; }

  /// Index by name; throws base::InputError if there is none.
  int bodyIndex(const std::string& name) const;
  int jointIndex(const std::string& name) const;
  /// "world" or the body's name.
  const std::string& bodyName(int body) const;

private:
  void checkBodies(const std::string& what, int bodyA, int bodyB) const;
  void checkAxis(const std::string& what, int joint) const;

  std::vector<Body> bodies_;
  std::vector<Joint> joints_;
  std::vector<AxisSpring> axisSprings_;
  std::vector<PointSpring> pointSprings_;
  std::vector<Drive> drives_;
};

/// Pose whose z axis points along `axis` (need not be a unit vector), x and y chosen perpendicular.
Pose frameWithZ(const Vec3d& position, const Vec3d& axis);
/// Pose with z along `z` and x along the part of `x` perpendicular to it.
Pose frameWithZX(const Vec3d& position, const Vec3d& z, const Vec3d& x);
/// Product of poses: X_WC = X_WB X_BC.
Pose compose(const Pose& X_WB, const Pose& X_BC);
/// X_BW of X_WB.
Pose inverse(const Pose& X_WB);

} // namespace grouser::multibody
