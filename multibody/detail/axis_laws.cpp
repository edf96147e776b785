// SPDX-License-Identifier: BSD-3-Clause
#include "multibody/detail/axis_laws.hpp"

#include "multibody/detail/axis_springs.hpp"
#include "multibody/detail/index.hpp"

#include <algorithm>
#include <cstddef>

namespace grouser::multibody::detail {

namespace {

/// Adds a spring-damper: `force` is known at the start of the step; stiffness and damping form the implicit part.
void add(AxisLaw& law, double force, double stiffness, double damping, double dt) {
  law.known += force;
  law.inverseCompliance += dt * damping + dt * dt * stiffness;
  law.dampingPart += dt * damping;
  law.springKnown += force;
  law.springInverseCompliance += dt * damping + dt * dt * stiffness;
}

/// Adds a spring at position x.
void add(AxisLaw& law, const LinearSpring& spring, double x, double dt) {
  add(law, spring.load - spring.stiffness * (x - spring.rest), spring.stiffness, spring.damping, dt);
}

/// Damping of an end stop over a step [N s/m] or [N m s/rad]. A stop is never adhesive: during separation its damper is
/// limited by the spring force at the end of the step,
///   k (over + dt rate) + c rate >= 0,
/// so that no force remains without other loads. A value below 0 means that contact ends within the step.
double stopDamping(const AxisSpring& spring, double over, double rate, double dt) {
  if (rate * over >= 0) return spring.stopDamping;
  return std::min(spring.stopDamping, spring.stopStiffness * (over + dt * rate) / -rate);
}

} // namespace

double overLimit(const AxisSpring& spring, double position) {
  return position > spring.upperLimit   ? position - spring.upperLimit
         : position < spring.lowerLimit ? position - spring.lowerLimit
                                        : 0;
}

double& axisPositionIn(State& state, const ConstraintSystem& system, int axis) {
  const Axis& a = system.axes()[at(axis)];
  const Constraint& c = system.constraints()[at(a.constraint)];
  return c.kind == ConstraintKind::kCylindrical && a.row == kSlideRow ? state.slide[at(c.source)].position
                                                                      : state.joint[at(c.source)].position;
}

double axisPositionIn(const State& state, const ConstraintSystem& system, int axis) {
  return axisPositionIn(const_cast<State&>(state), system, axis);
}

double axisRateIn(const State& state, const ConstraintSystem& system, int axis) {
  const Axis& a = system.axes()[at(axis)];
  const Constraint& c = system.constraints()[at(a.constraint)];
  return c.kind == ConstraintKind::kCylindrical && a.row == kSlideRow ? state.slide[at(c.source)].rate
                                                                      : state.joint[at(c.source)].rate;
}

double drivenPosition(const Drive& drive, double start, double t) {
  return drive.kind == DriveKind::kPosition ? drive.law.value(t) : start + drive.law.integral(t);
}

double drivenRate(const Drive& drive, double t) {
  return drive.kind == DriveKind::kPosition ? drive.law.rate(t) : drive.law.value(t);
}

std::vector<double> driveStart(const ConstraintSystem& system, const Model& model) {
  const std::vector<Frame> frames = system.framesOfModel();
  std::vector<double> start;
  for (const Drive& drive : model.drives())
    start.push_back(system.positionOfAxis(system.axisOf(drive.joint, drive.axis), frames));
  return start;
}

AxisLaws::AxisLaws(const Model& model, const ConstraintSystem& system) : model_(&model) {
  const int ofJoints = system.firstAxis(static_cast<int>(model.joints().size()));
  for (int a = 0; a < ofJoints; ++a) jointDamping_.push_back(ownDamping(system, model, system.axes()[at(a)]));
}

void AxisLaws::evaluate(const ConstraintSystem& system, const State& state, const Loads& loads, double dt,
                        const std::vector<Frame>& frames, const std::vector<double>& start,
                        std::vector<AxisLaw>& laws) const {
  for (AxisLaw& law : laws) law = {};
  const std::size_t ofJoints = jointDamping_.size();
  for (std::size_t a = 0; a < ofJoints; ++a)
    laws[a].inverseCompliance = laws[a].dampingPart = laws[a].jointDamping = dt * jointDamping_[a];
  for (std::size_t s = 0; s < model_->axisSprings().size(); ++s) {
    const AxisSpring& spring = model_->axisSprings()[s];
    const int axis = system.axisOf(spring.joint, spring.axis);
    const double position = axisPositionIn(state, system, axis), rate = axisRateIn(state, system, axis);
    AxisLaw& law = laws[at(axis)];
    add(law, linearSpring(spring, loads.axisSprings[s]), position, dt);
    law.springDamping += dt * spring.damping;

    const double over = overLimit(spring, position);
    if (over == 0) continue;
    const double damping = stopDamping(spring, over, rate, dt);
    if (damping < 0) continue;
    add(law, -spring.stopStiffness * over, spring.stopStiffness, damping, dt);
    law.stopDamping += dt * damping;
  }
  for (std::size_t a = ofJoints; a < laws.size(); ++a) {
    const LinearSpring own = ownSpring(system, *model_, loads, system.axes()[a]);
    add(laws[a], own, system.positionOfAxis(static_cast<int>(a), frames), dt);
    laws[a].springDamping += dt * own.damping;
  }
  for (AxisLaw& law : laws) law.force = law.known;
  for (std::size_t d = 0; d < model_->drives().size(); ++d) {
    if (!loads.drives[d].on) continue;
    const Drive& drive = model_->drives()[d];
    const int axis = system.axisOf(drive.joint, drive.axis);
    AxisLaw& law = laws[at(axis)];
    if (drive.kind == DriveKind::kForce) {
      law.driveForce += drive.law.empty() ? loads.drives[d].force : drive.law.value(state.time);
      continue;
    }
    // The rate is imposed, so all other forces of the axis are known. The mean rate of a law leads to its position.
    law.driven = true;
    law.speed = drive.law.empty()
                    ? loads.drives[d].speed
                    : (drivenPosition(drive, start[d], state.time + dt) - axisPositionIn(state, system, axis)) / dt;
    law.force = law.known - law.inverseCompliance / dt * law.speed;
  }
  for (AxisLaw& law : laws)
    if (law.driveForce != 0) law.force += law.driveForce;
}

AxisWork AxisLaws::work(const AxisLaw& law, double multiplier, double newRate, double path, double dt) const {
  AxisWork work;
  const double damper = law.dampingPart / dt * newRate;
  work.dissipated = damper * path;
  const double each = newRate / dt * path;
  work.joint = law.jointDamping * each, work.springs = law.springDamping * each, work.stops = law.stopDamping * each;
  work.spring = (law.known - (law.inverseCompliance - law.dampingPart) / dt * newRate) * path;
  work.drive = (law.driven ? multiplier * path : 0) + law.driveForce * path;
  return work;
}

} // namespace grouser::multibody::detail
