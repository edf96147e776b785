// SPDX-License-Identifier: BSD-3-Clause
#include "multibody/detail/rattle_step.hpp"

#include "multibody/detail/index.hpp"
#include "multibody/detail/rotation.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

/// The scheme. Over a stage of length h, from positions q_0 and momenta p_0 (m v; S = I w) to q_1, p_1, with u the mean
/// twist, Lambda and Mu impulses:
///
///   P(u; q_0)  = p_0 + h/2 f(q_0) + J(q_0)^T Lambda      P: m v, and for the spin S(w) = I w + g(w) of rotation.hpp
///   q_1        = q_0 moved by h u                        rotation by exp(h w)
///   C(q_1)     = 0                                       determines Lambda: joints, couplings, imposed positions
///   p_1        = P(u) + h/2 f(q_1) + J(q_1)^T Mu         the spin P(u) is the same world vector at either end
///   J(q_1) v_1 = 0                                       determines Mu; imposed rates on driven rows
///
/// RATTLE (Andersen 1983, J. Comput. Phys. 52:24) with the discrete Lagrangian mechanics of the rotation group
/// (Bou-Rabee and Marsden 2009, Found. Comput. Math. 9:197): order 2, symplectic, time-reversible. Both ends satisfy
/// position and velocity constraints. Forces between bodies are equal and opposite impulses at one point, so linear and
/// angular momentum are conserved to round-off.
///
/// Forces along axis rows, with positions x0, x1 at the ends:
///   explicit springs   in f, at both nodes
///   implicit parts     F = -k (x0 + x1)/2 + constant (implicit springs) - c (x1 - x0)/h + stops(x0, x1),
///                      an impulse h/2 F along the row of q_0 in the first, of q_1 in the last equation.
/// The implicit part is the midpoint rule, for stops a discrete gradient: symmetric in time, stable at any h in the
/// linear case, with an exact energy balance along the row. In Newton's method it is a soft row:
///   J du + G dLambda = G (h/2 F - Lambda),   1/G = h^2/2 D,   D = -dF/dx1 = k/2 + c/h + stops.
///
/// Newton's method uses the matrix at q_0 on both sides, although Lambda acts along J(q_0) and gaps close along J(q_1);
/// each correction is h |w| times the previous one. If a singular position is near q_0 and q_1 or between them, some
/// pivots have another size or sign at q_1, and the iteration is too slow or diverges. The solve then starts without
/// these rows, which leads to the inertial motion, close to the solution (other solutions are on the branches that meet
/// in the singular position). It continues with all rows and mixed corrections (mixing.hpp) of the same equations. If
/// this fails (q_0 is nearly singular), the weak rows are closed with the matrix of each iterate, by the smallest
/// corrections in the norm of kinetic energy. Slow iterations without weak rows are mixed immediately.
///
/// The first three equations are set up in rattle_position.cpp and solved in rattle_phases.cpp, the last two are solved
/// in rattle_velocity.cpp.
///
/// Orders 4, 6, 8 are symmetric compositions of stages gamma_i dt.
namespace grouser::multibody::detail {

namespace {

/// First halves of the symmetric sequences gamma_i; the middle stage is last.
/// Order 4: Suzuki 1990, Phys. Lett. A 146:319. Orders 6, 8: Kahan and Li 1997, Math. Comput. 66:1089 (also Hairer,
/// Lubich and Wanner 2006, V.3.2).
const std::vector<double>& halfComposition(int order) {
  static const std::vector<double> two{1.0};
  static const std::vector<double> four{0.41449077179437573714, 0.41449077179437573714, -0.65796308717750294857};
  static const std::vector<double> six{0.39216144400731413928, 0.33259913678935943860, -0.70624617255763935981,
                                       0.08221359629355080023, 0.79854399093482996340};
  static const std::vector<double> eight{0.13020248308889008088, 0.56116298177510838456,  -0.38947496264484728641,
                                         0.15884190655515560090, -0.39590389413323757734, 0.18453964097831570709,
                                         0.25837438768632204729, 0.29501172360931029887,  -0.60550853383003451170};
  return order == 2 ? two : order == 4 ? four : order == 6 ? six : eight;
}

} // namespace

/// Smallest omega dt at which the absolute trace of the step matrix of an oscillator reaches 2, for the compositions
/// above.
double stabilityLimit(int order) { return order == 2 ? 2 : order == 4 ? 2.7209 : order == 6 ? 2.5326 : 3.0964; }

RattleStep::RattleStep(const Problem& problem)
    : model_(problem.model), options_(problem.options), system_(problem.system), last_(problem.last),
      softRows_(model_, system_, problem.driveStart), implicitSprings_(options_.springs == Springs::kImplicit),
      soft_(system_.axes().size()), x0_(system_.axes().size(), 0.0), x1_(x0_), softImpulse_(x0_), startRate_(x0_),
      axisRate_(x0_), springForce_(x0_), axisForce_(x0_), laws_(system_.axes().size()), x_(at(system_.nodes())),
      impulse_(system_.constraints().size()), endImpulse_(impulse_), couplingImpulse_(system_.couplings().size(), 0.0),
      couplingEndImpulse_(couplingImpulse_), gyro_(at(system_.movableBodies())), spin_(gyro_),
      mean_(model_.bodies().size()), twist_(mean_), trialPose_(model_.bodies().size()),
      startFrames_(system_.constraints().size()), trialFrames_(startFrames_), relinearised_(system_.parts().size(), 0),
      factored_(system_.parts().size(), -1), gapOf_(system_.parts().size(), 0.0), mixing_(system_, model_),
      drivenThen_(system_.axes().size(), 0) {
  for (std::size_t b = 0; b < model_.bodies().size(); ++b) trialPose_[b] = model_.bodies()[b].pose;
  system_.place(trialPose_, frames_);
  trial_ = frames_;
  kick_.resize(at(system_.movableBodies()));
  meanSpin_.resize(kick_.size());
  for (const Constraint& c : system_.constraints()) toGround_.push_back(c.nodeA < 0 || c.nodeB < 0 ? 1 : 0);
  for (int node = 0; node < system_.movableBodies(); ++node)
    inertiaSpread_.push_back(spreadOf(model_.bodies()[at(system_.bodyOf(node))].inertia_B));
}

void RattleStep::step(State& state, const Loads& loads, double dt) {
  const double start = state.time;
  // Pose changes invalidate cached factors.
  for (std::size_t b = 0; b < state.pose.size(); ++b) {
    const Pose &a = state.pose[b], &c = trialPose_[b];
    if (!(a.position == c.position) || a.orientation.w != c.orientation.w || a.orientation.x != c.orientation.x ||
        a.orientation.y != c.orientation.y || a.orientation.z != c.orientation.z)
      std::fill(factored_.begin(), factored_.end(), -1);
  }
  system_.place(state.pose, frames_);
  const std::vector<double>& half = halfComposition(options_.order);
  const int stages = 2 * static_cast<int>(half.size()) - 1;
  double done = 0;
  for (int i = 0; i < stages; ++i) {
    const double gamma = half[at(std::min(i, stages - 1 - i))];
    stageTime_ = start + done * dt;
    stage(state, loads, gamma * dt);
    done += gamma;
  }
  state.time = start + dt;
  for (const Part& part : system_.parts()) readReactions(part, state, loads);
}

void RattleStep::stage(State& state, const Loads& loads, double h) {
  softRows_.evaluate(loads, stageTime_, h, soft_);
  for (const Part& part : system_.parts()) {
    solvePositions(part, state, loads, h);
    solveVelocities(part, loads, h);
    finish(part, state, loads, h);
  }
}

int RattleStep::linearise(const Part& part, const std::vector<Frame>& where) {
  const int lost = system_.linearise(part, where, laws_);
  last_.singularRows = std::max(last_.singularRows, lost);
  return lost;
}

/// True if the system still contains the matrix of the end of the previous stage and this stage can use it.
bool RattleStep::positionsFactored(const Part& part) const {
  if (factored_[at(part.index)] != system_.linearisation(part)) return false;
  for (const int k : part.constraints)
    for (int a = system_.firstAxis(k); a < system_.firstAxis(k + 1); ++a)
      if (laws_[at(a)].inverseCompliance != 0 || laws_[at(a)].driven != (drivenThen_[at(a)] != 0)) return false;
  return true;
}

} // namespace grouser::multibody::detail
