// SPDX-License-Identifier: BSD-3-Clause
#include "runs/output/mechanism_output.hpp"

#include "multibody/readings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace grouser::output {

using base::Vec3d;
using multibody::JointType;

namespace {

bool isKept(const std::vector<std::string>& record, const std::string& name) {
  return record.empty() || std::find(record.begin(), record.end(), name) != record.end();
}

bool hasAngle(const multibody::Joint& j) { return j.type == JointType::kRevolute || j.type == JointType::kCylindrical; }
bool hasSlide(const multibody::Joint& j) {
  return j.type == JointType::kPrismatic || j.type == JointType::kCylindrical;
}

/// Free axes of a joint with the names of their quantities.
struct NamedAxis {
  multibody::JointAxis axis;
  std::string prefix; ///< of the quantities: "" for the only axis
  bool turns;
};
std::vector<NamedAxis> axesOf(const multibody::Joint& j) {
  if (j.type == JointType::kCylindrical)
    return {{multibody::JointAxis::kAngle, "angle_", true}, {multibody::JointAxis::kSlide, "slide_", false}};
  if (hasAngle(j) || hasSlide(j)) return {{multibody::JointAxis::kOnly, "", hasAngle(j)}};
  return {};
}

/// Whether an axis is one of angles.
bool turns(const multibody::Joint& j, multibody::JointAxis axis) {
  return axis == multibody::JointAxis::kAngle || (axis == multibody::JointAxis::kOnly && hasAngle(j));
}

const multibody::Joint& jointOf(const multibody::Model& model, int joint) {
  return model.joints()[static_cast<std::size_t>(joint)];
}

/// The end stops of a joint alone are no spring of their own.
bool isSpring(const multibody::AxisSpring& s) { return s.stiffness > 0 || s.damping > 0 || s.preload != 0; }

std::string driveUnit(multibody::DriveKind kind, bool turning) {
  if (kind == multibody::DriveKind::kSpeed) return turning ? "rad/s" : "m/s";
  if (kind == multibody::DriveKind::kPosition) return turning ? "rad" : "m";
  return turning ? "N m" : "N";
}

/// Share of the kinetic energy at the start below which a blow is round-off of what was typed [-].
constexpr double kBlowShown = 1e-6;
/// Redundant rows that are named before "and ... more" [-].
constexpr std::size_t kRowsShown = 8;

/// Shares of a mechanism's size: thickness of the bars from a centre to the joints, edge of the cube at the centre,
/// least and greatest edge of a free body that gives no box [-].
constexpr double kBar = 0.015, kCentre = 0.035, kLeastEdge = 0.02, kGreatestEdge = 0.5;

/// Adds a box of edges `size` about `centre`, its axes the columns of `R`.
void addBox(base::TriangleMesh& mesh, const Vec3d& centre, const base::Mat3d& R, const Vec3d& size) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (int i = 0; i < 8; ++i) {
    const Vec3d corner{(i & 1 ? 0.5 : -0.5) * size.x, (i & 2 ? 0.5 : -0.5) * size.y, (i & 4 ? 0.5 : -0.5) * size.z};
    mesh.vertices.push_back(centre + R * corner);
  }
  constexpr std::uint32_t kFaces[] = {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                                      2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5};
  for (const std::uint32_t f : kFaces) mesh.indices.push_back(first + f);
}

void addBar(base::TriangleMesh& mesh, const Vec3d& to, double thickness) {
  const double length = norm(to);
  if (!(length > thickness)) return;
  const base::Pose along = multibody::frameWithZ(to * 0.5, to);
  addBox(mesh, along.position, along.orientation.matrix(), {thickness, thickness, length});
}

/// Edges of the uniform box of a body's mass and principal inertia along its axes [m].
Vec3d boxOf(const multibody::Body& body, double least, double greatest) {
  const auto& I = body.inertia_B.m;
  const auto edge = [&](double a, double b, double c) {
    return std::clamp(std::sqrt(std::max(0.0, 6 * (b + c - a) / body.mass)), least, greatest);
  };
  return {edge(I[0][0], I[1][1], I[2][2]), edge(I[1][1], I[0][0], I[2][2]), edge(I[2][2], I[0][0], I[1][1])};
}

/// Diagonal of the box around all centres and joints at the start [m].
double sizeOf(const multibody::Model& model) {
  Vec3d low{1e300, 1e300, 1e300}, high = -low;
  const auto take = [&](const Vec3d& p) { low = base::min(low, p), high = base::max(high, p); };
  for (const multibody::Body& b : model.bodies()) take(b.pose.position);
  for (const multibody::Joint& j : model.joints())
    take(model.bodies()[static_cast<std::size_t>(std::max(j.bodyB, 0))].pose.toWorld(j.frame_B.position));
  const double size = norm(high - low);
  return size > 0 ? size : 1;
}

} // namespace

std::vector<Channel> mechanismChannels(const multibody::Model& model, const std::vector<std::string>& record) {
  std::vector<Channel> c;
  for (const multibody::Body& b : model.bodies()) {
    if (!isKept(record, b.name)) continue;
    const std::string path = "bodies/" + b.name + "/";
    c.push_back({path + "position", "m", "of the centre of mass", 3, kAxes});
    c.push_back({path + "orientation", "-", "quaternion from body to world", 4, {"w", "x", "y", "z"}});
    c.push_back({path + "velocity", "m/s", "of the centre of mass", 3, kAxes});
    c.push_back({path + "spin", "rad/s", "angular velocity, world components", 3, kAxes});
  }
  for (const multibody::Joint& j : model.joints()) {
    if (!isKept(record, j.name)) continue;
    const std::string path = "joints/" + j.name + "/";
    c.push_back({path + "force", "N",
                 "on the second body from the first, with springs and drives of the axis, without couplings; world "
                 "components",
                 3, kAxes});
    c.push_back({path + "torque", "N m", "the same, about the joint", 3, kAxes});
    for (const NamedAxis& a : axesOf(j)) {
      c.push_back({path + a.prefix + "position", a.turns ? "rad" : "m", "of the free axis", 1, {}});
      c.push_back({path + a.prefix + "rate", a.turns ? "rad/s" : "m/s", "of the free axis", 1, {}});
      c.push_back({path + a.prefix + "force_along",
                   a.turns ? "N m" : "N",
                   "of damping, springs, stops and drive along the free axis",
                   1,
                   {}});
    }
  }
  for (const multibody::PointSpring& s : model.pointSprings()) {
    if (!isKept(record, s.name)) continue;
    c.push_back({"springs/" + s.name + "/force", "N", "positive pushes apart", 1, {}});
    c.push_back({"springs/" + s.name + "/length", "m", "between its ends", 1, {}});
  }
  for (const multibody::AxisSpring& s : model.axisSprings()) {
    if (!isSpring(s) || !isKept(record, s.name)) continue;
    c.push_back({"springs/" + s.name + "/force",
                 turns(jointOf(model, s.joint), s.axis) ? "N m" : "N",
                 "on the second body along the axis",
                 1,
                 {}});
  }
  for (const multibody::Bushing& b : model.bushings()) {
    if (!isKept(record, b.name)) continue;
    const std::string path = "bushings/" + b.name + "/";
    c.push_back({path + "force", "N", "on the second body, world components", 3, kAxes});
    c.push_back({path + "torque", "N m", "on the second body, world components", 3, kAxes});
    c.push_back({path + "translation", "m", "in the bushing's axes on the first body", 3, kAxes});
    c.push_back({path + "rotation", "rad", "rotation vector in the same axes", 3, kAxes});
  }
  for (const multibody::Drive& d : model.drives()) {
    if (!isKept(record, d.name)) continue;
    const bool turning = turns(jointOf(model, d.joint), d.axis);
    const std::string path = "drives/" + d.name + "/";
    c.push_back({path + "value", driveUnit(d.kind, turning), "what it imposes", 1, {}});
    c.push_back({path + "torque", turning ? "N m" : "N", "that it takes", 1, {}});
    c.push_back({path + "power", "W", "that it gives to the mechanism", 1, {}});
  }
  for (std::size_t i = 0; i < model.couplings().size(); ++i) {
    const multibody::Coupling& coupling = model.couplings()[i];
    if (!isKept(record, coupling.name)) continue;
    c.push_back({"couplings/" + coupling.name + "/force",
                 turns(jointOf(model, coupling.joint2), coupling.axis2) ? "N m" : "N",
                 "on the second axis, beside what the joint's force and torque hold; the first feels minus the ratio "
                 "times it",
                 1,
                 {}});
  }
  c.push_back({"momentum/linear", "kg m/s", "of all bodies", 3, kAxes});
  c.push_back({"momentum/angular", "kg m2/s", "of all bodies about the world's origin", 3, kAxes});
  c.push_back({"constraints/position_error", "m", "widest gap of a joint since the last row [m, rad]", 1, {}});
  c.push_back({"constraints/velocity_error", "m/s", "fastest opening of a joint now [m/s, rad/s]", 1, {}});
  c.push_back({"constraints/iterations", "-", "most of a step since the last row", 1, {}});
  c.push_back({"constraints/singular_steps", "-", "steps through a singular position since the last row", 1, {}});
  return c;
}

void setMechanismRow(RowBuilder& row, const coupling::Mechanism& mechanism, const std::vector<std::string>& record) {
  const multibody::Model& model = mechanism.model();
  const multibody::State& state = mechanism.state();
  const bool stepped = state.time > 0; // what acts on the bodies is found in a step: nothing is known before the first
  for (std::size_t i = 0; i < model.bodies().size(); ++i) {
    if (!isKept(record, model.bodies()[i].name)) continue;
    const std::string path = "bodies/" + model.bodies()[i].name + "/";
    const base::Quat& q = state.pose[i].orientation;
    row.set(path + "position", state.pose[i].position);
    row.set(path + "orientation", std::vector<double>{q.w, q.x, q.y, q.z});
    row.set(path + "velocity", state.twist[i].v);
    row.set(path + "spin", state.twist[i].w);
  }
  const std::vector<multibody::JointReaction> reactions = mechanism.solver().reactions(state);
  for (std::size_t i = 0; i < model.joints().size(); ++i) {
    const multibody::Joint& j = model.joints()[i];
    if (!isKept(record, j.name)) continue;
    const std::string path = "joints/" + j.name + "/";
    if (stepped) row.set(path + "force", reactions[i].force);
    if (stepped) row.set(path + "torque", reactions[i].torque);
    for (const NamedAxis& a : axesOf(j)) {
      const multibody::AxisReading axis = multibody::axisReading(model, state, static_cast<int>(i), a.axis);
      row.set(path + a.prefix + "position", axis.position);
      row.set(path + a.prefix + "rate", axis.rate);
      if (stepped) row.set(path + a.prefix + "force_along", axis.axisForce);
    }
  }
  for (std::size_t i = 0; i < model.pointSprings().size(); ++i) {
    const std::string& name = model.pointSprings()[i].name;
    if (!isKept(record, name)) continue;
    if (stepped) row.set("springs/" + name + "/force", state.spring[i].force);
    row.set("springs/" + name + "/length", state.spring[i].length);
  }
  for (std::size_t i = 0; i < model.axisSprings().size(); ++i) {
    const multibody::AxisSpring& s = model.axisSprings()[i];
    if (!isSpring(s) || !isKept(record, s.name)) continue;
    row.set("springs/" + s.name + "/force", mechanism.axisSpringForce(static_cast<int>(i)));
  }
  for (std::size_t i = 0; i < model.bushings().size(); ++i) {
    if (!isKept(record, model.bushings()[i].name)) continue;
    const std::string path = "bushings/" + model.bushings()[i].name + "/";
    const multibody::BushingReading& r = state.bushing[i];
    if (stepped) row.set(path + "force", r.force);
    if (stepped) row.set(path + "torque", r.torque);
    row.set(path + "translation", r.translation);
    row.set(path + "rotation", r.rotation);
  }
  for (std::size_t i = 0; i < model.drives().size(); ++i) {
    const std::string& name = model.drives()[i].name;
    if (!isKept(record, name)) continue;
    const coupling::Mechanism::DriveReading r = mechanism.drive(static_cast<int>(i));
    row.set("drives/" + name + "/value", r.value);
    if (stepped) row.set("drives/" + name + "/torque", r.torque);
    if (stepped) row.set("drives/" + name + "/power", r.power);
  }
  for (std::size_t i = 0; i < model.couplings().size(); ++i)
    if (stepped && isKept(record, model.couplings()[i].name))
      row.set("couplings/" + model.couplings()[i].name + "/force", state.coupling[i].force);
  const coupling::Mechanism::Ledger ledger = mechanism.ledger();
  row.set("momentum/linear", ledger.linearMomentum);
  row.set("momentum/angular", ledger.angularMomentum);
  const coupling::Mechanism::Drift drift = mechanism.drift();
  row.set("constraints/position_error", drift.position);
  row.set("constraints/velocity_error", drift.velocity);
  row.set("constraints/iterations", drift.iterations);
  row.set("constraints/singular_steps", drift.singularSteps);
}

std::string integratorText(const multibody::SolverOptions& options) {
  if (options.integrator != multibody::Integrator::kRattle) return "symplectic Euler, order 1, springs implicit";
  return fmt::format("RATTLE, order {}, springs {}", options.order,
                     options.springs == multibody::Springs::kImplicit ? "implicit" : "explicit");
}

std::string mechanismSize(const coupling::Mechanism& mechanism) {
  const multibody::Model& model = mechanism.model();
  const multibody::Solver& solver = mechanism.solver();
  std::string text;
  const auto line = [&](const std::string& what, const std::string& value) {
    text += fmt::format("  {:<24} {}\n", what, value);
  };
  line("bodies", fmt::format("{}", model.bodies().size()));
  line("joints", fmt::format("{}", model.joints().size()));
  line("springs and bushings",
       fmt::format("{}", model.axisSprings().size() + model.pointSprings().size() + model.bushings().size()));
  line("drives and couplings", fmt::format("{}", model.drives().size() + model.couplings().size()));
  line("degrees of freedom", fmt::format("{}, drives left out", solver.degreesOfFreedom()));
  if (std::fabs(mechanism.startBlow()) > kBlowShown * (std::fabs(mechanism.startBlow()) + mechanism.ledger().kinetic))
    line("at the start",
         fmt::format("the drives jump to their speed: {:.4g} J in a blow; give the bodies that velocity, or "
                     "let the drives come up to it",
                     mechanism.startBlow()));
  const std::vector<std::string> redundant = solver.redundantRowNames();
  if (redundant.empty()) return text;
  line("rows held more than once", fmt::format("{}; the reactions of least norm are given", redundant.size()));
  for (std::size_t i = 0; i < std::min(redundant.size(), kRowsShown); ++i) line("", redundant[i]);
  if (redundant.size() > kRowsShown) line("", fmt::format("and {} more", redundant.size() - kRowsShown));
  return text;
}

std::vector<FramePart> mechanismParts(const coupling::MechanismSetup& setup) {
  const multibody::Model& model = setup.model;
  const double size = sizeOf(model);
  std::vector<FramePart> parts;
  for (std::size_t b = 0; b < model.bodies().size(); ++b) {
    const multibody::Body& body = model.bodies()[b];
    FramePart part{body.name, body.fixed ? PartKind::fixed : kBodyKinds[b % std::size(kBodyKinds)], {}};
    std::vector<Vec3d> ends;
    for (const multibody::Joint& j : model.joints()) {
      if (j.bodyA == static_cast<int>(b)) ends.push_back(j.frame_A.position);
      if (j.bodyB == static_cast<int>(b)) ends.push_back(j.frame_B.position);
    }
    const bool isSmall = !ends.empty() || body.fixed || body.point;
    const Vec3d fallback =
        isSmall ? Vec3d{1, 1, 1} * (kCentre * size) : boxOf(body, kLeastEdge * size, kGreatestEdge * size);
    const std::optional<Vec3d>& box = setup.boxes[b];
    addBox(part.mesh, {}, base::Mat3d::identity(), box.value_or(fallback));
    if (!box)
      for (const Vec3d& end : ends) addBar(part.mesh, end, kBar * size);
    parts.push_back(std::move(part));
  }
  return parts;
}

} // namespace grouser::output
