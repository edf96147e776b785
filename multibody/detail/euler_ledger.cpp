// SPDX-License-Identifier: BSD-3-Clause
#include "multibody/detail/euler_step.hpp"

#include "multibody/detail/axis_springs.hpp"
#include "multibody/detail/index.hpp"
#include "multibody/detail/rotation.hpp"

#include <cmath>

/// Energy and momentum ledger of a step of symplectic Euler (scheme: euler_step.cpp). euler_links.cpp sums the bodies
/// and joints of the spanning tree, four at a time; this file sums the rest.
///
/// Energy. All impulses of a step act at q and change the twist from (v_0, w_0) to (v, w). As in RATTLE
/// (rattle_ledger.cpp), the kinetic energy of each body changes by p.(v_0 + v)/2 + T.(w_0 + w)/2 + G.(w_0 + w)/2, with
/// the inertia I at q; the motion with (v_0, w_0) to q has not changed w_0.I w_0. With S_0 + T = I w + g, where g is
/// the gyroscopic momentum used in the solution,
///   G = (S_0 - I w_0) - g.
/// The residual g - g(w) of the last iterate remains in the spin and thus in S_0 of the next step. A constraint exerts
/// F and M at p_B on B and the opposite on A; its work is F.(u_0 + u)/2 + M.(r_0 + r)/2, where u is the velocity of
/// p_B as a point of B minus its velocity as a point of A, and r = w_B - w_A.
///
/// Momentum. The impulses change x x m v + S by x x p + T; the motion of the bodies does not change it, since x moves
/// along v. Contributions of movable bodies cancel; an immovable body contributes (F, p_B x F + M).
///
/// If rows of several positions act in a step (relinearised), the change of momentum itself is used; everything except
/// gravity and loads counts as ground reaction.
namespace grouser::multibody::detail {

namespace {
Vec3d laneOf(const Vec3L& v, int l) { return {v.x[l], v.y[l], v.z[l]}; }

/// Energy gain of a spring F = load - stiffness (x - rest) from x0 to x1, without cancellation of two large energies.
double gainOf(double load, double stiffness, double rest, double x0, double x1) {
  return (x1 - x0) * (stiffness * (0.5 * (x0 + x1) - rest) - load);
}
} // namespace

Twist EulerStep::relativeTwist(int k, const std::vector<Twist>& twist) const {
  const Constraint& c = system_.constraints()[at(k)];
  const Vec3d& p = system_.jointFrames(k).p_B;
  Twist motion;
  if (c.nodeB >= 0) {
    const Twist& V = twist[at(c.bodyB)];
    motion.v += V.v + cross(V.w, p - system_.com_B(k)), motion.w += V.w;
  }
  if (c.nodeA >= 0) {
    const Twist& V = twist[at(c.bodyA)];
    motion.v -= V.v + cross(V.w, p - system_.com_A(k)), motion.w -= V.w;
  }
  return motion;
}

/// Records the motion, before the step, of the constraints outside the spanning tree.
void EulerStep::noteOldMotion(const ConstraintSystem::Part& part, const State& state) {
  for (const int k : system_.offTree()) oldMotion_[at(k)] = relativeTwist(k, state.twist);
  for (const int c : part.couplings) {
    const CouplingRow& row = system_.couplings()[at(c)];
    oldCouplingRate_[2 * at(c)] = system_.rateOfAxis(row.axis1, state.twist);
    oldCouplingRate_[2 * at(c) + 1] = system_.rateOfAxis(row.axis2, state.twist);
  }
}

void EulerStep::noteOldLengths(const State& state) {
  oldLength_.clear();
  for (const SpringPlace& p : springPlace_) oldLength_.push_back(positionIn(state, p));
  for (const SpringReading& spring : state.spring) oldLength_.push_back(spring.length);
  for (const BushingReading& b : state.bushing)
    for (const double x : {b.translation.x, b.translation.y, b.translation.z, b.rotation.x, b.rotation.y, b.rotation.z})
      oldLength_.push_back(x);
}

void EulerStep::recordElasticGain(State& state, const Loads& loads) const {
  double gain = 0;
  const double* x0 = oldLength_.data();
  for (std::size_t s = 0; s < springPlace_.size(); ++s, ++x0) {
    const AxisSpring& spring = model_.axisSprings()[s];
    const LinearSpring linear = linearSpring(spring, loads.axisSprings[s]);
    const double x1 = positionIn(state, springPlace_[s]);
    gain += gainOf(linear.load, linear.stiffness, linear.rest, *x0, x1);
    if (spring.stopStiffness == 0) continue;
    const double over0 = overLimit(spring, *x0), over1 = overLimit(spring, x1);
    gain += 0.5 * spring.stopStiffness * (over1 - over0) * (over1 + over0);
  }
  for (std::size_t s = 0; s < state.spring.size(); ++s, ++x0) {
    const PointSpring& spring = model_.pointSprings()[s];
    const SpringControl& control = loads.pointSprings[s];
    gain += gainOf(control.loadFactor * spring.preload, control.stiffnessFactor * spring.stiffness, spring.restLength,
                   *x0, state.spring[s].length);
  }
  for (std::size_t b = 0; b < state.bushing.size(); ++b) {
    const Bushing& bushing = model_.bushings()[b];
    const double factor = loads.bushings[b].stiffnessFactor;
    for (int i = 0; i < 6; ++i, ++x0)
      gain += gainOf(0, factor * (i < 3 ? bushing.stiffness[i] : bushing.rotationStiffness[i - 3]), 0, *x0,
                     i < 3 ? state.bushing[b].translation[i] : state.bushing[b].rotation[i - 3]);
  }
  state.ledger.elasticGain += gain;
}

void EulerStep::recordWork(double work) {
  stepLedger_.kinetic += work;
  stepLedger_.turnover += std::fabs(work);
}

void EulerStep::recordCoupling(int c, const State& state) {
  const CouplingRow& row = system_.couplings()[at(c)];
  const double impulse2 = couplingImpulse_[at(c)], impulse1 = -row.ratio * impulse2;
  recordWork(0.5 * impulse1 * (oldCouplingRate_[2 * at(c)] + system_.rateOfAxis(row.axis1, state.twist)) +
             0.5 * impulse2 * (oldCouplingRate_[2 * at(c) + 1] + system_.rateOfAxis(row.axis2, state.twist)));
  const Axis &one = system_.axes()[at(row.axis1)], &two = system_.axes()[at(row.axis2)];
  const RowDirections &rows1 = system_.rows(one.constraint), &rows2 = system_.rows(two.constraint);
  recordGround(one.constraint, impulse1 * rows1.force[at(one.row)], impulse1 * rows1.torque[at(one.row)]);
  recordGround(two.constraint, impulse2 * rows2.force[at(two.row)], impulse2 * rows2.torque[at(two.row)]);
}

/// `force`, `torque`: impulse on B at p_B [N s, N m s].
void EulerStep::recordConstraint(int k, const Vec3d& force, const Vec3d& torque, const State& state) {
  const Twist motion = relativeTwist(k, state.twist);
  recordWork(0.5 * dot(force, oldMotion_[at(k)].v + motion.v) + 0.5 * dot(torque, oldMotion_[at(k)].w + motion.w));
  recordGround(k, force, torque);
}

/// Adds the impulse of an immovable body.
void EulerStep::recordGround(int k, const Vec3d& force, const Vec3d& torque) {
  const Constraint& c = system_.constraints()[at(k)];
  if (c.nodeA >= 0 && c.nodeB >= 0) return;
  const double side = c.nodeB >= 0 ? 1 : -1;
  stepLedger_.linear += side * force;
  stepLedger_.angular += side * (cross(system_.jointFrames(k).p_B, force) + torque);
}

/// Gyroscopic momentum computed from the spins: after mixed corrections it differs from that of the last iterate.
void EulerStep::recordMixedSpins(const State& state) {
  for (std::size_t i = 0; i < steps_.size(); ++i) {
    const LinkLanes& links = system_.links()[i];
    const LinkStep& s = steps_[i];
    for (int l = 0; l < links.count; ++l) {
      const std::size_t b = at(links.body[at(l)]);
      const Mat3d I = rotatedInertia(frames_[b].R, model_.bodies()[b].inertia_B);
      const Vec3d w0 = laneOf(s.w0, l), w = state.twist[b].w;
      const Vec3d unlike = (oldSpin_[b] - state.angularMomentum[b]) - I * (w0 - w);
      recordWork(0.5 * dot(unlike - laneOf(s.gyroLeft, l), w0 + w));
    }
  }
}

void EulerStep::bookSeveralPlaces(const State& state) {
  stepLedger_.kinetic = stepLedger_.turnover = 0, stepLedger_.linear = stepLedger_.angular = {};
  for (std::size_t i = 0; i < steps_.size(); ++i) {
    const LinkLanes& links = system_.links()[i];
    const LinkStep& s = steps_[i];
    for (int l = 0; l < links.count; ++l) {
      const std::size_t b = at(links.body[at(l)]);
      const Body& body = model_.bodies()[b];
      const Mat3d I = rotatedInertia(frames_[b].R, body.inertia_B);
      const Vec3d v0 = laneOf(s.v0, l), w0 = laneOf(s.w0, l), v = state.twist[b].v, w = state.twist[b].w;
      const Vec3d impulse = body.mass * (v - v0);
      recordWork(0.5 * dot(impulse, v0 + v) + 0.5 * dot(I * (w - w0), w0 + w));
      stepLedger_.linear += impulse;
      stepLedger_.angular += cross(laneOf(s.position, l), impulse) + (state.angularMomentum[b] - oldSpin_[b]);
    }
  }
}

} // namespace grouser::multibody::detail
