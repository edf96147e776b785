// SPDX-License-Identifier: BSD-3-Clause
#include "multibody/state.hpp"

#include "base/error.hpp"
#include "multibody/detail/constraint_graph.hpp"
#include "multibody/detail/index.hpp"
#include "multibody/detail/rotation.hpp"

#include <cmath>
#include <cstddef>

namespace grouser::multibody {

using namespace detail;

namespace {

/// Calls `f` for the State::kBooks numbers of the ledger.
template <class Ledger_, class F> void forEachBook(Ledger_& l, F f) {
  f(l.gravityWork.lost), f(l.externalWork.lost), f(l.driveWork.lost), f(l.springWork.lost), f(l.dissipated.lost);
  const auto sum = [&](auto& s) { f(s.sum), f(s.lost); };
  sum(l.kineticWork), sum(l.potentialGain), sum(l.elasticGain), sum(l.turnover);
  sum(l.jointDamping), sum(l.springDamping), sum(l.stopDamping);
  for (auto* v : {&l.linearImpulse, &l.angularImpulse}) sum(v->x), sum(v->y), sum(v->z);
  f(l.begun), f(l.startKinetic);
  for (auto* v : {&l.startLinear, &l.startAngular}) f(v->x), f(v->y), f(v->z);
}

/// Calls `f` for every number of a state, in a fixed order.
template <class State_, class F> void forEachNumber(State_& s, F f) {
  const auto vec = [&](auto& v) { f(v.x), f(v.y), f(v.z); };
  f(s.time);
  for (auto& X : s.pose) {
    vec(X.position);
    f(X.orientation.w), f(X.orientation.x), f(X.orientation.y), f(X.orientation.z);
  }
  for (auto& V : s.twist) vec(V.v), vec(V.w);
  for (auto& P : s.angularMomentum) vec(P);
  for (auto& j : s.joint) {
    vec(j.force), vec(j.torque);
    f(j.position), f(j.rate), f(j.axisForce), f(j.driveForce), f(j.springForce);
  }
  for (auto& p : s.spring) f(p.force), f(p.length);
  f(s.ledger.gravityWork.sum), f(s.ledger.externalWork.sum), f(s.ledger.driveWork.sum), f(s.ledger.springWork.sum);
  f(s.ledger.dissipated.sum);
  for (auto& a : s.slide) f(a.position), f(a.rate), f(a.axisForce), f(a.driveForce), f(a.springForce);
  for (auto& b : s.bushing) vec(b.force), vec(b.torque), vec(b.translation), vec(b.rotation);
  for (auto& c : s.coupling) f(c.force);
  forEachBook(s.ledger, f);
}

/// Computes the positions and rates of axes, and the readings of springs and bushings, from poses and twists; angles
/// are within half a turn.
void findAxes(const ConstraintGraph& graph, State& state) {
  std::vector<Frame> frames;
  graph.place(state.pose, frames);
  for (const auto& c : graph.constraints()) {
    const std::size_t source = at(c.source);
    const JointFrames f = framesOf(c, frames[at(c.bodyA)], frames[at(c.bodyB)]);
    const RowDirections rows = rowDirections(c, f);
    const auto rate = [&](int row) { return rowRate(c, f, rows, row, frames, state.twist); };
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
    throw base::InputError("multibody state: " + std::to_string(flat.size()) + " numbers stored, but this model has " +
                           std::to_string(count) + "; resume with the model of the checkpoint");
  std::size_t i = 0;
  forEachNumber(*this, [&](double& x) { x = flat[i++]; });
}

State makeState(const Model& model) {
  State s;
  for (const Body& body : model.bodies()) {
    s.pose.push_back(body.pose);
    s.twist.push_back({});
    s.angularMomentum.push_back({});
  }
  s.joint.resize(model.joints().size());
  s.spring.resize(model.pointSprings().size());
  s.bushing.resize(model.bushings().size());
  s.coupling.resize(model.couplings().size());
  for (const Joint& joint : model.joints())
    if (joint.type == JointType::kCylindrical) s.slide.resize(model.joints().size());
  for (std::size_t b = 0; b < s.pose.size(); ++b)
    setTwist(model, s, static_cast<int>(b), {model.bodies()[b].v_WB, model.bodies()[b].w_WB});
  findAxes(ConstraintGraph(model), s);
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
  const std::size_t b = at(body);
  if (model.bodies()[b].fixed) return;
  state.twist[b] = twist;
  const Mat3d R = state.pose[b].orientation.matrix();
  state.angularMomentum[b] = rotatedInertia(R, model.bodies()[b].inertia_B) * twist.w;
}

} // namespace grouser::multibody
