// SPDX-License-Identifier: BSD-3-Clause
#include "multibody/state.hpp"

#include "base/error.hpp"
#include "multibody/detail/axis_laws.hpp"
#include "multibody/detail/constraint_system.hpp"
#include "multibody/detail/rotation.hpp"
#include "multibody/detail/start.hpp"

#include <cmath>
#include <cstddef>

namespace grouser::multibody {

namespace {

/// Hands every number of a state, in a fixed order, to `f`.
template <class State_, class F> void forEachNumber(State_& s, F f) {
  const auto vec = [&](auto& v) { f(v.x), f(v.y), f(v.z); };
  f(s.time);
  for (auto& X : s.pose) {
    vec(X.position);
    f(X.orientation.w), f(X.orientation.x), f(X.orientation.y), f(X.orientation.z);
  }
  for (auto& V : s.twist) vec(V.v), vec(V.w);
  for (auto& P : s.spinMomentum) vec(P);
  for (auto& j : s.joint) {
    vec(j.force), vec(j.torque);
    f(j.position), f(j.rate), f(j.axisForce), f(j.driveForce), f(j.springForce);
  }
  for (auto& p : s.spring) f(p.force), f(p.length);
  f(s.ledger.gravityWork), f(s.ledger.externalWork), f(s.ledger.driveWork), f(s.ledger.springWork);
  f(s.ledger.dissipated);
  for (auto& a : s.slide) f(a.position), f(a.rate), f(a.axisForce), f(a.driveForce), f(a.springForce);
  for (auto& b : s.bushing) vec(b.force), vec(b.torque), vec(b.translation), vec(b.rotation);
  for (auto& c : s.coupling) f(c.force);
}

} // namespace

std::vector<double> State::save() const {
  std::vector<double> flat;
  forEachNumber(*this, [&](const double& x) { flat.push_back(x); });
  return flat;
}

void State::restore(const std::vector<double>& flat) {
  std::size_t count = 0;
  forEachNumber(*this, [&](double&) { ++count; });
  if (count != flat.size())
    throw base::InputError("multibody state: " + std::to_string(flat.size()) + " numbers stored, this model has " +
                           std::to_string(count) + "; resume with the model that was saved");
  std::size_t i = 0;
  forEachNumber(*this, [&](double& x) { x = flat[i++]; });
}

void detail::findAxes(const ConstraintSystem& system, State& state) {
  std::vector<Frame> frames;
  system.place(state.pose, frames);
  for (std::size_t k = 0; k < system.constraints().size(); ++k) {
    const Constraint& c = system.constraints()[k];
    const auto source = static_cast<std::size_t>(c.source);
    const auto a = static_cast<std::size_t>(c.bodyA), b = static_cast<std::size_t>(c.bodyB);
    const JointFrames f = framesOf(c, frames[a], frames[b]);
    const RowDirections rows = rowDirections(c, f);
    const auto rate = [&](int row) {
      const auto r = static_cast<std::size_t>(row);
      const auto share = [&](int node, std::size_t body) {
        return node < 0 ? 0.0
                        : dot(rows.force[r], state.twist[body].v) +
                              dot(cross(f.p_B - frames[body].p, rows.force[r]) + rows.torque[r], state.twist[body].w);
      };
      return share(c.nodeB, b) - share(c.nodeA, a);
    };
    if (c.kind == ConstraintKind::kPointSpring) {
      state.spring[source].length = axisPosition(c, f, 0);
    } else if (c.kind == ConstraintKind::kBushing) {
      state.bushing[source].translation = {axisPosition(c, f, 0), axisPosition(c, f, 1), axisPosition(c, f, 2)};
      state.bushing[source].rotation = relativeRotation(f);
    } else if (axisRows(c.kind) >> kAxisRow & 1u) {
      state.joint[source].position = axisPosition(c, f, kAxisRow);
      state.joint[source].rate = rate(kAxisRow);
      if (c.kind == ConstraintKind::kCylindrical) {
        state.slide[source].position = axisPosition(c, f, kSlideRow);
        state.slide[source].rate = rate(kSlideRow);
      }
    }
  }
}

State makeState(const Model& model) {
  State s;
  for (const Body& body : model.bodies()) {
    s.pose.push_back(body.pose);
    s.twist.push_back({});
    s.spinMomentum.push_back({});
  }
  s.joint.resize(model.joints().size());
  s.spring.resize(model.pointSprings().size());
  s.bushing.resize(model.bushings().size());
  s.coupling.resize(model.couplings().size());
  for (const Joint& joint : model.joints())
    if (joint.type == JointType::kCylindrical) s.slide.resize(model.joints().size());
  for (std::size_t b = 0; b < s.pose.size(); ++b)
    setTwist(model, s, static_cast<int>(b), {model.bodies()[b].v_WB, model.bodies()[b].w_WB});
  detail::findAxes(detail::ConstraintSystem(model), s);
  return s;
}

Loads makeLoads(const Model& model) {
  Loads loads;
  loads.external.resize(model.bodies().size());
  loads.axisSprings.resize(model.axisSprings().size());
  loads.pointSprings.resize(model.pointSprings().size());
  loads.bushings.resize(model.bushings().size());
  for (const Drive& drive : model.drives()) loads.drives.push_back({drive.on, drive.speed});
  return loads;
}

void setTwist(const Model& model, State& state, int body, const Twist& twist) {
  const auto b = static_cast<std::size_t>(body);
  if (model.bodies()[b].fixed) return;
  state.twist[b] = twist;
  const Mat3d R = state.pose[b].orientation.matrix();
  state.spinMomentum[b] = detail::rotatedInertia(R, model.bodies()[b].inertia_B) * twist.w;
}

void setPose(const Model& model, State& state, int body, const Pose& pose) {
  state.pose[static_cast<std::size_t>(body)] = pose;
  setTwist(model, state, body, state.twist[static_cast<std::size_t>(body)]);
  detail::findAxes(detail::ConstraintSystem(model), state);
}

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
    t.angularMomentum += cross(p, body.mass * V.v) + state.spinMomentum[b];
  }
  for (std::size_t s = 0; s < model.axisSprings().size(); ++s) {
    const AxisSpring& spring = model.axisSprings()[s];
    const SpringControl& control = loads.axisSprings[s];
    const double q = axisReading(model, state, spring.joint, spring.axis).position, x = q - spring.freePosition;
    t.elastic += 0.5 * control.stiffnessFactor * spring.stiffness * x * x - control.loadFactor * spring.preload * x;
    const double over = detail::overLimit(spring, q);
    t.elastic += 0.5 * spring.stopStiffness * over * over;
  }
  for (std::size_t s = 0; s < model.pointSprings().size(); ++s) {
    const PointSpring& spring = model.pointSprings()[s];
    const SpringControl& control = loads.pointSprings[s];
    const double x = state.spring[s].length - spring.restLength;
    t.elastic += 0.5 * control.stiffnessFactor * spring.stiffness * x * x - control.loadFactor * spring.preload * x;
  }
  for (std::size_t b = 0; b < model.bushings().size(); ++b) {
    const Bushing& bushing = model.bushings()[b];
    const BushingReading& r = state.bushing[b];
    double sum = 0;
    for (int i = 0; i < 3; ++i)
      sum += bushing.stiffness[i] * r.translation[i] * r.translation[i] +
             bushing.rotationStiffness[i] * r.rotation[i] * r.rotation[i];
    t.elastic += 0.5 * loads.bushings[b].stiffnessFactor * sum;
  }
  return t;
}

} // namespace grouser::multibody
