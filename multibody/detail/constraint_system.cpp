// SPDX-License-Identifier: BSD-3-Clause
#include "multibody/detail/constraint_system.hpp"

#include "multibody/detail/index.hpp"
#include "multibody/detail/rotation.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace grouser::multibody::detail {

ConstraintSystem::ConstraintSystem(const Model& model)
    : ConstraintGraph(model), elimination_(std::make_unique<Elimination>(movableBodies(), edges())) {
  const std::size_t count = constraints().size();
  for (const Constraint& c : constraints()) hard_.push_back(hardRows(c.kind));
  active_.assign(hard_.begin(), hard_.end());
  linearisation_.assign(parts().size(), 0);
  redundant_.assign(count, 0);
  expectedLost_.assign(parts().size(), 0);
  couplingSolution_.assign(couplings().size(), std::vector<Vector6>(at(nodes())));
  couplingFactor_.assign(couplings().size(), std::vector<double>(couplings().size()));
  couplingKept_.assign(couplings().size(), 1);
  couplingWork_.resize(couplings().size());
  size_.resize(count);
  rows_.resize(count);
  frames_.resize(count);
  inertia_.resize(at(movableBodies()));
  com_A_.resize(count);
  com_B_.resize(count);
  makeLinks();
}

/// J M^-1 J^T of each single row, computed once with the mean moment of inertia.
void ConstraintSystem::setSizes() {
  for (int k = 0; k < static_cast<int>(constraints().size()); ++k) {
    Block jacobianA{}, jacobianB{};
    rowBlocks(rows(k), jointFrames(k).p_B, com_A(k), com_B(k), jacobianA, jacobianB);
    const auto add = [&](int node, const Block& J) {
      if (node < 0) return;
      const double m = 1 / model().bodies()[at(bodyOf(node))].mass;
      const Mat3d& I = inertia(node);
      const double i = 3 / (I.m[0][0] + I.m[1][1] + I.m[2][2]);
      for (std::size_t r = 0; r < 6; ++r)
        for (std::size_t c = 0; c < 6; ++c)
          size_[at(k)][r] += (c < 3 ? m : i) * J[kStride * c + r] * J[kStride * c + r];
    };
    add(constraints()[at(k)].nodeA, jacobianA);
    add(constraints()[at(k)].nodeB, jacobianB);
  }
  sized_ = true;
  for (int k = 0; k < static_cast<int>(constraints().size()); ++k) setPivotThreshold(k);
}

/// In redundant constraints, keeps only rows with a good pivot: the dependent row may change during motion, and if a
/// wrong row is dropped, a small pivot remains.
void ConstraintSystem::setPivotThreshold(int k) {
  constexpr double kGoodPivot = 1e-3;
  double part = pivotScale_ * Elimination::kPivotTolerance;
  if (redundant_[at(k)] != 0 && !strict_) part = std::max(part, kGoodPivot);
  double smallest[6];
  for (std::size_t r = 0; r < 6; ++r) smallest[r] = part * size_[at(k)][r];
  elimination_->setSmallestPivots(k, smallest);
}

void ConstraintSystem::noteRedundant(int constraint, int row) {
  redundant_[at(constraint)] |= 1u << row;
  if (sized_) setPivotThreshold(constraint);
  for (const Part& part : parts())
    if (std::find(part.constraints.begin(), part.constraints.end(), constraint) != part.constraints.end())
      ++expectedLost_[at(part.index)];
}

void ConstraintSystem::scalePivotThreshold(double scale) {
  pivotScale_ = scale;
  for (int k = 0; sized_ && k < static_cast<int>(constraints().size()); ++k) setPivotThreshold(k);
}

/// With redundant rows, first keeps only rows with good pivots. If this loses more rows than the redundant ones, a
/// singular position is near; then every row with a pivot is kept.
int ConstraintSystem::linearise(const Part& part, const std::vector<Frame>& frames, const std::vector<AxisLaw>& laws) {
  ++linearisation_[at(part.index)];
  setUp(frames, laws);
  if (!sized_) setSizes();
  int omitted = elimination_->factor();
  const int expected = expectedLost_[at(part.index)];
  if (expected > 0) {
    if (omitted > expected) {
      strict_ = true;
      for (const int k : part.constraints)
        if (redundant_[at(k)]) setPivotThreshold(k);
      omitted = elimination_->factor();
      strict_ = false;
      for (const int k : part.constraints)
        if (redundant_[at(k)]) setPivotThreshold(k);
    }
    for (const int k : part.constraints) hard_[at(k)] = hardRows(constraints()[at(k)].kind) & elimination_->keptRows(k);
    omitted = std::max(omitted - expected, 0);
  }
  if (couplingsOn_ && !part.couplings.empty()) factorCouplings(part);
  return omitted;
}

void ConstraintSystem::setUp(const std::vector<Frame>& frames, const std::vector<AxisLaw>& laws) {
  packed_ = true;
  lineariseLinks(frames, laws);
  for (const int k : offTree_) {
    const Constraint& c = constraints()[at(k)];
    placeFrames(c, frames[at(c.bodyA)], frames[at(c.bodyB)], frames_[at(k)]);
    setRowDirections(c, frames_[at(k)], rows_[at(k)]);
    com_A_[at(k)] = frames[at(c.bodyA)].p;
    com_B_[at(k)] = frames[at(c.bodyB)].p;

    // A soft row has compliance; a driven row is hard; a free axis is not part of the system.
    double compliance[6] = {};
    unsigned active = hardRows(c.kind);
    for (int a = firstAxis(k); a < firstAxis(k + 1); ++a) {
      const AxisLaw& law = laws[at(a)];
      const int row = axes()[at(a)].row;
      if (law.driven || law.inverseCompliance != 0) active |= 1u << row;
      if (!law.driven && law.inverseCompliance != 0) compliance[row] = 1 / law.inverseCompliance;
    }
    active_[at(k)] = active;

    elimination_->setJoint(k, rows_[at(k)], frames_[at(k)].p_B, com_A_[at(k)], com_B_[at(k)], compliance, active);
  }
}

void ConstraintSystem::solve(const Part& part, std::vector<Vector6>& x) const {
  elimination_->solve(x.data());
  if (couplingsOn_ && !part.couplings.empty()) solveCouplings(part, x);
}

double ConstraintSystem::rate(int k, int row, const std::vector<Twist>& twist) const {
  const Constraint& c = constraints()[at(k)];
  const Vec3d &e = rows(k).force[at(row)], &t = rows(k).torque[at(row)];
  double sum = 0;
  if (c.nodeB >= 0) {
    const Twist& V = twist[at(c.bodyB)];
    sum += dot(e, V.v) + dot(cross(jointFrames(k).p_B - com_B(k), e) + t, V.w);
  }
  if (c.nodeA >= 0) {
    const Twist& V = twist[at(c.bodyA)];
    sum -= dot(e, V.v) + dot(cross(jointFrames(k).p_B - com_A(k), e) + t, V.w);
  }
  return sum;
}

} // namespace grouser::multibody::detail
