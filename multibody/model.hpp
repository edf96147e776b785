// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/vec.hpp"
#include "multibody/time_law.hpp"

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

/// Rigid bodies in maximal coordinates, joined by constraints with Lagrange multipliers. The Model is constant during a
/// simulation; State holds the variables, Loads the external inputs (state.hpp), and Solver advances it.
namespace grouser::multibody {

using base::Mat3d;
using base::Pose;
using base::Quat;
using base::Vec3d;

struct PartName; // part_error.hpp

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
  /// A mass without extent: has a place, but neither inertia nor attitude (inertia_B is not used, w_WB must be 0). Only
  /// spherical joints, distance joints and point springs may hold it, and only at its own origin, so that nothing can
  /// turn it. A pendulum's bob on a massless rod is a point body on a distance joint.
  bool point = false;
};

/// Free motions of a joint. x, y, z are the axes of the joint frame; A carries one copy, B the other.
enum class JointType {
  kRevolute,    ///< turns about z
  kSpherical,   ///< turns about the common origin
  kUniversal,   ///< turns about z of A's frame and about x of B's frame, which stay perpendicular
  kPrismatic,   ///< slides along z of A's frame
  kFixed,       ///< nothing
  kCylindrical, ///< turns about z and slides along z of A's frame
  kDistance,    ///< all but the distance between the two origins: a massless rigid rod with a ball at either end
};

/// Free axis of a joint.
enum class JointAxis {
  kOnly,  ///< the angle of a revolute or the slide of a prismatic; a cylindrical must name one of the two below
  kAngle, ///< of a revolute or cylindrical [rad]
  kSlide, ///< of a prismatic or cylindrical [m]
};

/// The degrees of freedom of B relative to A that the type leaves are measured from A to B: angle and slide grow when B
/// turns or moves in the positive sense of z while A stands still. Angles are continuous over full turns.
struct Joint {
  std::string name;
  JointType type = JointType::kRevolute;
  int bodyA = kWorld;
  int bodyB = 0;
  Pose frame_A; ///< joint frame in A's body frame (in the world if A is kWorld)
  Pose frame_B; ///< joint frame in B's body frame
  double damping =
      0; ///< on the free axis, on the angle of a cylindrical [N m s/rad] or [N s/m], >= 0. Implicit: any size.
  double slideDamping = 0; ///< on the slide of a cylindrical [N s/m], >= 0
  double length = 0;       ///< of a distance joint [m], > 0; 0: from the body poses
};

/// Spring, damper, preload and end stops on a free axis of a revolute, prismatic or cylindrical joint (N m and rad on
/// an angle, N and m on a slide). End stops alone (limits of the axis) are a spring of stiffness 0. Generalised force
/// on B along +z (A gets the opposite), at axis position x (angle or slide):
///   F = loadFactor preload - stiffnessFactor stiffness (x - freePosition) - damping xdot,
/// and beyond a limit additionally -stopStiffness (x - limit) - stopDamping xdot, never pulling back into the stop.
/// Integrator::kSymplecticEuler takes it implicitly in x and xdot: stable at any step; the numerical damping ratio of
/// an undamped spring is omega dt / 2. For Integrator::kRattle see Springs in solver.hpp.
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

/// Elastic bearing: linear springs and dampers in all six directions between a frame of A and a frame of B.
/// Translation d: from A's origin to B's, in the axes of A's frame. Rotation phi: the rotation vector (axis times
/// angle, |phi| < pi) of R_AB, which takes components in B's frame to components in A's frame. With K, C diagonal,
/// force on B at the origin of its frame, and torque on B, in the axes of A's frame (A feels the opposite at the same
/// point):
///   F = -stiffness d - damping ddot,     M = -Y(phi)^T (rotationStiffness phi + rotationDamping phidot),
/// where phidot = Y(phi) w_AB; Y is the identity for small phi, so that the elastic part has the energy
/// (d.K d + phi.K_r phi) / 2 at any phi.
struct Bushing {
  std::string name;
  int bodyA = kWorld;
  int bodyB = 0;
  Pose frame_A;            ///< in A's body frame (in the world if A is kWorld)
  Pose frame_B;            ///< in B's body frame
  Vec3d stiffness;         ///< along x, y, z [N/m], each >= 0
  Vec3d damping;           ///< along x, y, z [N s/m], each >= 0
  Vec3d rotationStiffness; ///< [N m/rad], each >= 0
  Vec3d rotationDamping;   ///< [N m s/rad], each >= 0
};

enum class DriveKind {
  kSpeed,    ///< imposes the rate of the axis by a constraint [rad/s] or [m/s]
  kPosition, ///< imposes its position over time, and the rate that belongs to it [rad] or [m]
  kForce,    ///< applies a torque [N m] or force [N] to B along +axis, the opposite to A
};

/// Drives a free axis of a revolute, prismatic or cylindrical. The force of a constraint is its multiplier: see
/// JointReading, driveForce() and drivePower() in state.hpp.
struct Drive {
  std::string name;
  int joint = 0;
  double speed = 0; ///< kSpeed without a law: at the start; Loads changes it in each step [rad/s] or [m/s]
  bool on = true;   ///< off: the axis is free
  JointAxis axis = JointAxis::kOnly;
  DriveKind kind = DriveKind::kSpeed;
  /// Speed, position or force over time. Empty: Loads gives speed or force in each step (a position needs a law). A
  /// speed law imposes its integral, position = start + integral of the law, so that no drift accumulates.
  TimeLaw law{};
};

/// Couples the positions of two axes (gears, belts, rack and pinion, screw):
///   position of axis 2 = ratio * position of axis 1 + offset.
/// The two joints may have up to four bodies; each reacts on its own two (a gear housing carries the difference).
struct Coupling {
  std::string name;
  int joint1 = 0;
  int joint2 = 0;
  double ratio = 1; ///< [-], [m/rad] (rack: radius; screw: lead / 2 pi) or [rad/m]; not 0
  JointAxis axis1 = JointAxis::kOnly;
  JointAxis axis2 = JointAxis::kOnly;
  double offset = std::numeric_limits<double>::quiet_NaN(); ///< [rad] or [m]; NaN: from the body poses
};

/// Number of parts of each kind.
struct PartCounts {
  std::size_t bodies{}, joints{}, axisSprings{}, pointSprings{}, bushings{}, drives{}, couplings{};
};

/// The mechanism. Every add... checks its arguments, throws PartError, and returns an index.
class Model {
public:
  int addBody(const Body& body);
  int addJoint(const Joint& joint);
  /// A joint whose two frames coincide at the start: `X_WJ` is the joint frame in the world, at the poses of the added
  /// bodies.
  int addJointAt(const std::string& name, JointType type, int bodyA, int bodyB, const Pose& X_WJ, double damping = 0);
  int addAxisSpring(const AxisSpring& spring);
  int addPointSpring(const PointSpring& spring);
  int addBushing(const Bushing& bushing);
  int addDrive(const Drive& drive);
  int addCoupling(const Coupling& coupling);
  /// Translates all bodies by `way` [m], and the world frames of joints, springs and bushings.
  void translate(const Vec3d& way);

  const std::vector<Body>& bodies() const { return bodies_; }
  const std::vector<Joint>& joints() const { return joints_; }
  const std::vector<AxisSpring>& axisSprings() const { return axisSprings_; }
  const std::vector<PointSpring>& pointSprings() const { return pointSprings_; }
  const std::vector<Bushing>& bushings() const { return bushings_; }
  const std::vector<Drive>& drives() const { return drives_; }
  const std::vector<Coupling>& couplings() const { return couplings_; }

  PartCounts counts() const;
  /// Adds the parts of `all` beyond `from`; before that `all` has the parts of this model, at other poses. Bodies of
  /// `moved` ([body of all]) move from the frame `X_from` to `X_to` with them.
  void append(const Model& all, const PartCounts& from, const std::vector<bool>& moved, const Pose& X_from,
              const Pose& X_to);

  /// Index by name; throws PartError if there is none.
  int bodyIndex(const std::string& name) const;
  int jointIndex(const std::string& name) const;
  /// "world" or the body's name.
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

/// Pose whose z axis points along `axis` (need not be a unit vector), x and y chosen perpendicular.
Pose frameWithZ(const Vec3d& position, const Vec3d& axis);
/// Pose with z along `z` and x along the part of `x` perpendicular to it.
Pose frameWithZX(const Vec3d& position, const Vec3d& z, const Vec3d& x);
/// Product of poses: X_WC = X_WB X_BC.
Pose compose(const Pose& X_WB, const Pose& X_BC);
/// X_BW of X_WB.
Pose inverse(const Pose& X_WB);

} // namespace grouser::multibody
