// SPDX-License-Identifier: BSD-3-Clause
#include "multibody/detail/axis_laws.hpp"

#include <cstddef>

namespace grouser::multibody::detail {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// Adds a spring-damper: `force` known at the start of the step, stiffness and damping for its implicit part.
void add(AxisLaw& law, double force, double stiffness, double damping, double dt) {
  law.known += force;
  law.softness += dt * damping + dt * dt * stiffness;
  law.dampingPart += dt * damping;
  law.springKnown += force;
  law.springSoftness += dt * damping + dt * dt * stiffness;
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

void AxisLaws::evaluate(const ConstraintSystem& system, const State& state, const Loads& loads, double dt,
                        const std::vector<Frame>& frames, const std::vector<double>& start,
                        std::vector<AxisLaw>& laws) const {
  for (AxisLaw& law : laws) law = {};
  for (std::size_t j = 0; j < model_->joints().size(); ++j) {
    const Joint& joint = model_->joints()[j];
    if (system.firstAxis(static_cast<int>(j)) == system.firstAxis(static_cast<int>(j) + 1)) continue;
    AxisLaw& law = laws[at(system.firstAxis(static_cast<int>(j) + 1) - 1)];
    law.softness = law.dampingPart = dt * joint.damping;
    if (joint.type != JointType::kCylindrical) continue;
    AxisLaw& slide = laws[at(system.firstAxis(static_cast<int>(j)))];
    slide.softness = slide.dampingPart = dt * joint.slideDamping;
  }
  for (std::size_t s = 0; s < model_->axisSprings().size(); ++s) {
    const AxisSpring& spring = model_->axisSprings()[s];
    const SpringControl& control = loads.axisSprings[s];
    const int axis = system.axisOf(spring.joint, spring.axis);
    const double position = axisPositionIn(state, system, axis), rate = axisRateIn(state, system, axis);
    AxisLaw& law = laws[at(axis)];
    const double k = control.stiffnessFactor * spring.stiffness;
    add(law, control.loadFactor * spring.preload - k * (position - spring.freePosition), k, spring.damping, dt);

    // End stops; their dampers act on the way in only, so that they do not hold back what leaves.
    const double over = overLimit(spring, position);
    if (over != 0)
      add(law, -spring.stopStiffness * over, spring.stopStiffness, rate * over >= 0 ? spring.stopDamping : 0, dt);
  }
  const auto position = [&](const Axis& a) {
    const Constraint& c = system.constraints()[at(a.constraint)];
    return axisPosition(c, framesOf(c, frames[at(c.bodyA)], frames[at(c.bodyB)]), a.row);
  };
  for (std::size_t i = at(system.firstAxis(static_cast<int>(model_->joints().size()))); i < laws.size(); ++i) {
    const Axis& axis = system.axes()[i];
    const Constraint& c = system.constraints()[at(axis.constraint)];
    const double x = position(axis);
    if (c.kind == ConstraintKind::kPointSpring) {
      const PointSpring& spring = model_->pointSprings()[at(c.source)];
      const SpringControl& control = loads.pointSprings[at(c.source)];
      const double k = control.stiffnessFactor * spring.stiffness;
      add(laws[i], control.loadFactor * spring.preload - k * (x - spring.restLength), k, spring.damping, dt);
    } else {
      const Bushing& bushing = model_->bushings()[at(c.source)];
      const bool turn = axis.row >= 3;
      const int along = axis.row % 3;
      const double k =
          loads.bushings[at(c.source)].stiffnessFactor * (turn ? bushing.rotationStiffness : bushing.stiffness)[along];
      add(laws[i], -k * x, k, (turn ? bushing.rotationDamping : bushing.damping)[along], dt);
    }
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
    // The rate is imposed, so all of the axis' other forces are known. The mean rate of a law leads to its position.
    law.driven = true;
    law.speed = drive.law.empty()
                    ? loads.drives[d].speed
                    : (drivenPosition(drive, start[d], state.time + dt) - axisPositionIn(state, system, axis)) / dt;
    law.force = law.known - law.softness / dt * law.speed;
  }
  for (AxisLaw& law : laws)
    if (law.driveForce != 0) law.force += law.driveForce;
}

AxisWork AxisLaws::work(const AxisLaw& law, double multiplier, double newRate, double path, double dt) const {
  AxisWork work;
  const double damper = law.dampingPart / dt * newRate;
  work.dissipated = damper * path;
  work.spring = (law.known - (law.softness - law.dampingPart) / dt * newRate) * path;
  work.drive = (law.driven ? multiplier * path : 0) + law.driveForce * path;
  return work;
}

} // namespace grouser::multibody::detail
