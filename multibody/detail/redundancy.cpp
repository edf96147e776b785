// SPDX-License-Identifier: BSD-3-Clause
#include "multibody/detail/redundancy.hpp"

#include "multibody/detail/index.hpp"
#include "multibody/detail/rotation.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace grouser::multibody::detail {

namespace {

/// While constraints are closed, rows with pivots below 1e-6 of the row's own J M^-1 J^T are weak.
constexpr double kWeakPivot = 1e5;

/// Pseudorandom number in [-1, 1) from a counter (SplitMix64, Steele, Lea and Flood 2014), equal on all machines.
double generic(std::uint64_t counter) {
  std::uint64_t z = (counter + 1) * 0x9e3779b97f4a7c15ull;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
  z ^= z >> 31;
  return static_cast<double>(z >> 11) * 0x1p-52 - 1;
}

/// Moves a copy of the mechanism, in which all axes are free and no row is soft.
class Explorer {
public:
  Explorer(ConstraintSystem& system, const Model& model)
      : system_(system), model_(model), laws_(system.axes().size()), x_(at(system.nodes())) {
    for (const Body& body : model.bodies()) poses_.push_back(body.pose);
    system_.place(poses_, frames_);
  }

  int factor(const ConstraintSystem::Part& part) { return system_.linearise(part, frames_, laws_); }

  std::vector<std::pair<int, int>> rowsWithoutPivot(const ConstraintSystem::Part& part) const {
    std::vector<std::pair<int, int>> rows;
    for (const int k : part.constraints) {
      const unsigned lost = system_.activeRows(k) & ~system_.elimination().keptRows(k);
      for (int r = 0; r < 6; ++r)
        if (lost >> r & 1u) rows.emplace_back(k, r);
    }
    return rows;
  }

  /// Moves the fastest link by `angle` [rad] along an admissible velocity: the compatible part of the initial twists in
  /// attempt 0, a generic velocity in other attempts. Returns false if nothing moves.
  bool perturb(const ConstraintSystem::Part& part, int attempt, double angle) {
    clear(part);
    for (const int node : part.bodies) {
      const Body& body = model_.bodies()[at(system_.bodyOf(node))];
      const auto counter = 6 * (static_cast<std::uint64_t>(node) + 1000003 * static_cast<std::uint64_t>(attempt));
      const Vec3d spin{generic(counter), generic(counter + 1), generic(counter + 2)};
      const Vec3d drift{generic(counter + 3), generic(counter + 4), generic(counter + 5)};
      set(node, body.mass * (attempt == 0 ? body.v_WB : drift),
          system_.inertia(node) * (attempt == 0 ? body.w_WB : spin));
    }
    system_.solve(part, x_);
    double fastest = 0;
    for (const int node : part.bodies) {
      const Vector6& v = x_[at(node)];
      fastest = std::max(fastest, v[3] * v[3] + v[4] * v[4] + v[5] * v[5]);
      fastest = std::max(fastest, 1e-6 * (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]));
    }
    if (!(fastest > 1e-12)) return false;
    move(part, angle / std::sqrt(fastest));
    return true;
  }

  /// Solves C = 0 by Newton's method, with a new factorisation in each iteration. Returns true if converged. Away from
  /// C = 0 dependent rows have small pivots, which would make the iteration diverge; rows with pivots below `weak`
  /// times the usual threshold are therefore dropped (Gauss-Newton with truncated rank).
  bool close(const ConstraintSystem::Part& part, double weak) {
    system_.scalePivotThreshold(weak);
    const bool arrived = closeAtThreshold(part);
    system_.scalePivotThreshold(1);
    return arrived;
  }

  bool closeAtThreshold(const ConstraintSystem::Part& part) {
    for (int iteration = 0; iteration < 30; ++iteration) {
      factor(part);
      clear(part);
      double worst = 0;
      for (const int k : part.constraints) {
        double error[6];
        positionError(system_.constraints()[at(k)], system_.jointFrames(k), error);
        for (int r = 0; r < 6; ++r) {
          x_[at(system_.movableBodies() + k)][at(r)] = -error[r];
          worst = std::max(worst, std::fabs(error[r]));
        }
      }
      if (worst < 1e-12) return true;
      system_.solve(part, x_);
      move(part, 1);
    }
    return false;
  }

  void reset() {
    for (std::size_t b = 0; b < poses_.size(); ++b) poses_[b] = model_.bodies()[b].pose;
    system_.place(poses_, frames_);
  }

private:
  void set(int node, const Vec3d& linear, const Vec3d& angular) {
    for (int i = 0; i < 3; ++i) x_[at(node)][at(i)] = linear[i], x_[at(node)][at(3 + i)] = angular[i];
  }

  void clear(const ConstraintSystem::Part& part) {
    for (const int node : part.bodies) x_[at(node)] = {};
    for (const int k : part.constraints) x_[at(system_.movableBodies() + k)] = {};
  }

  void move(const ConstraintSystem::Part& part, double scale) {
    for (const int node : part.bodies) {
      const int b = system_.bodyOf(node);
      const Vector6& v = x_[at(node)];
      Pose& X = poses_[at(b)];
      X.position += scale * Vec3d{v[0], v[1], v[2]};
      X.orientation = (rotationBy(scale * Vec3d{v[3], v[4], v[5]}) * X.orientation).normalized();
      system_.placeBody(b, X, frames_);
    }
  }

  ConstraintSystem& system_;
  const Model& model_;
  std::vector<AxisLaw> laws_;
  std::vector<Vector6> x_;
  std::vector<Pose> poses_;
  std::vector<Frame> frames_;
};

} // namespace

Redundancy findRedundantRows(ConstraintSystem& system, const Model& model) {
  Redundancy found;
  system.setCouplingsOn(false);
  Explorer explorer(system, model);
  for (const auto& part : system.parts()) {
    const int atStart = explorer.factor(part);
    if (atStart == 0) continue;
    // From a singular start, a motion may stay on a singular branch: use the smallest number of redundant rows found.
    bool explored = false;
    std::vector<std::pair<int, int>> rows;
    for (int attempt = 0; attempt < 4; ++attempt) {
      explorer.reset();
      explorer.factor(part);
      if (!explorer.perturb(part, attempt, 0.05 * (1 + attempt))) continue;
      if (!explorer.close(part, kWeakPivot) && !explorer.close(part, 1)) continue;
      explorer.factor(part);
      const auto lost = explorer.rowsWithoutPivot(part);
      if (!explored || lost.size() < rows.size()) rows = lost;
      explored = true;
    }
    found.singularAtStart += atStart - static_cast<int>(rows.size());
    found.rows.insert(found.rows.end(), rows.begin(), rows.end());
  }
  system.setCouplingsOn(true);
  std::sort(found.rows.begin(), found.rows.end());
  for (const auto& [constraint, row] : found.rows) system.noteRedundant(constraint, row);
  return found;
}

} // namespace grouser::multibody::detail
