// SPDX-License-Identifier: BSD-3-Clause
#include "multibody/detail/constraint_graph.hpp"

#include "multibody/detail/index.hpp"

#include <cmath>
#include <cstddef>
#include <utility>

namespace grouser::multibody::detail {

namespace {

ConstraintKind kindOf(JointType type) {
  switch (type) {
  case JointType::kRevolute:
    return ConstraintKind::kRevolute;
  case JointType::kSpherical:
    return ConstraintKind::kSpherical;
  case JointType::kUniversal:
    return ConstraintKind::kUniversal;
  case JointType::kPrismatic:
    return ConstraintKind::kPrismatic;
  case JointType::kFixed:
    return ConstraintKind::kFixed;
  case JointType::kCylindrical:
    return ConstraintKind::kCylindrical;
  case JointType::kDistance:
    return ConstraintKind::kDistance;
  }
  return ConstraintKind::kFixed;
}

} // namespace

ConstraintGraph::ConstraintGraph(const Model& model) : model_(&model) {
  addConstraints(nodesOfBodies());
  for (int k = 0; k < static_cast<int>(constraints_.size()); ++k) {
    firstAxis_.push_back(static_cast<int>(axes_.size()));
    for (int r = 0; r < 6; ++r)
      if (axisRows(constraints_[at(k)].kind) >> r & 1u) axes_.push_back({k, r});
  }
  firstAxis_.push_back(static_cast<int>(axes_.size()));

  Part whole;
  for (int node = 0; node < movableBodies(); ++node) whole.bodies.push_back(node);
  for (int k = 0; k < static_cast<int>(constraints_.size()); ++k) whole.constraints.push_back(k);
  for (int i = 0; i < static_cast<int>(model.couplings().size()); ++i) whole.couplings.push_back(i);
  parts_.push_back(std::move(whole));
  for (const Coupling& c : model.couplings())
    couplings_.push_back({axisOf(c.joint1, c.axis1), axisOf(c.joint2, c.axis2), c.ratio, c.offset});
  setOffsets();
}

/// Node of each body, -1 if immovable; the world is last.
std::vector<int> ConstraintGraph::nodesOfBodies() {
  std::vector<int> nodeOf;
  for (const Body& body : model_->bodies()) {
    nodeOf.push_back(body.fixed ? -1 : movableBodies());
    if (!body.fixed) movable_.push_back(static_cast<int>(nodeOf.size()) - 1);
  }
  nodeOf.push_back(-1);
  return nodeOf;
}

/// Joints, point springs, bushings, in this order.
void ConstraintGraph::addConstraints(const std::vector<int>& nodeOf) {
  const int world = static_cast<int>(model_->bodies().size());
  const auto add = [&](Constraint c) {
    if (c.bodyA == kWorld) c.bodyA = world;
    if (c.bodyB == kWorld) c.bodyB = world;
    c.nodeA = nodeOf[at(c.bodyA)];
    c.nodeB = nodeOf[at(c.bodyB)];
    constraints_.push_back(c);
  };
  for (int j = 0; j < static_cast<int>(model_->joints().size()); ++j) {
    const Joint& joint = model_->joints()[at(j)];
    add({kindOf(joint.type), joint.bodyA, joint.bodyB, -1, -1, j, joint.frame_A.orientation.matrix(),
         joint.frame_B.orientation.matrix(), joint.frame_A.position, joint.frame_B.position, joint.length});
  }
  for (int s = 0; s < static_cast<int>(model_->pointSprings().size()); ++s) {
    const PointSpring& spring = model_->pointSprings()[at(s)];
    add({ConstraintKind::kPointSpring, spring.bodyA, spring.bodyB, -1, -1, s, Mat3d::identity(), Mat3d::identity(),
         spring.point_A, spring.point_B});
  }
  for (int s = 0; s < static_cast<int>(model_->bushings().size()); ++s) {
    const Bushing& bushing = model_->bushings()[at(s)];
    add({ConstraintKind::kBushing, bushing.bodyA, bushing.bodyB, -1, -1, s, bushing.frame_A.orientation.matrix(),
         bushing.frame_B.orientation.matrix(), bushing.frame_A.position, bushing.frame_B.position});
  }
}

std::vector<ConstraintEdge> ConstraintGraph::edges() const {
  std::vector<ConstraintEdge> edges;
  for (const Constraint& c : constraints_) {
    ConstraintEdge edge;
    edge.bodies = {c.nodeA, c.nodeB};
    // A rod removes only one degree of freedom; as a loop constraint it is cheaper.
    edge.joint = isJoint(c.kind) && c.kind != ConstraintKind::kDistance;
    edge.hard = hardRows(c.kind);
    edge.rows = edge.hard | axisRows(c.kind);
    edge.forceRows = forceRows(c.kind);
    edges.push_back(edge);
  }
  return edges;
}

/// Sets unspecified offsets from the body poses.
void ConstraintGraph::setOffsets() {
  const std::vector<Frame> frames = framesOfModel();
  for (CouplingRow& c : couplings_)
    if (!std::isfinite(c.offset))
      c.offset = positionOfAxis(c.axis2, frames) - c.ratio * positionOfAxis(c.axis1, frames);
}

std::vector<Frame> ConstraintGraph::framesOfModel() const {
  std::vector<Pose> poses;
  for (const Body& body : model_->bodies()) poses.push_back(body.pose);
  std::vector<Frame> frames;
  place(poses, frames);
  return frames;
}

double ConstraintGraph::positionOfAxis(int axis, const std::vector<Frame>& frames) const {
  const Axis& a = axes_[at(axis)];
  const Constraint& c = constraints_[at(a.constraint)];
  return axisPosition(c, framesOf(c, frames[at(c.bodyA)], frames[at(c.bodyB)]), a.row);
}

int ConstraintGraph::axisOf(int joint, JointAxis axis) const {
  // Axis rows of a cylindrical joint: first the slide, then the angle. The model has already resolved kOnly.
  return axis == JointAxis::kAngle ? firstAxis(joint + 1) - 1 : firstAxis(joint);
}

void ConstraintGraph::placeBody(int body, const Pose& pose, std::vector<Frame>& frames) const {
  frames[at(body)] = {pose.orientation.matrix(), pose.position};
}

void ConstraintGraph::place(const std::vector<Pose>& poses, std::vector<Frame>& frames) const {
  frames.resize(poses.size() + 1);
  for (std::size_t b = 0; b < poses.size(); ++b) placeBody(static_cast<int>(b), poses[b], frames);
  frames.back() = {Mat3d::identity(), {}};
}

std::string ConstraintGraph::describe(int k) const {
  const Constraint& c = constraints_[at(k)];
  if (c.kind == ConstraintKind::kPointSpring) return "spring '" + model_->pointSprings()[at(c.source)].name + "'";
  if (c.kind == ConstraintKind::kBushing) return "bushing '" + model_->bushings()[at(c.source)].name + "'";
  return "joint '" + model_->joints()[at(c.source)].name + "'";
}

std::string ConstraintGraph::describe(int k, int row) const {
  const ConstraintKind kind = constraints_[at(k)].kind;
  return isJoint(kind) ? describe(k) + ": " + rowName(kind, row) : describe(k);
}

} // namespace grouser::multibody::detail
