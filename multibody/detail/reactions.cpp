// SPDX-License-Identifier: BSD-3-Clause
#include "multibody/detail/reactions.hpp"

#include "multibody/detail/index.hpp"
#include "multibody/detail/vector6.hpp"

#include <cstddef>

namespace grouser::multibody::detail {

void solveReactions(const ConstraintSystem& system, const Model& model, const ConstraintSystem::Part& part,
                    const std::vector<Frame>& frames, const State& state, const Loads& loads,
                    const std::vector<SoftRow>& soft, const std::vector<double>& force, std::vector<Vector6>& x) {
  const auto twistOf = [&](int body) { return at(body) < state.twist.size() ? state.twist[at(body)] : Twist{}; };
  const auto biasOf = [&](int k, double(&bias)[6]) {
    const Constraint& c = system.constraints()[at(k)];
    rowBias(c, system.jointFrames(k), frames[at(c.bodyA)], frames[at(c.bodyB)], twistOf(c.bodyA), twistOf(c.bodyB),
            bias);
  };
  for (const int node : part.bodies) {
    const int b = system.bodyOf(node);
    const Wrench& wrench = loads.external[at(b)];
    set(x[at(node)], wrench.force + model.bodies()[at(b)].mass * loads.gravity,
        wrench.torque - cross(state.twist[at(b)].w, state.angularMomentum[at(b)]));
  }
  for (const int k : part.constraints) {
    double bias[6];
    biasOf(k, bias);
    Vector6& residual = x[at(system.movableBodies() + k)];
    residual = {};
    for (int r = 0; r < 6; ++r)
      if (system.hardRowsOf(k) >> r & 1u) residual[at(r)] = -bias[r];
    for (int a = system.firstAxis(k); a < system.firstAxis(k + 1); ++a) {
      const int row = system.axes()[at(a)].row;
      if (force[at(a)] != 0) system.addImpulse(k, row, force[at(a)], x);
      if (soft[at(a)].driven) residual[at(row)] = soft[at(a)].acceleration - bias[row];
    }
  }
  for (const int c : part.couplings) {
    const CouplingRow& row = system.couplings()[at(c)];
    double bias[2];
    for (int i = 0; i < 2; ++i) {
      const Axis& a = system.axes()[at(i == 0 ? row.axis1 : row.axis2)];
      double all[6];
      biasOf(a.constraint, all);
      bias[i] = all[a.row];
    }
    x[at(system.couplingNode(c))] = {};
    x[at(system.couplingNode(c))][0] = row.ratio * bias[0] - bias[1];
  }
  system.solve(part, x);
}

} // namespace grouser::multibody::detail
