// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "multibody/detail/anderson_acceleration.hpp"
#include "multibody/detail/constraint_system.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

namespace grouser::multibody::detail {

/// Pivot threshold, in units of the usual threshold, for rows that a rotation [rad] within a step can move through a
/// singular position: near such a position, the pivot of a row, relative to its own J M^-1 J^T, is proportional to the
/// squared angle from the position.
inline double weakPivotScale(double turn) { return std::max(10 * turn * turn, 1e-6) / Elimination::kPivotTolerance; }
/// Pivot threshold for rows that can transmit an impulse. A gap equal to the tolerance allows a deviation of up to its
/// square root across the singular direction. This must be small compared with the angle from the singular position;
/// otherwise the impulse changes the motion through this position.
inline double firmPivotScale(double positionTolerance) {
  return std::max(1.0, 1e2 * positionTolerance / Elimination::kPivotTolerance);
}

/// Iterate of the position solve: twists over the step, with their impulses.
struct Iterate {
  std::vector<Twist>& twist;                   ///< one per body
  std::vector<std::array<double, 6>>& impulse; ///< one per constraint
  std::vector<double>& couplingImpulse;        ///< one per coupling
};

/// Accelerates the position solve of one part if the solve converges slowly or not at all: near singular positions,
/// where pivots change in size or sign within a step, and for rotations of about a radian per step. Mixes corrections
/// by Anderson acceleration (anderson_acceleration.hpp), and stores the best iterate.
class Mixing {
public:
  explicit Mixing(const ConstraintSystem& system, const Model& model)
      : system_(system), model_(model), acceleration_(6 * static_cast<std::size_t>(system.nodes())),
        z_(6 * static_cast<std::size_t>(system.nodes())), change_(z_), weight_(z_), best_(model.bodies().size()) {}

  /// Resets the state; call before the first iteration of a solve.
  void reset() { on_ = false, bestGap_ = std::numeric_limits<double>::infinity(); }
  bool on() const { return on_; }
  void switchOn() { on_ = true, acceleration_.reset(); }
  /// Discards the history; call after the matrix has changed.
  void forget() { acceleration_.reset(); }

  /// Mixes the corrections in `x` with those of previous iterations, in the kinetic energy norm.
  void improve(const ConstraintSystem::Part& part, const Iterate& iterate, std::vector<Vector6>& x);

  /// Stores the iterate if its gap is the smallest so far.
  void remember(const ConstraintSystem::Part& part, double gap, const std::vector<Twist>& twist);
  double bestGap() const { return bestGap_; }
  void takeBest(const ConstraintSystem::Part& part, std::vector<Twist>& twist) const;

private:
  const ConstraintSystem& system_;
  const Model& model_;
  AndersonAcceleration acceleration_;
  std::vector<double> z_, change_, weight_;
  std::vector<Twist> best_;
  double bestGap_ = 0;
  bool on_ = false;
};

} // namespace grouser::multibody::detail
