// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/vec.hpp"
#include "multibody/time_law.hpp"

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

/// Rigid bodies in maximal coordinates, connected by constraints with Lagrange multipliers. The Model is constant
/// during a simulation; State contains the variables, Loads the external inputs (state.hpp); Solver advances the State.
namespace grouser::multibody {

using base::Mat3d;
using base::Pose;
using base::Quat;
using base::Vec3d;

struct PartName; // part_error.hpp

/// Index of the world, an immovable body with the world frame as body frame, in joints and springs.
inline constexpr int kWorld = -1;

struct Body {
  std::string name;
  double mass = 1;                     ///< [kg], > 0
  Mat3d inertia_B = Mat3d::identity(); ///< about the centre of mass, axes of the body frame [kg m2]
  Pose pose;                           ///< X_WB at the start; the body frame's origin is the centre of mass
  Vec3d v_WB;                          ///< velocity of the centre of mass at the start, world components [m/s]
  Vec3d w_WB;                          ///< angular velocity at the start, world components [rad/s]
  bool fixed = false;                  ///< true: immovable; mass and inertia are ignored
  /// Point mass: has a position but no inertia or orientation (inertia_B is ignored, w_WB must be 0). Only spherical
  /// joints, distance joints and point springs may attach to it, and only at its origin, so that no torque acts on it.
  /// A pendulum bob on a massless rod is a point body with a distance joint.
  bool point = false;
};

/// Joint types with their free motions. x, y, z are the axes of the two joint frames, one attached to A, one to B.
enum class JointType {
  kRevolute,    ///< rotation about z
  kSpherical,   ///< rotation about the common origin
  kUniversal,   ///< rotation about z of A's frame and x of B's frame, which remain perpendicular
  kPrismatic,   ///< translation along z of A's frame
  kFixed,       ///< no relative motion
  kCylindrical, ///< rotation about z and translation along z of A's frame
  kDistance,    ///< constant distance between the two origins: a massless rigid rod with ball joints
};

/// Free axis of a joint.
enum class JointAxis {
  kOnly,  ///< angle of a revolute or slide of a prismatic joint; not valid for a cylindrical joint
  kAngle, ///< angle of a revolute or cylindrical joint [rad]
  kSlide, ///< slide of a prismatic or cylindrical joint [m]
};

/// Joint between bodies A and B. Angle and slide describe the motion of B relative to A, positive for a rotation about,
/// or translation along, +z. Angles are continuous over full turns.
struct Joint {
  std::string name;
  JointType type = JointType::kRevolute;
  int bodyA = kWorld;
  int bodyB = 0;
  Pose frame_A; ///< joint frame in A's body frame (in the world if A is kWorld)
  Pose frame_B; ///< joint frame in B's body frame
  double damping =
      0; ///< damping of the free axis, or of a cylindrical's angle [N m s/rad] or [N s/m], >= 0; implicit: any value
  double slideDamping = 0; ///< damping of the slide of a cylindrical joint [N s/m], >= 0
  double length = 0;       ///< length of a distance joint [m], > 0; 0: from the body poses
};

/// Spring, damper, preload and end stops on a free axis of a revolute, prismatic or cylindrical joint (N m and rad for
/// an angle, N and m for a slide). For an axis with end stops (limits) only, set stiffness = 0. Generalised force on B
/// along +z (A receives the opposite), at axis position x (angle or slide):
///   F = loadFactor preload - stiffnessFactor stiffness (x - freePosition) - damping xdot,
/// and beyond a limit additionally -stopStiffness (x - limit) - stopDamping xdot, never adhesive. With
/// Integrator::kSymplecticEuler the force is implicit in x and xdot, so any step is stable; the numerical damping
/// ratio of an undamped spring is omega dt / 2. For Integrator::kRattle see Springs in solver_options.hpp.
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
  JointAxis axis = JointAxis::kOnly;
};

/// Spring-damper between a point of A and a point of B, implicit like AxisSpring. Repulsive force at distance l:
///   F = loadFactor preload - stiffnessFactor stiffness (l - restLength) - damping ldot.
struct PointSpring {
  std::string name;
  int bodyA = kWorld;
  int bodyB = 0;
  Vec3d point_A;         ///< point in A's body frame (world if kWorld) [m]
  Vec3d point_B;         ///< point in B's body frame [m]
  double stiffness = 0;  ///< [N/m], >= 0
  double damping = 0;    ///< [N s/m], >= 0
  double restLength = 0; ///< [m], >= 0
  double preload = 0;    ///< force at restLength [N]; positive: repulsive
};

/// Elastic bearing: linear springs and dampers in all six directions between a frame of A and a frame of B.
/// Translation d: from the origin of A's frame to the origin of B's frame, in the axes of A's frame. Rotation phi: the
/// rotation vector (axis times angle, |phi| < pi) of R_AB, which transforms components in B's frame to A's frame. Force
/// on B at the origin of B's frame, and torque on B, in the axes of A's frame (A receives the opposite at the same
/// point), with diagonal matrices:
///   F = -stiffness d - damping ddot,     M = -Y(phi)^T (rotationStiffness phi + rotationDamping phidot),
/// where phidot = Y(phi) w_AB; Y tends to the identity for small phi. The elastic energy is (d . stiffness d + phi .
/// rotationStiffness phi) / 2 at any phi.
struct Bushing {
  std::string name;
  int bodyA = kWorld;
  int bodyB = 0;
  Pose frame_A;            ///< bushing frame in A's body frame (in the world if A is kWorld)
  Pose frame_B;            ///< bushing frame in B's body frame
  Vec3d stiffness;         ///< along x, y, z [N/m], each >= 0
  Vec3d damping;           ///< along x, y, z [N s/m], each >= 0
  Vec3d rotationStiffness; ///< [N m/rad], each >= 0
  Vec3d rotationDamping;   ///< [N m s/rad], each >= 0
};

enum class DriveKind {
  kSpeed,    ///< imposes the rate of the axis by a constraint [rad/s] or [m/s]
  kPosition, ///< imposes the position of the axis over time, and the corresponding rate [rad] or [m]
  kForce,    ///< applies a torque [N m] or force [N] to B along +axis, the opposite to A
};

/// Drive of a free axis of a revolute, prismatic or cylindrical joint. The force of an imposed motion is the
/// multiplier of its constraint; see JointReading, driveForce() and drivePower() in state.hpp and readings.hpp.
struct Drive {
  std::string name;
  int joint = 0;
  double speed = 0; ///< kSpeed without a law: initial value, set in each step by Loads [rad/s] or [m/s]
  bool on = true;   ///< false: the axis is free
  JointAxis axis = JointAxis::kOnly;
  DriveKind kind = DriveKind::kSpeed;
  /// Speed, position or force over time. Empty: Loads sets speed or force in each step (kPosition requires a law). A
  /// speed law is imposed as a position, start + integral of the law, which prevents drift.
  TimeLaw law{};
};

/// Couples the positions of two axes (gears, belts, rack and pinion, screw):
///   position of axis 2 = ratio * position of axis 1 + offset.
/// The two joints may connect up to four bodies; each axis force acts on the two bodies of its joint. The housing of a
/// gear supports the difference of the two torques.
struct Coupling {
  std::string name;
  int joint1 = 0;
  int joint2 = 0;
  double ratio = 1; ///< [-], [m/rad] (rack: radius; screw: lead / 2 pi) or [rad/m]; not 0
  JointAxis axis1 = JointAxis::kOnly;
  JointAxis axis2 = JointAxis::kOnly;
  double offset = std::numeric_limits<double>::quiet_NaN(); ///< [rad] or [m]; NaN: from the body poses
};

/// Numbers of parts of each kind.
struct PartCounts {
  std::size_t bodies{}, joints{}, axisSprings{}, pointSprings{}, bushings{}, drives{}, couplings{};
};

/// Mechanism model. Every add... function checks its arguments, throws PartError, and returns an index.
class Model {
public:
  int addBody(const Body& body);
  int addJoint(const Joint& joint);
  /// Adds a joint with frames that coincide at the start: `X_WJ` is the joint frame in the world, at the poses of the
  /// existing bodies.
  int addJointAt(const std::string& name, JointType type, int bodyA, int bodyB, const Pose& X_WJ, double damping = 0);
  int addAxisSpring(const AxisSpring& spring);
  int addPointSpring(const PointSpring& spring);
  int addBushing(const Bushing& bushing);
  int addDrive(const Drive& drive);
  int addCoupling(const Coupling& coupling);
  /// Translates all bodies by `way` [m], and also the frames of joints, springs and bushings attached to the world.
  void translate(const Vec3d& way);

  const std::vector<Body>& bodies() const { return bodies_; }
  const std::vector<Joint>& joints() const { return joints_; }
  const std::vector<AxisSpring>& axisSprings() const { return axisSprings_; }
  const std::vector<PointSpring>& pointSprings() const { return pointSprings_; }
  const std::vector<Bushing>& bushings() const { return bushings_; }
  const std::vector<Drive>& drives() const { return drives_; }
  const std::vector<Coupling>& couplings() const { return couplings_; }

  PartCounts counts() const;
  /// Adds the parts of `all` beyond `from`; the first parts of `all` must be the parts of this model, possibly at other
  /// poses. Bodies in `moved` ([body of all]) move with the frame from `X_from` to `X_to`.
  void append(const Model& all, const PartCounts& from, const std::vector<bool>& moved, const Pose& X_from,
              const Pose& X_to);

  /// Index of an element by name; throws PartError if no element has this name.
  int bodyIndex(const std::string& name) const;
  int jointIndex(const std::string& name) const;
  /// Name of a body; "world" for kWorld.
  const std::string& bodyName(int body) const;

private:
  void checkBodies(const PartName& what, int bodyA, int bodyB) const;
  void checkAxis(const PartName& what, int joint, JointAxis& axis) const;
  void checkPoint(const PartName& what, int body, const Vec3d& point_B, bool mayTurnFreely) const;

  std::vector<Body> bodies_;
  std::vector<Joint> joints_;
  std::vector<AxisSpring> axisSprings_;
  std::vector<PointSpring> pointSprings_;
  std::vector<Bushing> bushings_;
  std::vector<Drive> drives_;
  std::vector<Coupling> couplings_;
};

/// Pose with its z axis along `axis` (any length > 0); x and y are arbitrary perpendicular axes.
Pose frameWithZ(const Vec3d& position, const Vec3d& axis);
/// Pose with z along `z` and x along the component of `x` perpendicular to it.
Pose frameWithZX(const Vec3d& position, const Vec3d& z, const Vec3d& x);
/// Product of poses: X_WC = X_WB X_BC.
Pose compose(const Pose& X_WB, const Pose& X_BC);
/// Inverse pose: X_BW of X_WB.
Pose inverse(const Pose& X_WB);

} // namespace grouser::multibody
