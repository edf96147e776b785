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

AxisLaws::AxisLaws(const Model& model, const std::vector<Constraint>& constraints)
    : model_(&model), row_(constraints.size(), -1) {
  for (std::size_t k = 0; k < constraints.size(); ++k) row_[k] = softRow(constraints[k].kind);
}

void AxisLaws::evaluate(const ConstraintSystem& system, const State& state, const Loads& loads, double dt,
                        const std::vector<Frame>& frames, std::vector<AxisLaw>& laws) const {
  const std::size_t joints = model_->joints().size();
  for (std::size_t j = 0; j < joints; ++j) {
    laws[j] = {};
    laws[j].softness = laws[j].dampingPart = dt * model_->joints()[j].damping;
  }
  for (std::size_t s = 0; s < model_->axisSprings().size(); ++s) {
    const AxisSpring& spring = model_->axisSprings()[s];
    const SpringControl& control = loads.axisSprings[s];
    const JointReading& axis = state.joint[at(spring.joint)];
    AxisLaw& law = laws[at(spring.joint)];
    const double k = control.stiffnessFactor * spring.stiffness;
    add(law, control.loadFactor * spring.preload - k * (axis.position - spring.freePosition), k, spring.damping, dt);

    // End stops; their dampers act on the way in only, so that they do not hold back what leaves.
    const double over = axis.position > spring.upperLimit   ? axis.position - spring.upperLimit
                        : axis.position < spring.lowerLimit ? axis.position - spring.lowerLimit
                                                            : 0;
    if (over != 0)
      add(law, -spring.stopStiffness * over, spring.stopStiffness, axis.rate * over >= 0 ? spring.stopDamping : 0, dt);
  }
  for (std::size_t s = 0; s < model_->pointSprings().size(); ++s) {
    const PointSpring& spring = model_->pointSprings()[s];
    const SpringControl& control = loads.pointSprings[s];
    const Constraint& c = system.constraints()[joints + s];
    const double length = axisPosition(c, framesOf(c, frames[at(c.bodyA)], frames[at(c.bodyB)]));
    const double k = control.stiffnessFactor * spring.stiffness;
    laws[joints + s] = {};
    add(laws[joints + s], control.loadFactor * spring.preload - k * (length - spring.restLength), k, spring.damping,
        dt);
  }
  for (AxisLaw& law : laws) law.force = law.known;
  for (std::size_t d = 0; d < model_->drives().size(); ++d) {
    if (!loads.drives[d].on) continue;
    // The rate is imposed, so all of the axis' other forces are known.
    AxisLaw& law = laws[at(model_->drives()[d].joint)];
    law.driven = true;
    law.speed = loads.drives[d].speed;
    law.force = law.known - law.softness / dt * law.speed;
  }
}

AxisWork AxisLaws::work(const AxisLaw& law, double multiplier, double newRate, double path, double dt) const {
  AxisWork work;
  const double damper = law.dampingPart / dt * newRate;
  work.dissipated = damper * path;
  work.spring = (law.known - (law.softness - law.dampingPart) / dt * newRate) * path;
  work.drive = law.driven ? multiplier * path : 0;
  return work;
}

} // namespace grouser::multibody::detail
