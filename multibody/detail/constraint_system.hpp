// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "multibody/detail/constraint_graph.hpp"
#include "multibody/detail/elimination.hpp"
#include "multibody/detail/link_simd.hpp"
#include "multibody/spatial.hpp"

#include <array>
#include <memory>
#include <vector>

namespace grouser::multibody::detail {

/// Forces along an axis row (of a joint, point spring or bushing) in one step (axis_laws.hpp).
struct AxisLaw {
  double force = 0;             ///< known force along the row [N, N m]
  double known = 0;             ///< part of spring and stop forces that does not depend on the new rate
  double driveForce = 0;        ///< force of force drives, included in `force`
  double inverseCompliance = 0; ///< dt c + dt^2 k of all dampers and springs, 1 / compliance of the row; 0: no soft row
  double dampingPart = 0;       ///< dt c of all dampers: joint, springs, end stops
  double jointDamping = 0, springDamping = 0, stopDamping = 0; ///< dt c of each kind
  double springKnown = 0;                                      ///< `known` without the joint's own damping
  double springInverseCompliance = 0;                          ///< `inverseCompliance` without the joint's own damping
  bool driven = false;
  double speed = 0; ///< imposed rate
};

/// Mechanism linearised at given poses: rows, masses and their factorisation. It does not depend on the time
/// integration: integrators use its position errors and its solutions of
///   M dv - J^T dLambda = bodyResidual,   J dv + G dLambda = rowResidual.
///
/// A coupling row b acts on up to four bodies and is not in the blocks of the factor. With Y = K^-1 b^T and the small
/// matrix S = b Y (symmetric, positive semidefinite), the complete solution is x + Y mu, where x is the solution of the
/// other rows and S mu = residual - b x.
class ConstraintSystem : public ConstraintGraph {
public:
  explicit ConstraintSystem(const Model& model);

  const Elimination& elimination() const { return *elimination_; }

  /// Hard rows kept by the last linearise(); before the first call, all hard rows. Each linearise() drops the most
  /// dependent rows of redundant constraints, and rows without a pivot in singular positions.
  unsigned hardRowsOf(int constraint) const { return hard_[static_cast<std::size_t>(constraint)]; }
  /// Marks `row` of a constraint, or an equivalent row, as redundant in all positions.
  void noteRedundant(int constraint, int row);

  /// Assembles and factors one part at `frames`. `laws`: one per axis. Returns the number of rows dropped as singular.
  int linearise(const Part& part, const std::vector<Frame>& frames, const std::vector<AxisLaw>& laws);

  /// In: one vector per node (bodies: momentum residual; constraints: row residual). Out: dv and dLambda.
  void solve(const Part& part, std::vector<Vector6>& x) const;

  /// Quantities of the last linearise().
  const RowDirections& rows(int constraint) const { return unpacked(rows_, constraint); }
  const JointFrames& jointFrames(int constraint) const { return unpacked(frames_, constraint); }
  const Mat3d& inertia(int node) const {
    if (packed_) unpack();
    return inertia_[static_cast<std::size_t>(node)];
  }
  const Vec3d& com_A(int constraint) const { return unpacked(com_A_, constraint); }
  const Vec3d& com_B(int constraint) const { return unpacked(com_B_, constraint); }
  unsigned activeRows(int constraint) const { return active_[static_cast<std::size_t>(constraint)]; }
  /// Identifier of a part's linearisation: changes with each linearise().
  long long linearisation(const Part& part) const { return linearisation_[static_cast<std::size_t>(part.index)]; }
  /// J M^-1 J^T of a single row.
  double rowSize(int constraint, int row) const {
    return size_[static_cast<std::size_t>(constraint)][static_cast<std::size_t>(row)];
  }
  /// Bodies of the spanning tree with their joints, in lanes; other constraints are outside the tree.
  const std::vector<LinkLanes>& links() const { return links_; }
  const std::vector<int>& offTree() const { return offTree_; }
  /// Inertias of a batch of links in world axes, by columns of the lower triangle.
  const Lanes (&inertiaOf(std::size_t batch) const)[6] { return elimination_->links(static_cast<int>(batch)).inertia; }
  /// Rate of one row: J (v, w).
  double rate(int constraint, int row, const std::vector<Twist>& twist) const;
  double rateOfAxis(int axis, const std::vector<Twist>& twist) const {
    return rate(axes()[static_cast<std::size_t>(axis)].constraint, axes()[static_cast<std::size_t>(axis)].row, twist);
  }
  /// Adds the momentum of `impulse` along one row to the vectors of its bodies in `x`.
  void addImpulse(int constraint, int row, double impulse, std::vector<Vector6>& x) const;
  /// J x of one row; x: one vector per node.
  double rowTimes(int constraint, int row, const std::vector<Vector6>& x) const;
  /// False for couplings implied by others, as determined by the last linearise().
  bool couplingKept(int coupling) const { return couplingKept_[static_cast<std::size_t>(coupling)] != 0; }
  /// Excludes couplings from linearise() and solve(), for an analysis of the joints only.
  void setCouplingsOn(bool on) { couplingsOn_ = on; }
  /// Sets the threshold: rows with pivots below `scale` times the usual threshold are dropped.
  void scalePivotThreshold(double scale);

private:
  void makeLinks();
  void lineariseLinks(const std::vector<Frame>& frames, const std::vector<AxisLaw>& laws);
  void unpack() const;
  template <class T> const T& unpacked(const std::vector<T>& values, int constraint) const {
    if (packed_ && inTree_[static_cast<std::size_t>(constraint)]) unpack();
    return values[static_cast<std::size_t>(constraint)];
  }
  void setSizes();
  void setUp(const std::vector<Frame>& frames, const std::vector<AxisLaw>& laws);
  void setPivotThreshold(int constraint);
  void factorCouplings(const Part& part);
  void solveCouplings(const Part& part, std::vector<Vector6>& x) const;

  std::unique_ptr<Elimination> elimination_;
  std::vector<unsigned> hard_, active_;
  std::vector<LinkLanes> links_; ///< one per batch of the elimination
  std::vector<char> inTree_;     ///< per constraint: true in the spanning tree
  std::vector<int> offTree_;
  // One per constraint or body; tree entries are unpacked from the lanes on demand.
  mutable bool packed_ = false;
  mutable std::vector<RowDirections> rows_;
  mutable std::vector<JointFrames> frames_;
  mutable std::vector<Mat3d> inertia_; ///< inertias in world axes
  bool sized_ = false;                 ///< true once size_ is set
  mutable std::vector<Vec3d> com_A_, com_B_;
  std::vector<std::array<double, 6>> size_; ///< J M^-1 J^T of each single row
  double pivotScale_ = 1;
  std::vector<unsigned> redundant_; ///< per constraint: redundant rows (bit mask)
  std::vector<int> expectedLost_;   ///< per part: expected rows without a pivot, due to redundancy
  bool strict_ = false;             ///< true: redundant constraints keep every row with a pivot, however small
  std::vector<long long> linearisation_;

  std::vector<std::vector<Vector6>> couplingSolution_; ///< Y, one vector per node for each coupling
  std::vector<std::vector<double>> couplingFactor_;    ///< lower Cholesky factor of S within the part
  std::vector<char> couplingKept_;
  mutable std::vector<double> couplingWork_;
  bool couplingsOn_ = true;
};

} // namespace grouser::multibody::detail
