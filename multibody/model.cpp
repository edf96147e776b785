// SPDX-License-Identifier: BSD-3-Clause
#include "multibody/model.hpp"

#include "multibody/part_error.hpp"

#include "base/error.hpp"
#include "multibody/detail/rotation.hpp"

#include <Eigen/Eigenvalues>

#include <cmath>
#include <sstream>

namespace grouser::multibody {

namespace {

const std::string kWorldName = "world";

[[noreturn]] void refuse(const PartName& part, const char* key, const std::string& fault) {
  throw PartError(part, key, fault);
}
[[noreturn]] void refuse(const PartName& part, const std::string& fault) { refuse(part, "", fault); }

std::string text(double x) {
  std::ostringstream out;
  out.precision(9);
  out << x;
  return out.str();
}

bool finite(const Vec3d& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

/// Throws unless x is finite and >= 0.
void checkNotNegative(const PartName& what, const char* key, double x, const char* unit) {
  if (!(std::isfinite(x) && x >= 0)) refuse(what, key, "= " + text(x) + " [" + unit + "] must be finite and >= 0");
}

void checkFinite(const PartName& what, const char* key, double x) {
  if (!std::isfinite(x)) refuse(what, key, "is not a finite number");
}

void checkPose(const PartName& what, const char* key, const Pose& X) {
  const Quat& q = X.orientation;
  const double n = q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z;
  if (!finite(X.position) || !(std::fabs(n - 1) < 1e-9))
    refuse(what, key, "requires a finite position and a unit quaternion (squared norm " + text(n) + "); normalise it");
}

/// Principal moments of a symmetric inertia as text, such as "1, 2, 3".
std::string principalMoments(const Mat3d& I) {
  Eigen::Matrix3d matrix;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) matrix(i, j) = I.m[i][j];
  const Eigen::Vector3d moments =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(matrix, Eigen::EigenvaluesOnly).eigenvalues();
  return text(moments[0]) + ", " + text(moments[1]) + ", " + text(moments[2]);
}

/// True if all leading minors are positive, i.e. the symmetric matrix is positive definite (Sylvester).
bool positiveDefinite(const Mat3d& a) {
  const double d1 = a.m[0][0];
  const double d2 = a.m[0][0] * a.m[1][1] - a.m[0][1] * a.m[1][0];
  const double d3 = a.m[0][0] * (a.m[1][1] * a.m[2][2] - a.m[1][2] * a.m[2][1]) -
                    a.m[0][1] * (a.m[1][0] * a.m[2][2] - a.m[1][2] * a.m[2][0]) +
                    a.m[0][2] * (a.m[1][0] * a.m[2][1] - a.m[1][1] * a.m[2][0]);
  return d1 > 0 && d2 > 0 && d3 > 0;
}

void checkInertia(const PartName& what, const Mat3d& I) {
  const double trace = I.m[0][0] + I.m[1][1] + I.m[2][2];
  for (const auto& row : I.m)
    for (const double x : row) checkFinite(what, "inertia", x);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < i; ++j)
      if (std::fabs(I.m[i][j] - I.m[j][i]) > 1e-9 * std::fabs(trace))
        refuse(what, "inertia",
               "[kg m2] is not symmetric: entries (" + std::to_string(i) + ", " + std::to_string(j) +
                   ") = " + text(I.m[i][j]) + " and " + text(I.m[j][i]) + " must be equal");
  if (!positiveDefinite(I))
    refuse(what, "inertia",
           "[kg m2] is not positive definite; every principal moment must be > 0, but they are " + principalMoments(I));
  // Triangle inequality in any axes: the second moment of mass, tr(I)/2 - I, has no negative eigenvalue. For a flat
  // plate one eigenvalue is zero; the allowance of 1e-9 covers its round-off.
  Mat3d second;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) second.m[i][j] = (i == j ? (0.5 + 1e-9) * trace : 0) - I.m[i][j];
  if (!positiveDefinite(second))
    refuse(what, "inertia",
           "[kg m2] violates the triangle inequality: no principal moment may exceed the sum of the other "
           "two, but they are " +
               principalMoments(I) + "; correct the entries");
}

Vec3d perpendicularTo(const Vec3d& z) {
  // The cross product with the coordinate axis least aligned with z is best conditioned.
  const double ax = std::fabs(z.x), ay = std::fabs(z.y), az = std::fabs(z.z);
  const Vec3d e = ax <= ay && ax <= az ? Vec3d{1, 0, 0} : ay <= az ? Vec3d{0, 1, 0} : Vec3d{0, 0, 1};
  return normalized(e - z * dot(e, z));
}

template <class Named>
int indexByName(const std::vector<Named>& parts, const std::string& kind, const std::string& name) {
  for (std::size_t i = 0; i < parts.size(); ++i)
    if (parts[i].name == name) return static_cast<int>(i);
  refuse({kind, name}, "does not exist");
}

template <class Named>
void checkName(const std::vector<Named>& parts, const std::string& kind, const std::string& name) {
  if (name.empty()) refuse({kind + " " + std::to_string(parts.size()), ""}, "has no name; every part needs one");
  for (const auto& part : parts)
    if (part.name == name) refuse({kind, name}, "duplicate name; choose another");
}

} // namespace

int Model::addBody(const Body& body) {
  const PartName what{"body", body.name};
  checkName(bodies_, "body", body.name);
  checkPose(what, "pose", body.pose);
  if (!finite(body.v_WB) || !finite(body.w_WB)) refuse(what, "velocity", "is not finite");
  if (body.point && (body.fixed || !(body.w_WB == Vec3d{})))
    refuse(what, "is a point body, which cannot be fixed or rotate; set an inertia, or remove fixed and rotation");
  if (!body.fixed) {
    if (!(std::isfinite(body.mass) && body.mass > 0))
      refuse(what, "mass", "= " + text(body.mass) + " [kg] must be > 0");
    if (!body.point) checkInertia(what, body.inertia_B);
  } else if (!(body.v_WB == Vec3d{}) || !(body.w_WB == Vec3d{})) {
    refuse(what, "is fixed, but has a velocity; remove one of the two");
  }
  bodies_.push_back(body);
  bodies_.back().pose.orientation = body.pose.orientation.normalized();
  // A point body never rotates; a radius of gyration of 1 m scales its equations well.
  if (body.point) bodies_.back().inertia_B = Mat3d::diagonal({body.mass, body.mass, body.mass});
  return static_cast<int>(bodies_.size()) - 1;
}

void Model::checkBodies(const PartName& what, int bodyA, int bodyB) const {
  const int count = static_cast<int>(bodies_.size());
  for (const int b : {bodyA, bodyB})
    if (b < kWorld || b >= count)
      refuse(what, "body index " + std::to_string(b) + " is outside [-1, " + std::to_string(count - 1) +
                       "] (-1 is the world); add the body first");
  if (bodyA == bodyB) refuse(what, "joins '" + bodyName(bodyA) + "' to itself; name two different bodies");
  const auto immovable = [&](int b) { return b == kWorld || bodies_[static_cast<std::size_t>(b)].fixed; };
  if (immovable(bodyA) && immovable(bodyB))
    refuse(what, "both '" + bodyName(bodyA) + "' and '" + bodyName(bodyB) + "' are fixed; remove this element");
}

/// Resolves kOnly to the only axis.
void Model::checkAxis(const PartName& what, int joint, JointAxis& axis) const {
  if (joint < 0 || joint >= static_cast<int>(joints_.size()))
    refuse(what, "joint index " + std::to_string(joint) + " is outside [0, " + std::to_string(joints_.size()) + ")");
  const Joint& j = joints_[static_cast<std::size_t>(joint)];
  const bool turns = j.type == JointType::kRevolute || j.type == JointType::kCylindrical;
  const bool slides = j.type == JointType::kPrismatic || j.type == JointType::kCylindrical;
  if (!turns && !slides)
    refuse(what, "joint '" + j.name + "' has no single free axis; use a revolute, prismatic or cylindrical joint");
  if (turns && slides && axis == JointAxis::kOnly)
    refuse(what, "joint '" + j.name + "' is cylindrical and has two free axes; specify angle or slide");
  if ((axis == JointAxis::kAngle && !turns) || (axis == JointAxis::kSlide && !slides))
    refuse(what, "joint '" + j.name + "' has no free " +
                     (turns ? "slide; its axis is an angle" : "angle; its axis is a slide"));
  if (axis == JointAxis::kOnly) axis = turns ? JointAxis::kAngle : JointAxis::kSlide;
}

void Model::checkPoint(const PartName& what, int body, const Vec3d& point_B, bool mayTurnFreely) const {
  if (body == kWorld || !bodies_[static_cast<std::size_t>(body)].point) return;
  if (!mayTurnFreely || !(point_B == Vec3d{}))
    refuse(what, "'" + bodyName(body) +
                     "' is a point body: only spherical joints, distance joints and point springs may "
                     "attach to it, at its own origin; set an inertia for other elements");
}

int Model::addJoint(const Joint& given) {
  Joint joint = given;
  const PartName what{"joint", joint.name};
  checkName(joints_, "joint", joint.name);
  checkBodies(what, joint.bodyA, joint.bodyB);
  checkPose(what, "frame_A", joint.frame_A);
  checkPose(what, "frame_B", joint.frame_B);
  checkNotNegative(what, "damping", joint.damping, "N m s/rad or N s/m");
  checkNotNegative(what, "slideDamping", joint.slideDamping, "N s/m");
  checkNotNegative(what, "length", joint.length, "m");
  const bool cylindrical = joint.type == JointType::kCylindrical, rod = joint.type == JointType::kDistance;
  const bool axis = joint.type == JointType::kRevolute || joint.type == JointType::kPrismatic || cylindrical;
  if (joint.damping > 0 && !axis)
    refuse(what, "damping", "acts on the free axis of a revolute, prismatic or cylindrical joint; set it to 0 here");
  if (joint.slideDamping > 0 && !cylindrical)
    refuse(what, "slideDamping", "acts on the slide of a cylindrical joint; set it to 0 here");
  if (joint.length > 0 && !rod) refuse(what, "length", "belongs to a distance joint; set it to 0 here");
  const bool ball = rod || joint.type == JointType::kSpherical;
  checkPoint(what, joint.bodyA, joint.frame_A.position, ball);
  checkPoint(what, joint.bodyB, joint.frame_B.position, ball);
  if (rod && joint.length == 0) {
    const auto placed = [&](int b, const Vec3d& p) {
      return b == kWorld ? p : bodies_[static_cast<std::size_t>(b)].pose.toWorld(p);
    };
    joint.length = norm(placed(joint.bodyB, joint.frame_B.position) - placed(joint.bodyA, joint.frame_A.position));
    if (!(joint.length > 1e-9))
      refuse(what, "its two points coincide, but a rod requires a length > 0; use a spherical joint");
  }
  joints_.push_back(joint);
  return static_cast<int>(joints_.size()) - 1;
}

int Model::addJointAt(const std::string& name, JointType type, int bodyA, int bodyB, const Pose& X_WJ, double damping) {
  checkBodies({"joint", name}, bodyA, bodyB);
  const auto inBody = [&](int b) {
    return b == kWorld ? X_WJ : compose(inverse(bodies_[static_cast<std::size_t>(b)].pose), X_WJ);
  };
  return addJoint({name, type, bodyA, bodyB, inBody(bodyA), inBody(bodyB), damping});
}

int Model::addAxisSpring(const AxisSpring& s) {
  const PartName what{"spring", s.name};
  checkName(axisSprings_, "spring", s.name);
  AxisSpring spring = s;
  checkAxis(what, s.joint, spring.axis);
  checkNotNegative(what, "stiffness", s.stiffness, "N/m or N m/rad");
  checkNotNegative(what, "damping", s.damping, "N s/m or N m s/rad");
  checkNotNegative(what, "stopStiffness", s.stopStiffness, "N/m or N m/rad");
  checkNotNegative(what, "stopDamping", s.stopDamping, "N s/m or N m s/rad");
  checkFinite(what, "freePosition", s.freePosition);
  checkFinite(what, "preload", s.preload);
  if (!(s.lowerLimit < s.upperLimit))
    refuse(what, "lowerLimit = " + text(s.lowerLimit) + " must be below upperLimit = " + text(s.upperLimit));
  if ((std::isfinite(s.lowerLimit) || std::isfinite(s.upperLimit)) && !(s.stopStiffness > 0))
    refuse(what, "has end stops, but stopStiffness = 0; set it > 0");
  axisSprings_.push_back(spring);
  return static_cast<int>(axisSprings_.size()) - 1;
}

int Model::addPointSpring(const PointSpring& s) {
  const PartName what{"spring", s.name};
  checkName(pointSprings_, "spring", s.name);
  checkBodies(what, s.bodyA, s.bodyB);
  checkNotNegative(what, "stiffness", s.stiffness, "N/m");
  checkNotNegative(what, "damping", s.damping, "N s/m");
  checkNotNegative(what, "restLength", s.restLength, "m");
  checkFinite(what, "preload", s.preload);
  if (!finite(s.point_A) || !finite(s.point_B)) refuse(what, "its points are not finite");
  checkPoint(what, s.bodyA, s.point_A, true);
  checkPoint(what, s.bodyB, s.point_B, true);
  pointSprings_.push_back(s);
  return static_cast<int>(pointSprings_.size()) - 1;
}

int Model::addBushing(const Bushing& bushing) {
  const PartName what{"bushing", bushing.name};
  checkName(bushings_, "bushing", bushing.name);
  checkBodies(what, bushing.bodyA, bushing.bodyB);
  checkPose(what, "frame_A", bushing.frame_A);
  checkPose(what, "frame_B", bushing.frame_B);
  for (int i = 0; i < 3; ++i) {
    checkNotNegative(what, "stiffness", bushing.stiffness[i], "N/m");
    checkNotNegative(what, "damping", bushing.damping[i], "N s/m");
    checkNotNegative(what, "rotationStiffness", bushing.rotationStiffness[i], "N m/rad");
    checkNotNegative(what, "rotationDamping", bushing.rotationDamping[i], "N m s/rad");
  }
  checkPoint(what, bushing.bodyA, {}, false);
  checkPoint(what, bushing.bodyB, {}, false);
  bushings_.push_back(bushing);
  return static_cast<int>(bushings_.size()) - 1;
}

int Model::addDrive(const Drive& given) {
  Drive drive = given;
  const PartName what{"drive", drive.name};
  checkName(drives_, "drive", drive.name);
  checkAxis(what, drive.joint, drive.axis);
  checkFinite(what, "speed", drive.speed);
  if (const std::string fault = timeLawFault(drive.law); !fault.empty()) refuse(what, fault);
  if (drive.kind == DriveKind::kPosition && drive.law.empty())
    refuse(what, "imposes a position, but has no law; set a law for the position over time");
  if (drive.kind == DriveKind::kPosition && !drive.law.ramps.times.empty())
    refuse(what, "ramps of a position cause jumps in speed; use a table, polynomial or harmonics");
  if (drive.kind != DriveKind::kForce)
    for (const Drive& other : drives_)
      if (other.joint == drive.joint && other.axis == drive.axis && other.kind != DriveKind::kForce)
        refuse(what, "its axis is already driven by '" + other.name + "'; remove one of the two");
  drives_.push_back(drive);
  return static_cast<int>(drives_.size()) - 1;
}

int Model::addCoupling(const Coupling& given) {
  Coupling coupling = given;
  const PartName what{"coupling", coupling.name};
  checkName(couplings_, "coupling", coupling.name);
  checkAxis(what, coupling.joint1, coupling.axis1);
  checkAxis(what, coupling.joint2, coupling.axis2);
  if (coupling.joint1 == coupling.joint2 && coupling.axis1 == coupling.axis2)
    refuse(what, "couples an axis of joint '" + joints_[static_cast<std::size_t>(coupling.joint1)].name +
                     "' to itself; name two different axes");
  if (!(std::isfinite(coupling.ratio) && coupling.ratio != 0))
    refuse(what, "ratio", "= " + text(coupling.ratio) + " must be finite and not 0");
  if (std::isinf(coupling.offset)) refuse(what, "offset", "is infinite");
  couplings_.push_back(coupling);
  return static_cast<int>(couplings_.size()) - 1;
}

PartCounts Model::counts() const {
  return {bodies_.size(),   joints_.size(), axisSprings_.size(), pointSprings_.size(),
          bushings_.size(), drives_.size(), couplings_.size()};
}

void Model::append(const Model& all, const PartCounts& from, const std::vector<bool>& moved, const Pose& X_from,
                   const Pose& X_to) {
  const auto add = [](const auto& parts, std::size_t first, const auto& addOne) {
    for (std::size_t i = first; i < parts.size(); ++i) addOne(i, parts[i]);
  };
  add(all.bodies(), from.bodies, [&](std::size_t i, Body body) {
    if (moved[i]) {
      const Quat turn = X_to.orientation * X_from.orientation.conjugate();
      body.pose = compose(X_to, compose(inverse(X_from), body.pose));
      body.v_WB = rotate(turn, body.v_WB), body.w_WB = rotate(turn, body.w_WB);
    }
    addBody(body);
  });
  add(all.joints(), from.joints, [&](std::size_t, const Joint& joint) { addJoint(joint); });
  add(all.axisSprings(), from.axisSprings, [&](std::size_t, const AxisSpring& spring) { addAxisSpring(spring); });
  add(all.pointSprings(), from.pointSprings, [&](std::size_t, const PointSpring& spring) { addPointSpring(spring); });
  add(all.bushings(), from.bushings, [&](std::size_t, const Bushing& bushing) { addBushing(bushing); });
  add(all.drives(), from.drives, [&](std::size_t, const Drive& drive) { addDrive(drive); });
  add(all.couplings(), from.couplings, [&](std::size_t, const Coupling& coupling) { addCoupling(coupling); });
}

void Model::translate(const Vec3d& way) {
  for (Body& body : bodies_) body.pose.position += way;
  const auto hold = [&](int body, Vec3d& point) {
    if (body == kWorld) point += way;
  };
  for (Joint& j : joints_) hold(j.bodyA, j.frame_A.position), hold(j.bodyB, j.frame_B.position);
  for (PointSpring& s : pointSprings_) hold(s.bodyA, s.point_A), hold(s.bodyB, s.point_B);
  for (Bushing& b : bushings_) hold(b.bodyA, b.frame_A.position), hold(b.bodyB, b.frame_B.position);
}

int Model::bodyIndex(const std::string& name) const { return indexByName(bodies_, "body", name); }
int Model::jointIndex(const std::string& name) const { return indexByName(joints_, "joint", name); }

const std::string& Model::bodyName(int body) const {
  return body == kWorld ? kWorldName : bodies_.at(static_cast<std::size_t>(body)).name;
}

Pose frameWithZ(const Vec3d& position, const Vec3d& axis) {
  const Vec3d z = normalized(axis), x = perpendicularTo(z);
  return {position, detail::quaternionOf(x, cross(z, x), z)};
}

Pose frameWithZX(const Vec3d& position, const Vec3d& axis, const Vec3d& along) {
  const Vec3d z = normalized(axis), x = normalized(along - z * dot(along, z));
  return {position, detail::quaternionOf(x, cross(z, x), z)};
}

Pose compose(const Pose& X_WB, const Pose& X_BC) {
  return {X_WB.toWorld(X_BC.position), (X_WB.orientation * X_BC.orientation).normalized()};
}

Pose inverse(const Pose& X_WB) {
  return {-transposedTimes(X_WB.orientation.matrix(), X_WB.position), X_WB.orientation.conjugate()};
}

} // namespace grouser::multibody
