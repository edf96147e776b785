// SPDX-License-Identifier: BSD-3-Clause
#include "runs/mechanism_output.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace grouser::runs {

using base::Vec3d;
using multibody::JointType;

namespace {

const std::vector<std::string> kAxes = {"x", "y", "z"};

bool isKept(const std::vector<std::string>& record, const std::string& name) {
  return record.empty() || std::find(record.begin(), record.end(), name) != record.end();
}

bool hasAxis(const multibody::Joint& joint) {
  return joint.type == JointType::kRevolute || joint.type == JointType::kPrismatic;
}

/// Shares of a mechanism's size: thickness of a bar, least and greatest edge of a body that gives no box [-].
constexpr double kBar = 0.01, kLeastEdge = 0.02, kGreatestEdge = 0.5;

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
    c.push_back({path + "force", "N", "on the second body from the first, world components", 3, kAxes});
    c.push_back({path + "torque", "N m", "the same, about the joint", 3, kAxes});
    if (!hasAxis(j)) continue;
    const bool turns = j.type == JointType::kRevolute;
    c.push_back({path + "position", turns ? "rad" : "m", "of the free axis", 1, {}});
    c.push_back({path + "rate", turns ? "rad/s" : "m/s", "of the free axis", 1, {}});
    c.push_back({path + "axis_force", turns ? "N m" : "N", "of damping, springs, stops and drive along it", 1, {}});
  }
  for (const multibody::PointSpring& s : model.pointSprings()) {
    if (!isKept(record, s.name)) continue;
    c.push_back({"springs/" + s.name + "/force", "N", "positive pushes apart", 1, {}});
    c.push_back({"springs/" + s.name + "/length", "m", "between its ends", 1, {}});
  }
  for (const multibody::AxisSpring& s : model.axisSprings()) {
    if (!isKept(record, s.name) || s.stopStiffness > 0) continue;
    const bool turns = model.joints()[static_cast<std::size_t>(s.joint)].type == JointType::kRevolute;
    c.push_back({"springs/" + s.name + "/force", turns ? "N m" : "N", "on the second body along the axis", 1, {}});
  }
  for (const multibody::Drive& d : model.drives()) {
    if (!isKept(record, d.name)) continue;
    const bool turns = model.joints()[static_cast<std::size_t>(d.joint)].type == JointType::kRevolute;
    const std::string path = "drives/" + d.name + "/";
    c.push_back({path + "value", "-", "what it imposes, in the unit of that", 1, {}});
    c.push_back({path + "torque", turns ? "N m" : "N", "that it takes", 1, {}});
    c.push_back({path + "power", "W", "that it gives to the mechanism", 1, {}});
  }
  c.push_back({"momentum/linear", "kg m/s", "of all bodies", 3, kAxes});
  c.push_back({"momentum/angular", "kg m2/s", "of all bodies about the world's origin", 3, kAxes});
  c.push_back({"constraints/position_error", "m", "widest gap of a joint since the last row [m, rad]", 1, {}});
  c.push_back({"constraints/velocity_error", "m/s", "fastest opening of a joint now [m/s, rad/s]", 1, {}});
  c.push_back({"constraints/iterations", "-", "most of a step since the last row", 1, {}});
  c.push_back({"constraints/singular_steps", "-", "steps through a singular position since the last row", 1, {}});
  return c;
}

void setMechanismRow(RowBuilder& row, const Mechanism& mechanism, const std::vector<std::string>& record) {
  const multibody::Model& model = mechanism.model();
  const multibody::State& state = mechanism.state();
  for (std::size_t i = 0; i < model.bodies().size(); ++i) {
    if (!isKept(record, model.bodies()[i].name)) continue;
    const std::string path = "bodies/" + model.bodies()[i].name + "/";
    const base::Quat& q = state.pose[i].orientation;
    row.set(path + "position", state.pose[i].position);
    row.set(path + "orientation", std::vector<double>{q.w, q.x, q.y, q.z});
    row.set(path + "velocity", state.twist[i].v);
    row.set(path + "spin", state.twist[i].w);
  }
  for (std::size_t i = 0; i < model.joints().size(); ++i) {
    const multibody::Joint& j = model.joints()[i];
    if (!isKept(record, j.name)) continue;
    const std::string path = "joints/" + j.name + "/";
    const multibody::JointReading& r = state.joint[i];
    row.set(path + "force", r.force);
    row.set(path + "torque", r.torque);
    if (!hasAxis(j)) continue;
    row.set(path + "position", r.position);
    row.set(path + "rate", r.rate);
    row.set(path + "axis_force", r.axisForce);
  }
  for (std::size_t i = 0; i < model.pointSprings().size(); ++i) {
    const std::string& name = model.pointSprings()[i].name;
    if (!isKept(record, name)) continue;
    row.set("springs/" + name + "/force", state.spring[i].force);
    row.set("springs/" + name + "/length", state.spring[i].length);
  }
  for (std::size_t i = 0; i < model.axisSprings().size(); ++i) {
    const multibody::AxisSpring& s = model.axisSprings()[i];
    if (!isKept(record, s.name) || s.stopStiffness > 0) continue;
    row.set("springs/" + s.name + "/force", mechanism.axisSpringForce(static_cast<int>(i)));
  }
  for (std::size_t i = 0; i < model.drives().size(); ++i) {
    const std::string& name = model.drives()[i].name;
    if (!isKept(record, name)) continue;
    const Mechanism::DriveReading r = mechanism.drive(static_cast<int>(i));
    row.set("drives/" + name + "/value", r.value);
    row.set("drives/" + name + "/torque", r.torque);
    row.set("drives/" + name + "/power", r.power);
  }
  const Mechanism::Ledger ledger = mechanism.ledger();
  row.set("momentum/linear", ledger.linearMomentum);
  row.set("momentum/angular", ledger.angularMomentum);
  const Mechanism::Drift drift = mechanism.drift();
  row.set("constraints/position_error", drift.position);
  row.set("constraints/velocity_error", drift.velocity);
  row.set("constraints/iterations", drift.iterations);
  row.set("constraints/singular_steps", drift.singularSteps);
}

std::vector<FramePart> mechanismParts(const Scene& scene, const multibody::Model& model) {
  const double size = sizeOf(model);
  std::vector<FramePart> parts;
  for (std::size_t b = 0; b < model.bodies().size(); ++b) {
    const multibody::Body& body = model.bodies()[b];
    FramePart part{body.name, body.fixed ? "fixed" : "body", {}};
    const std::optional<Vec3d>& box = scene.mechanism.bodies[b].box;
    const Vec3d fallback =
        body.fixed ? Vec3d{1, 1, 1} * (3 * kLeastEdge * size) : boxOf(body, kLeastEdge * size, kGreatestEdge * size);
    addBox(part.mesh, {}, base::Mat3d::identity(), box.value_or(fallback));
    if (!box)
      for (const multibody::Joint& j : model.joints()) {
        if (j.bodyA == static_cast<int>(b)) addBar(part.mesh, j.frame_A.position, kBar * size);
        if (j.bodyB == static_cast<int>(b)) addBar(part.mesh, j.frame_B.position, kBar * size);
      }
    parts.push_back(std::move(part));
  }
  return parts;
}

} // namespace grouser::runs
