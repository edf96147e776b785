// SPDX-License-Identifier: BSD-3-Clause
#include "multibody/detail/reaction_sharing.hpp"

#include "multibody/detail/index.hpp"

#include <Eigen/SparseCholesky>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

/// J^T W^-2 J is singular: it has no stiffness for free motions of the mechanism. With A = J^T W^-1 and mu = W lambda
/// the right-hand side b = A mu_0 has no component along these motions, so that Tikhonov's iteration
///
///   (A A^T + epsilon) dy = b - A A^T y,   y <- y + dy
///
/// reduces the error by a factor epsilon / (sigma^2 + epsilon) per iteration, with sigma the singular values of A. Near
/// singular positions a singular value is small, and the error would violate the force balance; a last solve with the
/// rows of the solver therefore balances J^T (lambda_0 - lambda) exactly.
///
/// Results are bitwise equal on every machine: Eigen's sparse simplicial factorisation consists of scalar operations in
/// an order fixed by the pattern; blocks of its dense products, in contrast, depend on the cache sizes.
namespace grouser::multibody::detail {

namespace {

/// epsilon / largest diagonal entry of a joint.
constexpr double kRegularisation = 1e-10;
/// The iteration ends at round-off of b, when the residual is no longer halved, or at this limit.
constexpr double kSharingRoundOff = 1e-15;
constexpr int kMaxIterations = 40;

/// Sets of constraints on common loops.
class LoopSets {
public:
  LoopSets(const ConstraintSystem& system) : parent_(system.constraints().size()) {
    std::iota(parent_.begin(), parent_.end(), 0);
    const SpanningTree& tree = system.elimination().tree();
    for (const SpanningTree::Loop& loop : tree.loops) {
      if (hardRows(system.constraints()[at(loop.constraint)].kind) == 0) continue;
      for (const int body : loop.path)
        if (const int joint = tree.links[at(body)].joint; joint >= 0) parent_[at(find(joint))] = find(loop.constraint);
    }
  }
  int find(int k) {
    while (parent_[at(k)] != k) k = parent_[at(k)] = parent_[at(parent_[at(k)])];
    return k;
  }

private:
  std::vector<int> parent_;
};

/// Root mean square of the distances between any two of the points [m]: root mean square distance from their mean,
/// times sqrt(2 n / (n - 1)).
double spacing(const std::vector<Vec3d>& points) {
  const double n = static_cast<double>(points.size());
  Vec3d mean;
  for (const Vec3d& p : points) mean += p * (1 / n);
  double sum = 0;
  for (const Vec3d& p : points) sum += norm2(p - mean);
  return points.size() < 2 ? 0 : std::sqrt(2 * sum / (n - 1));
}

} // namespace

/// Joints that share reactions, grouped by common loops.
struct ReactionSharing::Group {
  /// One hard row. Its column of A: force and torque / L of a unit multiplier mu on bodies B and A.
  struct Row {
    int constraint = 0, row = 0;
    int body_A = -1, body_B = -1; ///< indices in `nodes`; -1: immovable
    Eigen::Matrix<double, 6, 1> onA = Eigen::Matrix<double, 6, 1>::Zero(), onB = onA;
    bool moment = false;
    double start = 0, mu = 0; ///< W lambda of the solver, and after sharing
  };
  double length = 1;      ///< L [m]
  std::vector<int> nodes; ///< movable bodies
  std::vector<Row> rows;
  Eigen::SparseMatrix<double> matrix; ///< A A^T, lower triangle
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor;
  Eigen::VectorXd b, y;

  double times(const Row& row, const Eigen::VectorXd& v) const; ///< row of A^T v
  void add(const Row& row, double mu, Eigen::VectorXd& v) const;
  void assemble();
};

double ReactionSharing::Group::times(const Row& row, const Eigen::VectorXd& v) const {
  double sum = 0;
  for (int i = 0; i < 6; ++i) {
    if (row.body_B >= 0) sum += row.onB[i] * v[6 * row.body_B + i];
    if (row.body_A >= 0) sum += row.onA[i] * v[6 * row.body_A + i];
  }
  return sum;
}

void ReactionSharing::Group::add(const Row& row, double mu, Eigen::VectorXd& v) const {
  for (int i = 0; i < 6; ++i) {
    if (row.body_B >= 0) v[6 * row.body_B + i] += row.onB[i] * mu;
    if (row.body_A >= 0) v[6 * row.body_A + i] += row.onA[i] * mu;
  }
}

/// A A^T + epsilon, by the joints' blocks.
void ReactionSharing::Group::assemble() {
  using Block66 = Eigen::Matrix<double, 6, 6>;
  std::vector<Eigen::Triplet<double>> entries;
  const auto addBlock = [&](int i, int j, const Block66& block) {
    if (i < 0 || j < 0) return;
    for (int c = 0; c < 6; ++c)
      for (int r = 0; r < 6; ++r)
        if (6 * i + r >= 6 * j + c) entries.emplace_back(6 * i + r, 6 * j + c, block(r, c));
  };
  double largest = 0;
  for (std::size_t first = 0; first < rows.size();) {
    const Row& joint = rows[first];
    Block66 AA = Block66::Zero(), BB = AA, BA = AA;
    for (; first < rows.size() && rows[first].constraint == joint.constraint; ++first) {
      const Row& row = rows[first];
      AA += row.onA * row.onA.transpose();
      BB += row.onB * row.onB.transpose();
      BA += row.onB * row.onA.transpose();
    }
    addBlock(joint.body_A, joint.body_A, AA);
    addBlock(joint.body_B, joint.body_B, BB);
    if (joint.body_B > joint.body_A)
      addBlock(joint.body_B, joint.body_A, BA);
    else
      addBlock(joint.body_A, joint.body_B, BA.transpose());
    largest = std::max({largest, AA.diagonal().maxCoeff(), BB.diagonal().maxCoeff()});
  }
  const auto size = static_cast<Eigen::Index>(6 * nodes.size());
  for (int i = 0; i < size; ++i) entries.emplace_back(i, i, kRegularisation * largest);
  matrix.resize(size, size);
  matrix.setFromTriplets(entries.begin(), entries.end());
}

ReactionSharing::ReactionSharing(const Model& model, const Redundancy& redundancy, double momentLength)
    : system_(model), laws_(system_.axes().size()), x_(at(system_.nodes())) {
  for (const auto& [constraint, row] : redundancy.rows) system_.noteRedundant(constraint, row);
  addGroups(redundancy, momentLength);
}

ReactionSharing::~ReactionSharing() = default;

void ReactionSharing::addGroups(const Redundancy& redundancy, double momentLength) {
  LoopSets sets(system_);
  std::map<int, std::vector<int>> members; // sets that have a redundant row
  for (const auto& [constraint, row] : redundancy.rows) members[sets.find(constraint)];
  for (int k = 0; k < static_cast<int>(system_.constraints().size()); ++k)
    if (const auto found = members.find(sets.find(k)); found != members.end()) found->second.push_back(k);

  const std::vector<Frame> frames = system_.framesOfModel();
  for (const auto& [set, constraints] : members) {
    auto group = std::make_unique<Group>();
    std::map<int, int> indexOf;
    const auto indexed = [&](int node) {
      if (node < 0) return -1;
      const auto [place, isNew] = indexOf.emplace(node, static_cast<int>(group->nodes.size()));
      if (isNew) group->nodes.push_back(node);
      return place->second;
    };
    std::vector<Vec3d> points;
    for (const int k : constraints) {
      const Constraint& c = system_.constraints()[at(k)];
      points.push_back(framesOf(c, frames[at(c.bodyA)], frames[at(c.bodyB)]).p_B);
      for (int r = 0; r < 6; ++r)
        if (hardRows(c.kind) >> r & 1u) {
          Group::Row row;
          row.constraint = k, row.row = r;
          row.body_A = indexed(c.nodeA), row.body_B = indexed(c.nodeB);
          group->rows.push_back(row);
        }
    }
    group->length = momentLength > 0 ? momentLength : spacing(points);
    // Joints at the same point have no lever arm: forces and moments are independent, and any length is valid.
    if (!(group->length > 0)) group->length = 1;
    groups_.push_back(std::move(group));
  }
}

/// Computes the rows at the current frames, the multipliers of the reactions, and b.
void ReactionSharing::startGroup(Group& group, const std::vector<JointReaction>& reactions) {
  const double perLength = 1 / group.length;
  group.b.setZero(static_cast<Eigen::Index>(6 * group.nodes.size()));
  for (Group::Row& row : group.rows) {
    const Constraint& c = system_.constraints()[at(row.constraint)];
    const Vec3d &e = system_.rows(row.constraint).force[at(row.row)],
                &t = system_.rows(row.constraint).torque[at(row.row)];
    const Vec3d& p = system_.jointFrames(row.constraint).p_B;
    row.moment = norm2(t) > norm2(e);
    const auto column = [&](double sign, const Vec3d& com) {
      const Vec3d torque = row.moment ? t : cross(p - com, e) * perLength;
      Eigen::Matrix<double, 6, 1> v;
      for (int i = 0; i < 3; ++i) v[i] = sign * e[i], v[3 + i] = sign * torque[i];
      return v;
    };
    row.onA = column(-1, system_.com_A(row.constraint));
    row.onB = column(1, system_.com_B(row.constraint));
    const JointReaction& reaction = reactions[at(c.source)];
    row.start = row.moment ? dot(t, reaction.torque) * perLength : dot(e, reaction.force);
    group.add(row, row.start, group.b);
  }
}

void ReactionSharing::solveGroup(Group& group) {
  group.assemble();
  group.factor.compute(group.matrix);
  group.y.setZero(group.b.size());
  const double size = group.b.lpNorm<Eigen::Infinity>();
  Eigen::VectorXd left = group.b;
  double before = std::numeric_limits<double>::infinity();
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    const double now = left.lpNorm<Eigen::Infinity>();
    if (now <= kSharingRoundOff * size || !(now < 0.5 * before)) break;
    before = now;
    group.y += group.factor.solve(left);
    left = group.b;
    for (Group::Row& row : group.rows) {
      row.mu = group.times(row, group.y);
      group.add(row, -row.mu, left);
    }
  }
}

void ReactionSharing::share(const State& state, std::vector<JointReaction>& reactions) {
  if (groups_.empty()) return;
  system_.place(state.pose, frames_);
  for (const ConstraintSystem::Part& part : system_.parts()) system_.linearise(part, frames_, laws_);
  for (Vector6& v : x_) v = {};
  for (const auto& group : groups_) {
    startGroup(*group, reactions);
    solveGroup(*group);
    // M dv - J^T dLambda = J^T (lambda - lambda_0),   J dv = 0.
    for (const Group::Row& row : group->rows)
      system_.addImpulse(row.constraint, row.row, (row.mu - row.start) * (row.moment ? group->length : 1), x_);
  }
  for (const ConstraintSystem::Part& part : system_.parts()) system_.solve(part, x_);
  for (const auto& group : groups_)
    for (const Group::Row& row : group->rows) {
      const double change = (row.mu - row.start) * (row.moment ? group->length : 1) +
                            x_[at(system_.movableBodies() + row.constraint)][at(row.row)];
      JointReaction& reaction = reactions[at(system_.constraints()[at(row.constraint)].source)];
      reaction.force += change * system_.rows(row.constraint).force[at(row.row)];
      reaction.torque += change * system_.rows(row.constraint).torque[at(row.row)];
    }
}

} // namespace grouser::multibody::detail
