// SPDX-License-Identifier: BSD-3-Clause
#include "runs/setup/mechanism_model.hpp"

#include "base/math.hpp"
#include "base/name_fault.hpp"
#include "base/table.hpp"
#include "multibody/part_error.hpp"
#include "runs/setup/body_mass.hpp"
#include "runs/setup/mechanism_frames.hpp"
#include "runs/support/orientation.hpp"
#include "spheredecomp/shells.hpp"
#include "vehicle/assembly.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>
#include <utility>

namespace grouser::setup {

using base::Mat3d;
using base::Pose;
using base::Vec3d;
using multibody::JointAxis;
using multibody::JointType;

namespace {

/// Permitted offset of the centre of the shapes from the origin of the body's frame (the centre of mass), relative to
/// the body's size [-]; positions are typed with a few digits.
constexpr double kCentred = 1e-3;

/// Rejects a mesh whose moments are not those of its solid.
void checkShells(const scene::ShapeSection& shape, std::size_t number) {
  const std::optional<spheredecomp::ShellFault> fault = spheredecomp::shellFault(*shape.loaded.query);
  if (!fault) return;
  const bool inverted = fault->kind == spheredecomp::ShellFault::Kind::inverted;
  const Vec3d at = fault->place + shape.loaded.middle;
  throw support::SectionFault(
      "",
      fmt::format("has {} in the mesh of shape.{}, e.g. at ({:.4g}, {:.4g}, {:.4g}) m in the frame of the file "
                  "({:.2g} % of its surface), so mass and inertia would count {}; {}, or set mass and inertia",
                  inverted ? "a shell with inward faces outside all others" : "overlapping, nested or repeated shells",
                  number, at.x, at.y, at.z, 100 * fault->share,
                  inverted ? "its volume as negative" : "their common volume more than once",
                  inverted ? "flip the faces of this shell"
                           : "merge the shells (Boolean union in a mesh editor), delete a repeated shell, reverse "
                             "the inner shell of a hollow mesh"));
}

/// Volume, centre and inertia of the shapes at unit density.
SolidMoments shapesMoments(const scene::BodySection& b) {
  for (std::size_t k = 0; k < b.shapes.size(); ++k)
    if (b.shapes[k].loaded.query) checkShells(b.shapes[k], k);
  const SolidMoments m = momentsOf(b);
  double size = 0;
  for (const scene::ShapeSection& s : b.shapes)
    size = std::max(size, norm(s.position) + norm(halfExtent(geometryOf(s))));
  if (norm(m.centre) > kCentred * size)
    throw support::SectionFault(
        "", fmt::format("has its centre of mass at [{0:.6g}, {1:.6g}, {2:.6g}] m in the body frame, but it must be at "
                        "the origin; subtract this vector from shape.position of each shape and add it to position of "
                        "the body, or set mass and inertia",
                        m.centre.x, m.centre.y, m.centre.z));
  return m;
}

/// `moments`: moments of the shapes if mass or inertia depends on them; otherwise of zero volume.
Mat3d inertiaOf(const scene::BodySection& b, const SolidMoments& moments, double mass) {
  const std::vector<double>& i = b.inertia;
  if (i.size() == 3) return Mat3d::diagonal({i[0], i[1], i[2]});
  if (i.size() == 6) return {{{i[0], i[3], i[4]}, {i[3], i[1], i[5]}, {i[4], i[5], i[2]}}};
  if (!i.empty())
    throw support::SectionFault(
        "inertia", "[kg m2] must have 3 entries (xx, yy, zz) or 6 (xx, yy, zz, xy, xz, yz); correct the list");
  if (!b.box && moments.volume > 0) {
    Mat3d inertia = moments.inertia;
    for (auto& row : inertia.m)
      for (double& entry : row) entry *= mass / moments.volume;
    return inertia;
  }
  if (!b.box) throw support::SectionFault("inertia", "[kg m2] is missing; add it, or box (edge lengths)");
  const Vec3d e = *b.box;
  const double m = mass / 12;
  return Mat3d::diagonal({m * (e.y * e.y + e.z * e.z), m * (e.x * e.x + e.z * e.z), m * (e.x * e.x + e.y * e.y)});
}

/// Sum of all terms of a drive, as a function of time.
multibody::TimeLaw lawOf(const scene::DriveSection& d) {
  multibody::TimeLaw law;
  law.polynomial = d.polynomial;
  if (d.value) law.polynomial = {*d.value};
  if (d.value && !d.polynomial.empty())
    throw support::SectionFault("polynomial", "is mutually exclusive with value, which is its first entry; remove one");
  if (d.amplitude != 0) {
    if (!(d.frequency > 0))
      throw support::SectionFault("frequency", "[Hz] must be above 0 if amplitude is set; set it");
    law.harmonics.push_back({d.amplitude, 2 * base::kPi * d.frequency, d.phase * (base::kPi / 180)});
  }
  if (d.values.size() != d.time.size())
    throw support::SectionFault(
        "values", fmt::format("must have as many entries as time ({}); correct the lists", d.time.size()));
  if (d.time.size() == 1) throw support::SectionFault("time", "[s] has only one entry; set at least two, or use value");
  const bool jumps = d.imposes != multibody::DriveKind::kPosition;
  if (const std::size_t i = multibody::firstOutOfOrder(d.time, jumps); i > 0)
    throw support::SectionFault("time",
                                fmt::format("[s] must increase, but does not at entry {}; sort the list{}", i,
                                            !jumps && d.time[i] == d.time[i - 1] ? " (a position cannot jump)" : ""));
  // A position needs a smooth table: a kink would be an impact.
  (d.imposes == multibody::DriveKind::kPosition ? law.table : law.ramps) = {d.time, d.values};
  if (law.empty())
    throw support::SectionFault("", "has no value; set value, polynomial, amplitude, or time with values");
  return law;
}

/// Adds an element to the model. An error of the model becomes a SectionFault, at the key of the error if `keys`
/// contains it.
template <class Add> int addChecked(const std::vector<std::string>& keys, Add add) {
  try {
    return add();
  } catch (const multibody::PartError& error) {
    if (std::find(keys.begin(), keys.end(), error.key()) != keys.end())
      throw support::SectionFault(error.key(), error.fault());
    throw support::SectionFault("", error.text());
  }
}

void setStops(multibody::AxisSpring& spring, const std::array<double, 2>& limits, double stiffness, double damping) {
  if (!(limits[0] < limits[1]))
    throw support::SectionFault("limits", "[rad or m] must be [min, max] with min < max; swap them");
  if (!(stiffness > 0))
    throw support::SectionFault("stop_stiffness", "[N m/rad or N/m] must be above 0 if limits is set; set it");
  spring.lowerLimit = limits[0], spring.upperLimit = limits[1];
  spring.stopStiffness = stiffness, spring.stopDamping = damping;
}

} // namespace

MechanismBuilder::MechanismBuilder(const vehicle::Assembly& vehicle) : model_(vehicle.model) {
  for (const multibody::Body& body : model_.bodies()) names_.insert("body " + body.name);
  bodies_["vehicle"] = vehicle.chassis, names_.insert("body vehicle");
}

void MechanismBuilder::checkName(const std::string& kind, const std::string& name) {
  if (name == "world") throw support::SectionFault("name", "is reserved for the ground; choose another name");
  if (const std::string fault = base::nameFault(name); !fault.empty()) throw support::SectionFault("name", fault);
  if (name.find_first_of(".\",") != std::string::npos)
    throw support::SectionFault("name", "must not contain . , or \", which separate names in results; remove them");
  if (!names_.insert(kind + " " + name).second)
    throw support::SectionFault("name", fmt::format("is also the name of another {}; choose another name", kind));
}

int MechanismBuilder::body(const std::string& key, const std::string& name) const {
  if (name == "world") return multibody::kWorld;
  if (const auto found = bodies_.find(name); found != bodies_.end()) return found->second;
  std::vector<std::string> known = {"world"};
  for (const auto& [body, index] : bodies_) known.push_back(body);
  // Other words for the vehicle and the ground, which resemble neither name.
  constexpr std::pair<const char*, const char*> kOtherWords[] = {
      {"chassis", "vehicle"}, {"hull", "vehicle"},  {"tank", "vehicle"}, {"tractor", "vehicle"}, {"robot", "vehicle"},
      {"ground", "world"},    {"terrain", "world"}, {"earth", "world"},  {"fixed", "world"}};
  std::string nearest = base::nearestWord(name, known);
  for (const auto& [word, meant] : kOtherWords)
    if (name == word && std::find(known.begin(), known.end(), meant) != known.end()) nearest = meant;
  throw support::SectionFault(key, fmt::format("refers to an unknown body \"{}\"; did you mean \"{}\"? (bodies: {})",
                                               name, nearest, fmt::join(known, ", ")));
}

std::pair<int, int> MechanismBuilder::twoBodies(const std::vector<std::string>& names) const {
  if (names.size() != 2)
    throw support::SectionFault("bodies", "must name two bodies, e.g. [\"world\", \"rod\"]; correct the list");
  return {body("bodies", names[0]), body("bodies", names[1])};
}

int MechanismBuilder::joint(const std::string& key, const std::string& name) const {
  if (const auto found = joints_.find(name); found != joints_.end()) return found->second;
  std::vector<std::string> known;
  for (const auto& [joint, index] : joints_) known.push_back(joint);
  throw support::SectionFault(key, known.empty()
                                       ? "requires a joint; add a [[joint]]"
                                       : fmt::format("refers to an unknown joint \"{}\"; did you mean \"{}\"?", name,
                                                     base::nearestWord(name, known)));
}

JointAxis MechanismBuilder::axis(int index, const std::string& key, std::optional<JointAxis> named) const {
  const multibody::Joint& j = model_.joints()[static_cast<std::size_t>(index)];
  const bool turns = j.type == JointType::kRevolute || j.type == JointType::kCylindrical;
  const bool slides = j.type == JointType::kPrismatic || j.type == JointType::kCylindrical;
  if (!turns && !slides)
    throw support::SectionFault(
        "", fmt::format("requires an axis, but joint \"{}\" has none; use a revolute, prismatic or cylindrical joint",
                        j.name));
  if (!named) {
    if (turns && slides)
      throw support::SectionFault(
          key, fmt::format("is missing, but joint \"{}\" has two axes; add {} = \"angle\" or \"slide\"", j.name, key));
    return turns ? JointAxis::kAngle : JointAxis::kSlide;
  }
  if (*named == JointAxis::kAngle ? !turns : !slides)
    throw support::SectionFault(
        key, fmt::format("is not free in joint \"{}\"; use \"{}\"", j.name, turns ? "angle" : "slide"));
  return *named;
}

Pose MechanismBuilder::pose(int index) const {
  return index == multibody::kWorld ? Pose{} : model_.bodies()[static_cast<std::size_t>(index)].pose;
}

void MechanismBuilder::add(const scene::BodySection& b) {
  checkName("body", b.name);
  multibody::Body body;
  body.name = b.name, body.fixed = b.fixed, body.point = b.point;
  body.pose = {b.position, support::orientationOf(b.axis, b.angle, b.orientation)};
  body.v_WB = b.velocity, body.w_WB = b.spin;
  if (!b.fixed) {
    if (!b.mass && !b.density) throw support::SectionFault("mass", "[kg] is missing; add it, or set fixed = true");
    const bool fromShapes = !b.shapes.empty() && (!b.mass || (b.inertia.empty() && !b.box));
    const SolidMoments moments = fromShapes ? shapesMoments(b) : SolidMoments{};
    body.mass = b.mass ? *b.mass : *b.density * moments.volume;
    if (b.point && !b.inertia.empty())
      throw support::SectionFault("inertia", "[kg m2] is mutually exclusive with point = true; remove one");
    if (!b.point) body.inertia_B = inertiaOf(b, moments, body.mass);
  }
  bodies_[b.name] = addChecked({"inertia", "mass", "velocity", "point"}, [&] { return model_.addBody(body); });
}

void MechanismBuilder::add(const scene::JointSection& j) {
  checkName("joint", j.name);
  multibody::Joint joint;
  joint.name = j.name, joint.type = j.type;
  joint.damping = j.damping, joint.slideDamping = j.slideDamping, joint.length = j.length.value_or(0);
  std::tie(joint.bodyA, joint.bodyB) = twoBodies(j.bodies);
  const Pose X_WA = pose(joint.bodyA), X_WB = pose(joint.bodyB);
  const JointFrames placed = placeJoint(j, X_WA, X_WB);
  joint.frame_A = multibody::compose(multibody::inverse(X_WA), placed.A);
  joint.frame_B = multibody::compose(multibody::inverse(X_WB), placed.B);
  if (j.type == JointType::kDistance) {
    // Uses exactly the given points.
    joint.frame_A.position = j.pointA.value_or(Vec3d{}), joint.frame_B.position = j.pointB.value_or(Vec3d{});
    const double apart = norm(placed.B.position - placed.A.position);
    if (j.length && !(std::fabs(apart - *j.length) <= 1e-6 * *j.length))
      throw support::SectionFault("length", fmt::format("[m] differs from the initial distance of the points, {:.9g} "
                                                        "m; correct it or the positions of the bodies, or remove it",
                                                        apart));
  }
  const int index = addChecked({"damping", "slide_damping", "length"}, [&] { return model_.addJoint(joint); });
  joints_[j.name] = index;
  if (!j.limits) return;
  multibody::AxisSpring stops;
  stops.name = j.name + " stops", stops.joint = index;
  stops.axis = j.type == JointType::kCylindrical ? JointAxis::kAngle : axis(index, "limits", {});
  setStops(stops, *j.limits, j.stopStiffness, j.stopDamping);
  addChecked({"limits"}, [&] { return model_.addAxisSpring(stops); });
}

void MechanismBuilder::add(const scene::SpringSection& s) {
  checkName("spring", s.name);
  if (s.bodies.empty() == s.joint.empty())
    throw support::SectionFault(s.joint.empty() ? "" : "joint", s.joint.empty()
                                                                    ? "has neither bodies nor joint; add one of them"
                                                                    : "is mutually exclusive with bodies; remove one");
  if (s.joint.empty())
    addBetweenPoints(s);
  else
    addOnAxis(s);
}

void MechanismBuilder::addOnAxis(const scene::SpringSection& s) {
  if (s.pointA || s.pointB)
    throw support::SectionFault(s.pointA ? "point_a" : "point_b",
                                "[m] does not apply to a spring on the axis of a joint; remove it");
  multibody::AxisSpring spring;
  spring.name = s.name, spring.joint = joint("joint", s.joint), spring.axis = axis(spring.joint, "acts_on", s.actsOn);
  spring.stiffness = s.stiffness, spring.damping = s.damping, spring.preload = s.preload;
  spring.freePosition = s.freePosition.value_or(0);
  if (s.limits) setStops(spring, *s.limits, s.stopStiffness, s.stopDamping);
  addChecked({"stiffness", "damping", "preload"}, [&] { return model_.addAxisSpring(spring); });
}

void MechanismBuilder::addBetweenPoints(const scene::SpringSection& s) {
  if (s.limits) throw support::SectionFault("limits", "apply to springs on the axis of a joint only; remove them");
  multibody::PointSpring spring;
  spring.name = s.name;
  std::tie(spring.bodyA, spring.bodyB) = twoBodies(s.bodies);
  spring.point_A = s.pointA.value_or(Vec3d{}), spring.point_B = s.pointB.value_or(Vec3d{});
  spring.stiffness = s.stiffness, spring.damping = s.damping, spring.preload = s.preload;
  const double length = norm(pose(spring.bodyB).toWorld(spring.point_B) - pose(spring.bodyA).toWorld(spring.point_A));
  if (s.freePosition && *s.freePosition < 0)
    throw support::SectionFault("free_position", "[m] is a length, which must be 0 or more; correct it");
  if (!(length > 0))
    throw support::SectionFault(
        "point_b", "[m] coincides with point_a at the start, so the spring has no direction; move one of them");
  spring.restLength = s.freePosition.value_or(length);
  addChecked({"stiffness", "damping", "preload"}, [&] { return model_.addPointSpring(spring); });
}

void MechanismBuilder::add(const scene::BushingSection& b) {
  checkName("bushing", b.name);
  multibody::Bushing bushing;
  bushing.name = b.name;
  std::tie(bushing.bodyA, bushing.bodyB) = twoBodies(b.bodies);
  Pose X{b.point, {}};
  if (b.axis) {
    if (norm2(*b.axis) == 0)
      throw support::SectionFault("axis", "[-] has zero length; set a direction, e.g. [0, 0, 1]");
    X = multibody::frameWithZ(b.point, *b.axis);
  }
  bushing.frame_A = multibody::compose(multibody::inverse(pose(bushing.bodyA)), X);
  bushing.frame_B = multibody::compose(multibody::inverse(pose(bushing.bodyB)), X);
  bushing.stiffness = b.stiffness, bushing.damping = b.damping;
  bushing.rotationStiffness = b.rotationStiffness, bushing.rotationDamping = b.rotationDamping;
  addChecked({"stiffness", "damping"}, [&] { return model_.addBushing(bushing); });
}

void MechanismBuilder::add(const scene::DriveSection& d) {
  checkName("drive", d.name);
  multibody::Drive drive;
  drive.name = d.name, drive.joint = joint("joint", d.joint), drive.axis = axis(drive.joint, "acts_on", d.actsOn);
  drive.law = lawOf(d);
  drive.kind = d.imposes;
  for (const multibody::Drive& other : model_.drives())
    if (other.joint == drive.joint && other.axis == drive.axis && other.kind != multibody::DriveKind::kForce &&
        drive.kind != multibody::DriveKind::kForce)
      throw support::SectionFault("joint",
                                  fmt::format("is already driven by \"{}\"; remove one of the drives", other.name));
  addChecked({"joint", "speed"}, [&] { return model_.addDrive(drive); });
}

void MechanismBuilder::add(const scene::CouplingSection& c) {
  checkName("coupling", c.name);
  if (c.joints.size() != 2) throw support::SectionFault("joints", "must name two joints; correct the list");
  if (!c.actsOn.empty() && c.actsOn.size() != 2)
    throw support::SectionFault("acts_on",
                                "must have two entries, \"angle\" or \"slide\", one per joint; correct the list");
  multibody::Coupling coupling;
  coupling.name = c.name, coupling.ratio = c.ratio;
  coupling.joint1 = joint("joints", c.joints[0]), coupling.joint2 = joint("joints", c.joints[1]);
  const auto named = [&](std::size_t k) { return c.actsOn.empty() ? std::nullopt : std::optional(c.actsOn[k]); };
  coupling.axis1 = axis(coupling.joint1, "acts_on", named(0));
  coupling.axis2 = axis(coupling.joint2, "acts_on", named(1));
  if (c.ratio == 0)
    throw support::SectionFault("ratio",
                                "must not be 0; set the ratio of the motion of the second axis to that of the first");
  if (c.offset) coupling.offset = *c.offset;
  addChecked({"ratio", "offset"}, [&] { return model_.addCoupling(coupling); });
}

multibody::Model buildModel(const scene::MechanismSections& sections, const vehicle::Assembly* vehicle) {
  MechanismBuilder builder = vehicle ? MechanismBuilder(*vehicle) : MechanismBuilder();
  scene::forEachKind(sections, [&](const char*, const auto& list) {
    for (const auto& section : list) builder.add(section);
  });
  return builder.model();
}

} // namespace grouser::setup
