// SPDX-License-Identifier: BSD-3-Clause
#include "runs/mechanism_model.hpp"

#include "base/math.hpp"
#include "base/table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace grouser::runs {

using base::Mat3d;
using base::Pose;
using base::Quat;
using base::Vec3d;
using multibody::JointType;

namespace {

/// Frames given twice, once a body, must meet this well at the start [m, rad].
constexpr double kStartGap = 1e-6;
/// Quaternions are typed with a few digits: their length may be off 1 by this.
constexpr double kQuaternionLength = 1e-3;

std::string text(const Vec3d& v) { return fmt::format("({:.7g}, {:.7g}, {:.7g})", v.x, v.y, v.z); }

Quat orientationOf(const BodySection& b) {
  if (!b.orientation.empty()) {
    if (b.axis || b.angle)
      throw SectionFault("orientation", "stands beside axis and angle, which say the same; remove one of the two");
    if (b.orientation.size() != 4) throw SectionFault("orientation", "must have the four entries w, x, y, z");
    const Quat q{b.orientation[0], b.orientation[1], b.orientation[2], b.orientation[3]};
    const double length = std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
    if (!(std::fabs(length - 1) <= kQuaternionLength))
      throw SectionFault("orientation",
                         fmt::format("[-] has the length {:.6g}; give a unit quaternion w, x, y, z", length));
    return q.normalized();
  }
  if (!b.angle) {
    if (b.axis) throw SectionFault("axis", "[-] stands without angle; give both, or neither");
    return {};
  }
  if (!b.axis) throw SectionFault("angle", "[deg] stands without axis; give the axis of the turn, e.g. [0, 1, 0]");
  if (norm2(*b.axis) == 0) throw SectionFault("axis", "[-] is zero; give the axis of the turn, e.g. [0, 1, 0]");
  const double half = *b.angle * (base::kPi / 360);
  const Vec3d v = base::sin(half) * normalized(*b.axis);
  return Quat{base::cos(half), v.x, v.y, v.z}.normalized();
}

Mat3d inertiaOf(const BodySection& b) {
  const std::vector<double>& i = b.inertia;
  if (i.size() == 3) return Mat3d::diagonal({i[0], i[1], i[2]});
  if (i.size() == 6) return {{{i[0], i[3], i[4]}, {i[3], i[1], i[5]}, {i[4], i[5], i[2]}}};
  if (!i.empty())
    throw SectionFault("inertia", "[kg m2] must have 3 entries (xx, yy, zz) or 6 (then xy, xz, yz); give one of these");
  if (!b.box) throw SectionFault("inertia", "[kg m2] is missing; add it, or the edges of a box");
  const Vec3d e = *b.box;
  const double m = *b.mass / 12;
  return Mat3d::diagonal({m * (e.y * e.y + e.z * e.z), m * (e.x * e.x + e.z * e.z), m * (e.x * e.x + e.y * e.y)});
}

JointType typeOf(const std::string& word) {
  if (word == "revolute") return JointType::kRevolute;
  if (word == "spherical") return JointType::kSpherical;
  if (word == "universal") return JointType::kUniversal;
  if (word == "prismatic") return JointType::kPrismatic;
  if (word == "fixed") return JointType::kFixed;
  throw SectionFault("type", "is not possible so far; use another joint");
}

/// Where the two frames of a joint stand in the world.
struct Placed {
  Pose A, B;
};

/// A message of the model begins with the name of the part, then often with a key.
[[noreturn]] void hand(const base::InputError& error, const std::vector<std::string>& keys) {
  const std::string whole = error.what();
  const std::size_t colon = whole.find(": ");
  const std::string rest = colon == std::string::npos ? whole : whole.substr(colon + 2);
  for (const std::string& key : keys)
    if (rest.rfind(key, 0) == 0) {
      std::string message = rest.substr(key.size());
      message.erase(0, message.find_first_not_of(' '));
      throw SectionFault(key, message);
    }
  throw SectionFault("", rest);
}

/// Direction given for a key, not zero.
Vec3d direction(const char* key, const std::optional<Vec3d>& v) {
  if (!v) throw SectionFault(key, "[-] is missing, which this type of joint needs; add it, e.g. [0, 0, 1]");
  if (norm2(*v) == 0) throw SectionFault(key, "[-] is zero; give a direction, e.g. [0, 0, 1]");
  return normalized(*v);
}

bool hasAxis(const std::string& type) { return type != "spherical" && type != "fixed" && type != "distance"; }

/// Both frames from what is said in the world.
Placed placedInWorld(const JointSection& j) {
  for (const auto& [key, given] : {std::pair{"point_a", j.pointA.has_value()},
                                   {"point_b", j.pointB.has_value()},
                                   {"axis_a", j.axisA.has_value()},
                                   {"axis_b", j.axisB.has_value()}})
    if (given)
      throw SectionFault(key, "stands beside point; give point and axis in the world, or the four keys in the bodies");
  if (!hasAxis(j.type)) return {{*j.point, {}}, {*j.point, {}}};
  const Vec3d z = direction("axis", j.axis);
  Pose X = multibody::frameWithZ(*j.point, z);
  if (j.type == "universal") {
    const Vec3d x = direction("second_axis", j.secondAxis);
    if (std::fabs(dot(x, z)) > kStartGap)
      throw SectionFault("second_axis", fmt::format("[-] is {:.6g} rad off the right angle to axis; make them "
                                                    "perpendicular at the start",
                                                    std::fabs(dot(x, z))));
    X = multibody::frameWithZX(*j.point, z, x);
  }
  return {X, X};
}

/// Both frames from what is said in the bodies; they must meet.
Placed placedInBodies(const JointSection& j, const Pose& X_WA, const Pose& X_WB) {
  if (!j.pointA) throw SectionFault("point_a", "[m] is missing beside point_b; give both, or point in the world");
  if (!j.pointB) throw SectionFault("point_b", "[m] is missing beside point_a; give both, or point in the world");
  const Vec3d p_A = X_WA.toWorld(*j.pointA), p_B = X_WB.toWorld(*j.pointB);
  const auto apart = [&](const Vec3d& gap, const char* where) {
    if (!(norm(gap) <= kStartGap))
      throw SectionFault("point_b", fmt::format("[m] is at {} in the world at the start, {:.4g} m{} away from point_a "
                                                "at {}; allowed are {:g} m: correct the points or the bodies' places",
                                                text(p_B), norm(gap), where, text(p_A), kStartGap));
  };
  if (j.type == "distance") return {{p_A, X_WA.orientation}, {p_B, X_WB.orientation}};
  if (!hasAxis(j.type)) {
    apart(p_B - p_A, "");
    return {{p_A, X_WA.orientation}, {p_A, X_WA.orientation}};
  }
  const Vec3d z = rotate(X_WA.orientation, direction("axis_a", j.axisA));
  const Vec3d b = rotate(X_WB.orientation, direction("axis_b", j.axisB));
  if (j.type == "universal") {
    apart(p_B - p_A, "");
    if (std::fabs(dot(z, b)) > kStartGap)
      throw SectionFault("axis_b", fmt::format("[-] is {:.6g} rad off the right angle to axis_a at the start; make "
                                               "them perpendicular",
                                               std::fabs(dot(z, b))));
    const Pose X = multibody::frameWithZX(p_A, z, b);
    return {X, X};
  }
  if (!(norm(cross(z, b)) <= kStartGap && dot(z, b) > 0))
    throw SectionFault("axis_b", fmt::format("[-] points along {} in the world at the start, axis_a along {}: {:.4g} "
                                             "apart; turn a body or an axis so that they are parallel",
                                             text(b), text(z), norm(b - z)));
  const bool slides = j.type == "prismatic" || j.type == "cylindrical";
  const double slide = slides ? dot(p_B - p_A, z) : 0;
  apart(p_B - p_A - slide * z, slides ? " beside the axis" : "");
  const Pose X = multibody::frameWithZ(p_A, z);
  return {X, {p_A + slide * z, X.orientation}};
}

} // namespace

void MechanismBuilder::checkName(const std::string& kind, const std::string& name) {
  if (name.empty()) throw SectionFault("name", "is empty; every part needs a name");
  if (name == "world") throw SectionFault("name", "is the name of the ground; choose another");
  if (name.find_first_of("/.\",\n") != std::string::npos)
    throw SectionFault("name",
                       "has one of the characters / . , \" in it, which results use between names; leave it out");
  for (const auto& [k, n] : names_)
    if (k == kind && n == name)
      throw SectionFault("name", fmt::format("is the name of another {} too; make the names differ", kind));
  names_.emplace_back(kind, name);
}

int MechanismBuilder::body(const std::string& key, const std::string& name) const {
  if (name == "world") return multibody::kWorld;
  std::vector<std::string> known = {"world"};
  for (std::size_t i = 0; i < model_.bodies().size(); ++i) {
    if (model_.bodies()[i].name == name) return static_cast<int>(i);
    known.push_back(model_.bodies()[i].name);
  }
  throw SectionFault(key,
                     fmt::format("names no body \"{}\"; did you mean \"{}\"?", name, base::nearestWord(name, known)));
}

int MechanismBuilder::axisJoint(const std::string& key, const std::string& name) const {
  std::vector<std::string> known;
  for (std::size_t i = 0; i < model_.joints().size(); ++i) {
    const multibody::Joint& j = model_.joints()[i];
    if (j.name == name) {
      if (j.type == JointType::kRevolute || j.type == JointType::kPrismatic) return static_cast<int>(i);
      throw SectionFault(key, "has no single free axis; use a revolute or prismatic joint");
    }
    known.push_back(j.name);
  }
  throw SectionFault(key, known.empty()
                              ? "names no joint, for there is none; add a [[joint]]"
                              : fmt::format("names no joint; did you mean \"{}\"?", base::nearestWord(name, known)));
}

void MechanismBuilder::add(const BodySection& b) {
  checkName("body", b.name);
  multibody::Body body;
  body.name = b.name, body.fixed = b.fixed;
  body.pose = {b.position, orientationOf(b)};
  body.v_WB = b.velocity, body.w_WB = b.spin;
  if (!b.fixed) {
    if (!b.mass) throw SectionFault("mass", "[kg] is missing; add it, or set fixed = true");
    body.mass = *b.mass;
    body.inertia_B = inertiaOf(b);
  }
  try {
    model_.addBody(body);
  } catch (const SectionFault&) {
    throw;
  } catch (const base::InputError& error) {
    hand(error, {"inertia", "mass", "velocity"});
  }
}

void MechanismBuilder::add(const JointSection& j) {
  checkName("joint", j.name);
  if (j.bodies.size() != 2)
    throw SectionFault("bodies", "must name two bodies, e.g. [\"world\", \"rod\"]; correct the list");
  multibody::Joint joint;
  joint.name = j.name, joint.type = typeOf(j.type), joint.damping = j.damping;
  joint.bodyA = body("bodies", j.bodies[0]), joint.bodyB = body("bodies", j.bodies[1]);
  const auto pose = [&](int b) {
    return b == multibody::kWorld ? Pose{} : model_.bodies()[static_cast<std::size_t>(b)].pose;
  };
  if (j.secondAxis && j.type != "universal")
    throw SectionFault("second_axis", "has a meaning for a universal joint only; remove it");
  if (!j.point && !j.pointA && !j.pointB)
    throw SectionFault("point", "[m] is missing; add where the joint is at the start, or point_a and point_b");
  const Pose X_WA = pose(joint.bodyA), X_WB = pose(joint.bodyB);
  const Placed placed = j.point ? placedInWorld(j) : placedInBodies(j, X_WA, X_WB);
  joint.frame_A = multibody::compose(multibody::inverse(X_WA), placed.A);
  joint.frame_B = multibody::compose(multibody::inverse(X_WB), placed.B);
  if (j.limits && !(j.stopStiffness > 0))
    throw SectionFault("stop_stiffness", "[N m/rad or N/m] must be above 0 beside limits; add it");
  try {
    const int index = model_.addJoint(joint);
    if (!j.limits) return;
    multibody::AxisSpring stops;
    stops.name = j.name + " stops", stops.joint = index;
    stops.lowerLimit = (*j.limits)[0], stops.upperLimit = (*j.limits)[1];
    stops.stopStiffness = j.stopStiffness, stops.stopDamping = j.stopDamping;
    model_.addAxisSpring(stops);
  } catch (const SectionFault&) {
    throw;
  } catch (const base::InputError& error) {
    hand(error, {"damping"});
  }
}

void MechanismBuilder::add(const SpringSection& s) {
  checkName("spring", s.name);
  if (s.bodies.empty() == s.joint.empty())
    throw SectionFault(s.joint.empty() ? "" : "joint", s.joint.empty()
                                                           ? "has neither bodies nor joint; say where it acts"
                                                           : "stands beside bodies; a spring acts on one of the two");
  try {
    if (!s.joint.empty()) {
      if (s.pointA || s.pointB)
        throw SectionFault(s.pointA ? "point_a" : "point_b", "[m] has no meaning on the axis of a joint; remove it");
      multibody::AxisSpring spring;
      spring.name = s.name, spring.joint = axisJoint("joint", s.joint);
      spring.stiffness = s.stiffness, spring.damping = s.damping, spring.preload = s.preload;
      spring.freePosition = s.freePosition.value_or(0);
      model_.addAxisSpring(spring);
      return;
    }
    if (s.bodies.size() != 2)
      throw SectionFault("bodies", "must name two bodies, e.g. [\"world\", \"rod\"]; correct the list");
    multibody::PointSpring spring;
    spring.name = s.name;
    spring.bodyA = body("bodies", s.bodies[0]), spring.bodyB = body("bodies", s.bodies[1]);
    spring.point_A = s.pointA.value_or(Vec3d{}), spring.point_B = s.pointB.value_or(Vec3d{});
    spring.stiffness = s.stiffness, spring.damping = s.damping, spring.preload = s.preload;
    const auto place = [&](int b, const Vec3d& p) {
      return b == multibody::kWorld ? p : model_.bodies()[static_cast<std::size_t>(b)].pose.toWorld(p);
    };
    const double length = norm(place(spring.bodyB, spring.point_B) - place(spring.bodyA, spring.point_A));
    if (s.freePosition && *s.freePosition < 0)
      throw SectionFault("free_position", "[m] is a length here and must be at least 0; correct it");
    if (!(length > 0))
      throw SectionFault("point_b", "[m] is at the same place as point_a at the start, so that the spring has no "
                                    "direction; move one of them");
    spring.restLength = s.freePosition.value_or(length);
    model_.addPointSpring(spring);
  } catch (const SectionFault&) {
    throw;
  } catch (const base::InputError& error) {
    hand(error, {"stiffness", "damping", "preload"});
  }
}

void MechanismBuilder::add(const DriveSection& d) {
  checkName("drive", d.name);
  multibody::Drive drive;
  drive.name = d.name, drive.joint = axisJoint("joint", d.joint);
  if (d.value.has_value() == !d.time.empty())
    throw SectionFault(d.value ? "value" : "", d.value ? "stands beside time; keep one of value, and time with values"
                                                       : "lacks value, or time with values; add one of them");
  if (d.values.size() != d.time.size())
    throw SectionFault("values",
                       fmt::format("has another length than time, which has {}; make them alike", d.time.size()));
  for (std::size_t i = 1; i < d.time.size(); ++i)
    if (!(d.time[i] > d.time[i - 1]))
      throw SectionFault("time", fmt::format("[s] does not increase at entry {}; sort it", i));
  if (d.imposes != "speed") throw SectionFault("imposes", "is not possible so far; use \"speed\"");
  for (const multibody::Drive& other : model_.drives())
    if (other.joint == drive.joint)
      throw SectionFault("joint", fmt::format("is driven by \"{}\" already, and two drives contradict each other; "
                                              "remove one",
                                              other.name));
  drive.speed = driveValue(d, 0);
  try {
    model_.addDrive(drive);
  } catch (const base::InputError& error) {
    hand(error, {"speed"});
  }
}

multibody::Model buildModel(const MechanismSections& sections) {
  MechanismBuilder builder;
  for (const BodySection& s : sections.bodies) builder.add(s);
  for (const JointSection& s : sections.joints) builder.add(s);
  for (const SpringSection& s : sections.springs) builder.add(s);
  for (const DriveSection& s : sections.drives) builder.add(s);
  return builder.model();
}

double driveValue(const DriveSection& d, double t) {
  if (d.time.empty()) return d.value.value_or(0);
  if (t <= d.time.front()) return d.values.front();
  if (t >= d.time.back()) return d.values.back();
  const auto later = static_cast<std::size_t>(std::upper_bound(d.time.begin(), d.time.end(), t) - d.time.begin());
  const double t0 = d.time[later - 1], t1 = d.time[later];
  return d.values[later - 1] + (d.values[later] - d.values[later - 1]) * ((t - t0) / (t1 - t0));
}

} // namespace grouser::runs
