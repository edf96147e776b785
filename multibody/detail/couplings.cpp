// SPDX-License-Identifier: BSD-3-Clause
#include "multibody/detail/constraint_system.hpp"

#include "multibody/detail/index.hpp"

#include <cmath>
#include <cstddef>
#include <utility>

namespace grouser::multibody::detail {

void ConstraintSystem::addImpulse(int k, int row, double impulse, std::vector<Vector6>& x) const {
  const Constraint& c = constraints()[at(k)];
  const Vec3d force = impulse * rows(k).force[at(row)], torque = impulse * rows(k).torque[at(row)];
  const auto add = [&](int node, double sign, const Vec3d& com) {
    if (node < 0) return;
    const Vec3d moment = cross(jointFrames(k).p_B - com, force) + torque;
    for (int i = 0; i < 3; ++i) x[at(node)][at(i)] += sign * force[i], x[at(node)][at(3 + i)] += sign * moment[i];
  };
  add(c.nodeB, 1, com_B(k));
  add(c.nodeA, -1, com_A(k));
}

double ConstraintSystem::rowTimes(int k, int row, const std::vector<Vector6>& x) const {
  const Constraint& c = constraints()[at(k)];
  const Vec3d &e = rows(k).force[at(row)], &t = rows(k).torque[at(row)];
  const auto share = [&](int node, const Vec3d& com) {
    if (node < 0) return 0.0;
    const Vector6& v = x[at(node)];
    return dot(e, {v[0], v[1], v[2]}) + dot(cross(jointFrames(k).p_B - com, e) + t, {v[3], v[4], v[5]});
  };
  return share(c.nodeB, com_B(k)) - share(c.nodeA, com_A(k));
}

/// Computes Y and the Cholesky factor of S = b Y. A coupling without a pivot is implied by the others and dropped.
void ConstraintSystem::factorCouplings(const Part& part) {
  for (std::size_t i = 0; i < part.couplings.size(); ++i) {
    const int c = part.couplings[i];
    const CouplingRow& row = couplings()[at(c)];
    const Axis &one = axes()[at(row.axis1)], &two = axes()[at(row.axis2)];
    std::vector<Vector6>& y = couplingSolution_[at(c)];
    for (const int node : part.bodies) y[at(node)] = {};
    for (const int k : part.constraints) y[at(movableBodies() + k)] = {};
    addImpulse(two.constraint, two.row, 1, y);
    addImpulse(one.constraint, one.row, -row.ratio, y);
    elimination_->solve(y.data());

    // Row i of the factor L of S = L L^T, from the rows of previous couplings.
    std::vector<double>& L = couplingFactor_[at(c)];
    for (std::size_t j = 0; j <= i; ++j) {
      const int d = part.couplings[j];
      const CouplingRow& other = couplings()[at(d)];
      const Axis &o1 = axes()[at(other.axis1)], &o2 = axes()[at(other.axis2)];
      double s = rowTimes(o2.constraint, o2.row, y) - other.ratio * rowTimes(o1.constraint, o1.row, y);
      for (std::size_t m = 0; m < j; ++m) s -= L[m] * couplingFactor_[at(d)][m];
      if (j < i) {
        L[j] = couplingKept_[at(d)] ? s / couplingFactor_[at(d)][j] : 0;
        continue;
      }
      const double alone =
          size_[at(two.constraint)][at(two.row)] + row.ratio * row.ratio * size_[at(one.constraint)][at(one.row)];
      couplingKept_[at(c)] = s > Elimination::kPivotTolerance * alone ? 1 : 0;
      L[i] = couplingKept_[at(c)] ? std::sqrt(s) : 1;
    }
  }
}

void ConstraintSystem::solveCouplings(const Part& part, std::vector<Vector6>& x) const {
  std::vector<double>& mu = couplingWork_;
  const std::size_t n = part.couplings.size();
  for (std::size_t i = 0; i < n; ++i) {
    const int c = part.couplings[i];
    const CouplingRow& row = couplings()[at(c)];
    const Axis &one = axes()[at(row.axis1)], &two = axes()[at(row.axis2)];
    double r = x[at(couplingNode(c))][0] - rowTimes(two.constraint, two.row, x) +
               row.ratio * rowTimes(one.constraint, one.row, x);
    for (std::size_t j = 0; j < i; ++j) r -= couplingFactor_[at(c)][j] * mu[j];
    mu[i] = couplingKept_[at(c)] ? r / couplingFactor_[at(c)][i] : 0;
  }
  for (std::size_t i = n; i-- > 0;) {
    const int c = part.couplings[i];
    if (!couplingKept_[at(c)]) continue;
    for (std::size_t j = i + 1; j < n; ++j) mu[i] -= couplingFactor_[at(part.couplings[j])][i] * mu[j];
    mu[i] /= couplingFactor_[at(c)][i];
  }
  for (std::size_t i = 0; i < n; ++i) {
    const int c = part.couplings[i];
    const std::vector<Vector6>& y = couplingSolution_[at(c)];
    const auto add = [&](int node) {
      for (std::size_t r = 0; r < 6; ++r) x[at(node)][r] += mu[i] * y[at(node)][r];
    };
    for (const int node : part.bodies) add(node);
    for (const int k : part.constraints) add(movableBodies() + k);
    x[at(couplingNode(c))] = {};
    x[at(couplingNode(c))][0] = mu[i];
  }
}

} // namespace grouser::multibody::detail
