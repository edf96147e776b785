// SPDX-License-Identifier: BSD-3-Clause
#include "multibody/detail/constraint_system.hpp"

#include "multibody/detail/index.hpp"
#include "multibody/detail/rotation.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

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

ConstraintSystem::ConstraintSystem(const Model& model) : model_(&model) {
  const int worldFrame = static_cast<int>(model.bodies().size());
  std::vector<int> nodeOf(at(worldFrame) + 1, -1);
  for (int b = 0; b < worldFrame; ++b)
    if (!model.bodies()[at(b)].fixed) {
      nodeOf[at(b)] = static_cast<int>(movable_.size());
      movable_.push_back(b);
    }

  std::vector<ConstraintEdge> edges;
  const auto add = [&](Constraint c) {
    if (c.bodyA == kWorld) c.bodyA = worldFrame;
    if (c.bodyB == kWorld) c.bodyB = worldFrame;
    c.nodeA = nodeOf[at(c.bodyA)];
    c.nodeB = nodeOf[at(c.bodyB)];
    constraints_.push_back(c);
    hard_.push_back(hardRows(c.kind));
    ConstraintEdge edge;
    edge.bodies = {c.nodeA, c.nodeB};
    // A rod leaves five freedoms: cheaper as a row that closes a loop.
    edge.joint = isJoint(c.kind) && c.kind != ConstraintKind::kDistance;
    edge.hard = hardRows(c.kind);
    edge.rows = edge.hard | axisRows(c.kind);
    edge.forceRows = forceRows(c.kind);
    edges.push_back(edge);
  };
  for (int j = 0; j < static_cast<int>(model.joints().size()); ++j) {
    const Joint& joint = model.joints()[at(j)];
    add({kindOf(joint.type), joint.bodyA, joint.bodyB, -1, -1, j, joint.frame_A.orientation.matrix(),
         joint.frame_B.orientation.matrix(), joint.frame_A.position, joint.frame_B.position, joint.length});
  }
  for (int s = 0; s < static_cast<int>(model.pointSprings().size()); ++s) {
    const PointSpring& spring = model.pointSprings()[at(s)];
    add({ConstraintKind::kPointSpring, spring.bodyA, spring.bodyB, -1, -1, s, Mat3d::identity(), Mat3d::identity(),
         spring.point_A, spring.point_B});
  }
  for (int s = 0; s < static_cast<int>(model.bushings().size()); ++s) {
    const Bushing& bushing = model.bushings()[at(s)];
    add({ConstraintKind::kBushing, bushing.bodyA, bushing.bodyB, -1, -1, s, bushing.frame_A.orientation.matrix(),
         bushing.frame_B.orientation.matrix(), bushing.frame_A.position, bushing.frame_B.position});
  }
  for (int k = 0; k < static_cast<int>(constraints_.size()); ++k) {
    firstAxis_.push_back(static_cast<int>(axes_.size()));
    for (int r = 0; r < 6; ++r)
      if (axisRows(constraints_[at(k)].kind) >> r & 1u) axes_.push_back({k, r});
  }
  firstAxis_.push_back(static_cast<int>(axes_.size()));

  elimination_ = std::make_unique<Elimination>(movableBodies(), edges);
  Part whole;
  for (int node = 0; node < movableBodies(); ++node) whole.bodies.push_back(node);
  for (int k = 0; k < static_cast<int>(constraints_.size()); ++k) whole.constraints.push_back(k);
  for (int i = 0; i < static_cast<int>(model.couplings().size()); ++i) whole.couplings.push_back(i);
  parts_.push_back(std::move(whole));
  for (const Coupling& c : model.couplings())
    couplings_.push_back({axisOf(c.joint1, c.axis1), axisOf(c.joint2, c.axis2), c.ratio, c.offset});
  setOffsets();
  linearisation_.assign(parts_.size(), 0);
  redundant_.assign(constraints_.size(), 0);
  expectedLost_.assign(parts_.size(), 0);
  couplingSolution_.assign(couplings_.size(), std::vector<Vector6>(at(nodes())));
  couplingFactor_.assign(couplings_.size(), std::vector<double>(couplings_.size()));
  couplingKept_.assign(couplings_.size(), 1);
  couplingWork_.resize(couplings_.size());
  size_.resize(constraints_.size());
  active_ = hard_;
  rows_.resize(constraints_.size());
  frames_.resize(constraints_.size());
  inertia_.resize(movable_.size());
  com_A_.resize(constraints_.size());
  com_B_.resize(constraints_.size());
  makeLinks();
}

/// Offsets that were not given: as the bodies are placed.
void ConstraintSystem::setOffsets() {
  const std::vector<Frame> frames = framesOfModel();
  for (CouplingRow& c : couplings_)
    if (!std::isfinite(c.offset))
      c.offset = positionOfAxis(c.axis2, frames) - c.ratio * positionOfAxis(c.axis1, frames);
}

std::vector<Frame> ConstraintSystem::framesOfModel() const {
  std::vector<Pose> poses;
  for (const Body& body : model_->bodies()) poses.push_back(body.pose);
  std::vector<Frame> frames;
  place(poses, frames);
  return frames;
}

double ConstraintSystem::positionOfAxis(int axis, const std::vector<Frame>& frames) const {
  const Axis& a = axes_[at(axis)];
  const Constraint& c = constraints_[at(a.constraint)];
  return axisPosition(c, framesOf(c, frames[at(c.bodyA)], frames[at(c.bodyB)]), a.row);
}

int ConstraintSystem::axisOf(int joint, JointAxis axis) const {
  // Axis rows of a cylindrical: the slide first, then the angle. The model has resolved kOnly.
  return axis == JointAxis::kAngle ? firstAxis(joint + 1) - 1 : firstAxis(joint);
}

void ConstraintSystem::placeBody(int body, const Pose& pose, std::vector<Frame>& frames) const {
  frames[at(body)] = {pose.orientation.matrix(), pose.position};
}

void ConstraintSystem::place(const std::vector<Pose>& poses, std::vector<Frame>& frames) const {
  frames.resize(poses.size() + 1);
  for (std::size_t b = 0; b < poses.size(); ++b) placeBody(static_cast<int>(b), poses[b], frames);
  frames.back() = {Mat3d::identity(), {}};
}

/// Size of J M^-1 J^T of each row alone, taken once; the mean moment of inertia stands for the tensor.
void ConstraintSystem::setSizes() {
  for (int k = 0; k < static_cast<int>(constraints_.size()); ++k) {
    Block jacobianA{}, jacobianB{};
    rowBlocks(rows(k), jointFrames(k).p_B, com_A(k), com_B(k), jacobianA, jacobianB);
    const auto add = [&](int node, const Block& J) {
      if (node < 0) return;
      const double m = 1 / model_->bodies()[at(movable_[at(node)])].mass;
      const Mat3d& I = inertia(node);
      const double i = 3 / (I.m[0][0] + I.m[1][1] + I.m[2][2]);
      for (std::size_t r = 0; r < 6; ++r)
        for (std::size_t c = 0; c < 6; ++c)
          size_[at(k)][r] += (c < 3 ? m : i) * J[kStride * c + r] * J[kStride * c + r];
    };
    add(constraints_[at(k)].nodeA, jacobianA);
    add(constraints_[at(k)].nodeB, jacobianB);
  }
  sized_ = true;
  for (int k = 0; k < static_cast<int>(constraints_.size()); ++k) setPivotThreshold(k);
}

/// Where rows are known to be redundant, only those with a good pivot are kept: which row of a constraint follows from
/// the others may change on the way, and dropping a wrong one leaves a small pivot behind.
void ConstraintSystem::setPivotThreshold(int k) {
  constexpr double kGoodPivot = 1e-3;
  double part = pivotScale_ * Elimination::kPivotTolerance;
  if (redundant_[at(k)] != 0 && !strict_) part = std::max(part, kGoodPivot);
  double smallest[6];
  for (std::size_t r = 0; r < 6; ++r) smallest[r] = part * size_[at(k)][r];
  elimination_->setSmallestPivots(k, smallest);
}

void ConstraintSystem::noteRedundant(int constraint, int row) {
  redundant_[at(constraint)] |= 1u << row;
  if (sized_) setPivotThreshold(constraint);
  for (const Part& part : parts_)
    if (std::find(part.constraints.begin(), part.constraints.end(), constraint) != part.constraints.end())
      ++expectedLost_[at(part.index)];
}

void ConstraintSystem::scalePivotThreshold(double scale) {
  pivotScale_ = scale;
  for (int k = 0; sized_ && k < static_cast<int>(constraints_.size()); ++k) setPivotThreshold(k);
}

/// With redundant rows, first only good pivots are kept. If more rows are lost than the redundant ones a singular
/// position is near: then every row with a pivot is kept.
int ConstraintSystem::linearise(const Part& part, const std::vector<Frame>& frames, const std::vector<AxisLaw>& laws) {
  ++linearisation_[at(part.index)];
  setUp(frames, laws);
  if (!sized_) setSizes();
  int leftOut = elimination_->factor();
  const int expected = expectedLost_[at(part.index)];
  if (expected > 0) {
    if (leftOut > expected) {
      strict_ = true;
      for (const int k : part.constraints)
        if (redundant_[at(k)]) setPivotThreshold(k);
      leftOut = elimination_->factor();
      strict_ = false;
      for (const int k : part.constraints)
        if (redundant_[at(k)]) setPivotThreshold(k);
    }
    for (const int k : part.constraints) hard_[at(k)] = hardRows(constraints_[at(k)].kind) & elimination_->keptRows(k);
    leftOut = std::max(leftOut - expected, 0);
  }
  if (couplingsOn_ && !part.couplings.empty()) factorCouplings(part);
  return leftOut;
}

void ConstraintSystem::setUp(const std::vector<Frame>& frames, const std::vector<AxisLaw>& laws) {
  packed_ = true;
  lineariseLinks(frames, laws);
  for (const int k : loose_) {
    const Constraint& c = constraints_[at(k)];
    placeFrames(c, frames[at(c.bodyA)], frames[at(c.bodyB)], frames_[at(k)]);
    setRowDirections(c, frames_[at(k)], rows_[at(k)]);
    com_A_[at(k)] = frames[at(c.bodyA)].p;
    com_B_[at(k)] = frames[at(c.bodyB)].p;

    // A soft row has compliance; a driven row is hard; a free axis is out of the system.
    double compliance[6] = {};
    unsigned active = hardRows(c.kind);
    for (int a = firstAxis(k); a < firstAxis(k + 1); ++a) {
      const AxisLaw& law = laws[at(a)];
      const int row = axes_[at(a)].row;
      if (law.driven || law.softness != 0) active |= 1u << row;
      if (!law.driven && law.softness != 0) compliance[row] = 1 / law.softness;
    }
    active_[at(k)] = active;

    elimination_->setJoint(k, rows_[at(k)], frames_[at(k)].p_B, com_A_[at(k)], com_B_[at(k)], compliance, active);
  }
}

void ConstraintSystem::solve(const Part& part, std::vector<Vector6>& x) const {
  elimination_->solve(x.data());
  if (couplingsOn_ && !part.couplings.empty()) solveCouplings(part, x);
}

double ConstraintSystem::rate(int k, int row, const std::vector<Twist>& twist) const {
  const Constraint& c = constraints_[at(k)];
  const Vec3d &e = rows(k).force[at(row)], &t = rows(k).torque[at(row)];
  double sum = 0;
  if (c.nodeB >= 0) {
    const Twist& V = twist[at(c.bodyB)];
    sum += dot(e, V.v) + dot(cross(jointFrames(k).p_B - com_B(k), e) + t, V.w);
  }
  if (c.nodeA >= 0) {
    const Twist& V = twist[at(c.bodyA)];
    sum -= dot(e, V.v) + dot(cross(jointFrames(k).p_B - com_A(k), e) + t, V.w);
  }
  return sum;
}

std::string ConstraintSystem::describe(int k) const {
  const Constraint& c = constraints_[at(k)];
  if (c.kind == ConstraintKind::kPointSpring) return "spring '" + model_->pointSprings()[at(c.source)].name + "'";
  if (c.kind == ConstraintKind::kBushing) return "bushing '" + model_->bushings()[at(c.source)].name + "'";
  return "joint '" + model_->joints()[at(c.source)].name + "'";
}

std::string ConstraintSystem::describe(int k, int row) const {
  const ConstraintKind kind = constraints_[at(k)].kind;
  return isJoint(kind) ? describe(k) + ": " + rowName(kind, row) : describe(k);
}

} // namespace grouser::multibody::detail
