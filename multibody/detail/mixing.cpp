// SPDX-License-Identifier: BSD-3-Clause
#include "multibody/detail/mixing.hpp"

#include "multibody/detail/index.hpp"

#include <cstddef>

namespace grouser::multibody::detail {

void Mixing::improve(const ConstraintSystem::Part& part, const Iterate& iterate, std::vector<Vector6>& x) {
  const auto forAll = [&](auto&& f) {
    for (const int node : part.bodies) {
      const Twist& V = iterate.twist[at(system_.bodyOf(node))];
      const Mat3d& I = system_.inertia(node);
      const double mass = model_.bodies()[at(system_.bodyOf(node))].mass,
                   spread = (I.m[0][0] + I.m[1][1] + I.m[2][2]) / 3;
      for (int i = 0; i < 3; ++i) f(V.v[i], x[at(node)][at(i)], mass);
      for (int i = 0; i < 3; ++i) f(V.w[i], x[at(node)][at(3 + i)], spread);
    }
    for (const int k : part.constraints)
      for (std::size_t r = 0; r < 6; ++r) f(iterate.impulse[at(k)][r], x[at(system_.movableBodies() + k)][r], 0.0);
    for (const int c : part.couplings) f(iterate.couplingImpulse[at(c)], x[at(system_.couplingNode(c))][0], 0.0);
  };
  std::size_t n = 0;
  forAll([&](double value, double& correction, double weight) {
    z_[n] = value, change_[n] = correction, weight_[n] = weight;
    ++n;
  });
  acceleration_.improve(z_, change_, weight_, n);
  n = 0;
  forAll([&](double, double& correction, double) { correction = change_[n++]; });
}

void Mixing::remember(const ConstraintSystem::Part& part, double gap, const std::vector<Twist>& twist) {
  if (!(gap < bestGap_)) return;
  bestGap_ = gap;
  for (const int node : part.bodies) best_[at(system_.bodyOf(node))] = twist[at(system_.bodyOf(node))];
}

void Mixing::takeBest(const ConstraintSystem::Part& part, std::vector<Twist>& twist) const {
  for (const int node : part.bodies) twist[at(system_.bodyOf(node))] = best_[at(system_.bodyOf(node))];
}

} // namespace grouser::multibody::detail
