// SPDX-License-Identifier: BSD-3-Clause
#include "multibody/detail/rattle_step.hpp"

#include "multibody/detail/index.hpp"
#include "multibody/detail/rotation.hpp"
#include "multibody/detail/vector6.hpp"

#include <cmath>

/// Energy and momentum ledger of a stage of RATTLE (scheme: rattle_step.cpp).
///
/// Energy. The first half kick changes the twist of a body from (v_0, w_0) to the mean twist (v, w) by the impulses p
/// and T of all forces at q_0; the second half kick changes it to (v_1, w_1) by the impulses at q_1. Between the kicks
/// the body moves with (v, w), which changes neither |v| nor w.I w. With m (v - v_0) = p,
///   m (v^2 - v_0^2) / 2 = p.(v_0 + v)/2,
/// and with the symmetric inertia I_0 at q_0, the spin S_0 of the node and the spin S = S_0 + T between the kicks,
///   (w.I_0 w - w_0.I_0 w_0) / 2 = I_0 (w - w_0).(w_0 + w)/2 = T.(w_0 + w)/2 + G.(w_0 + w)/2,
///   G = (S_0 - I_0 w_0) - (S - I_0 w):
/// the work of the torques and of the gyroscopic terms (S - I_0 w = g(w), rotation.hpp; S_0 = I_0 w_0). The second kick
/// is analogous with I_1, S and S_1. These equations hold for any h, also for backward stages. p and T are recorded
/// impulses, but S is a state variable: unrecorded changes of the state appear as a difference of kinetic energy.
///
/// Momentum. The first kick changes x_0 x m v + S by x_0 x p + T, the moment of its impulses about the origin; the
/// drift adds h v x m v = 0 and does not change S; the second kick acts likewise at x_1. Row impulses are opposite
/// forces at one point, with opposite torques, and cancel between movable bodies. The sum therefore consists of
/// gravity, loads, and rows to immovable bodies, with (F, p_B x F + M) for the force F at p_B and the torque M.
///
/// If the position solve has relinearised, impulses do not belong to a single position, and the change of momentum
/// itself is recorded. All forces except gravity and loads then count as ground reaction.
namespace grouser::multibody::detail {

void RattleStep::give(int k, int row, double impulse) {
  system_.addImpulse(k, row, impulse, x_);
  if (!toGround_[at(k)]) return;
  const double onMovable = system_.constraints()[at(k)].nodeB >= 0 ? impulse : -impulse;
  const Vec3d force = onMovable * system_.rows(k).force[at(row)];
  stepLedger_.linear += force;
  stepLedger_.angular += cross(system_.jointFrames(k).p_B, force) + onMovable * system_.rows(k).torque[at(row)];
}

void RattleStep::accountFirstKick(const Part& part, const State& state, const Loads& loads, double h) {
  const bool severalPlaces = relinearised_[at(part.index)] != 0;
  for (const int node : part.bodies) {
    const int b = system_.bodyOf(node);
    const Body& body = model_.bodies()[at(b)];
    const Wrench& wrench = loads.external[at(b)];
    Kick kick{state.twist[at(b)],        mean_[at(b)], state.angularMomentum[at(b)], spin_[at(node)], {}, {},
              state.pose[at(b)].position};
    const Vec3d known = 0.5 * h * (wrench.force + body.mass * loads.gravity), torque = 0.5 * h * wrench.torque;
    if (severalPlaces) {
      kick.impulse = body.mass * (kick.after.v - kick.before.v), kick.moment = kick.spinAfter - kick.spinBefore;
      stepLedger_.linear += kick.impulse - known;
      stepLedger_.angular += cross(kick.place, kick.impulse - known) + (kick.moment - torque);
      recordKick(b, rotatedInertia(frames_[at(b)].R, body.inertia_B), kick, loads, h);
      continue;
    }
    kick.impulse = known + linear(x_[at(node)]), kick.moment = torque + angular(x_[at(node)]);
    recordKick(b, system_.inertia(node), kick, loads, h);
  }
}

void RattleStep::bookSecondKick(const Part& part, const Loads& loads, double h) {
  for (const int node : part.bodies) {
    const int b = system_.bodyOf(node);
    const Kick kick{mean_[at(b)],
                    twist_[at(b)],
                    meanSpin_[at(node)],
                    spin_[at(node)],
                    linear(kick_[at(node)]) + linear(x_[at(node)]),
                    angular(kick_[at(node)]) + angular(x_[at(node)]),
                    trialPose_[at(b)].position};
    recordKick(b, system_.inertia(node), kick, loads, h);
  }
}

/// Ledger of a half kick of one body.
void RattleStep::recordKick(int b, const Mat3d& inertia, const Kick& kick, const Loads& loads, double h) {
  const Wrench& wrench = loads.external[at(b)];
  const Vec3d v = 0.5 * (kick.before.v + kick.after.v), w = 0.5 * (kick.before.w + kick.after.w);
  const Vec3d weight = 0.5 * h * model_.bodies()[at(b)].mass * loads.gravity, load = 0.5 * h * wrench.force,
              torque = 0.5 * h * wrench.torque;
  const double gravity = dot(weight, v), external = dot(load, v) + dot(torque, w);
  const double all = dot(kick.impulse, v) + dot(kick.moment, w);
  const Vec3d unlike = (kick.spinBefore - kick.spinAfter) - inertia * (kick.before.w - kick.after.w);
  const double gyroscopic = dot(unlike, w);
  stepLedger_.kinetic += all + gyroscopic;
  stepLedger_.external += external;
  stepLedger_.turnover +=
      std::fabs(gravity) + std::fabs(external) + std::fabs(all - gravity - external) + std::fabs(gyroscopic);
  stepLedger_.linear += weight + load;
  stepLedger_.angular += cross(kick.place, weight + load) + torque;
}

} // namespace grouser::multibody::detail
