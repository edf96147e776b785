// SPDX-License-Identifier: BSD-3-Clause
#include "multibody/readings.hpp"

#include "multibody/detail/axis_laws.hpp"

#include <cstddef>

namespace grouser::multibody {

AxisReading axisReading(const Model& model, const State& state, int joint, JointAxis axis) {
  const auto j = static_cast<std::size_t>(joint);
  if (model.joints().at(j).type == JointType::kCylindrical && axis == JointAxis::kSlide) return state.slide[j];
  const JointReading& r = state.joint[j];
  return {r.position, r.rate, r.axisForce, r.driveForce, r.springForce};
}

double driveForce(const Model& model, const State& state, int drive) {
  const Drive& d = model.drives().at(static_cast<std::size_t>(drive));
  return axisReading(model, state, d.joint, d.axis).driveForce;
}

double drivePower(const Model& model, const State& state, int drive) {
  const Drive& d = model.drives().at(static_cast<std::size_t>(drive));
  const AxisReading axis = axisReading(model, state, d.joint, d.axis);
  return axis.driveForce * axis.rate;
}

Totals totals(const Model& model, const State& state, const Loads& loads) {
  Totals t;
  for (std::size_t b = 0; b < state.pose.size(); ++b) {
    const Body& body = model.bodies()[b];
    if (body.fixed) continue;
    const Twist& V = state.twist[b];
    const Vec3d& p = state.pose[b].position;
    const Vec3d w_B = transposedTimes(state.pose[b].orientation.matrix(), V.w);
    t.kinetic += 0.5 * body.mass * norm2(V.v) + 0.5 * dot(w_B, body.inertia_B * w_B);
    t.gravity -= body.mass * dot(loads.gravity, p);
    t.linearMomentum += body.mass * V.v;
    t.angularMomentum += cross(p, body.mass * V.v) + state.angularMomentum[b];
  }
  t.elastic = elasticEnergy(model, state, loads);
  return t;
}

double elasticEnergy(const Model& model, const State& state, const Loads& loads) {
  double energy = 0;
  for (std::size_t s = 0; s < model.axisSprings().size(); ++s) {
    const AxisSpring& spring = model.axisSprings()[s];
    const SpringControl& control = loads.axisSprings[s];
    const double q = axisReading(model, state, spring.joint, spring.axis).position, x = q - spring.freePosition;
    energy += 0.5 * control.stiffnessFactor * spring.stiffness * x * x - control.loadFactor * spring.preload * x;
    const double over = detail::overLimit(spring, q);
    energy += 0.5 * spring.stopStiffness * over * over;
  }
  for (std::size_t s = 0; s < model.pointSprings().size(); ++s) {
    const PointSpring& spring = model.pointSprings()[s];
    const SpringControl& control = loads.pointSprings[s];
    const double x = state.spring[s].length - spring.restLength;
    energy += 0.5 * control.stiffnessFactor * spring.stiffness * x * x - control.loadFactor * spring.preload * x;
  }
  for (std::size_t b = 0; b < model.bushings().size(); ++b) {
    const Bushing& bushing = model.bushings()[b];
    const BushingReading& r = state.bushing[b];
    double sum = 0;
    for (int i = 0; i < 3; ++i)
      sum += bushing.stiffness[i] * r.translation[i] * r.translation[i] +
             bushing.rotationStiffness[i] * r.rotation[i] * r.rotation[i];
    energy += 0.5 * loads.bushings[b].stiffnessFactor * sum;
  }
  return energy;
}

double Ledger::integrationError() const {
  // Large numbers with a small difference: add the rounding errors separately.
  const double burnt = (jointDamping.sum + springDamping.sum) + stopDamping.sum;
  const double lost = driveWork.lost + externalWork.lost - jointDamping.lost - springDamping.lost - stopDamping.lost -
                      potentialGain.lost - elasticGain.lost - kineticWork.lost;
  return driveWork.sum + externalWork.sum - burnt - potentialGain.sum - elasticGain.sum - kineticWork.sum + lost;
}

void beginLedger(const Model& model, State& state, const Loads& loads) {
  const Totals t = totals(model, state, loads);
  state.ledger.begun = 1;
  state.ledger.startKinetic = t.kinetic;
  state.ledger.startLinear = t.linearMomentum, state.ledger.startAngular = t.angularMomentum;
  state.ledger.turnover += t.kinetic;
}

Balance balance(const Model& model, const State& state, const Loads& loads) {
  const Ledger& l = state.ledger;
  Balance b;
  b.now = totals(model, state, loads);
  if (l.begun == 0) return b;
  const Totals& t = b.now;
  b.driveWork = l.driveWork, b.externalWork = l.externalWork;
  b.kineticGain = t.kinetic - l.startKinetic, b.potentialGain = l.potentialGain, b.elasticGain = l.elasticGain;
  b.jointDamping = l.jointDamping, b.springDamping = l.springDamping, b.stopDamping = l.stopDamping;
  b.integrationError = l.integrationError();
  b.leftOver = b.kineticGain - l.kineticWork;
  b.turnover = l.turnover;
  b.linearRemainder = t.linearMomentum - l.startLinear - l.linearImpulse.value();
  b.angularRemainder = t.angularMomentum - l.startAngular - l.angularImpulse.value();
  return b;
}

void StepLedger::addTo(Ledger& ledger) const {
  ledger.kineticWork += kinetic;
  ledger.externalWork += external;
  ledger.potentialGain += potential;
  ledger.elasticGain += elastic;
  ledger.turnover += turnover;
  ledger.jointDamping += jointDamping;
  ledger.springDamping += springDamping;
  ledger.stopDamping += stopDamping;
  ledger.linearImpulse += linear;
  ledger.angularImpulse += angular;
}

} // namespace grouser::multibody
