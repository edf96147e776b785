// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/host_device.hpp"

#include <cmath>

/// Step size, restart, and stopping criteria of the iterations, with identical bits on host and device.
namespace grouser::terrain {

/// Sums of an iteration over all rows and ranks.
struct IterationSums {
  double curvature, length, against, squares, contacts, worst;
  double rounding = 0; ///< velocity that rounding in this step may hide [m/s]
};

/// State of the iterations of a step.
template <class Real> struct ImpulseControl {
  /// Limits of tau. The metric bounds the curvature at tau = 1; larger values are needed for bodies with a larger
  /// response than free bodies.
  static constexpr double kMaxTau = 16, kMinTau = 1e-3, kLongerStep = 0.97;
  static constexpr int kPatience = 100; ///< iterations within which the residual must halve

  double residual{};   ///< tolerance [m/s]
  double resolution{}; ///< rounding error of the curvature per contact [J]
  int maxIterations{};
  bool associated{false};
  bool relaxed{false}; ///< switched from Coulomb's law to the relaxation
  bool judging{false}; ///< the next evaluation only measures the residual of the relaxation's result by Coulomb's law
  bool done{false};
  int now = 0, before = 0, tried = 2; ///< indices of row buffers
  int iterations = 0, halvedAt = 0, evaluations = 0;
  Real ahead = 0, tau = 1; ///< extrapolation factor; inverse step size / that of the metric
  double theta = 1, halved = 0;
  IterationSums last{};

  /// Difference of the trial from the extrapolated iterate, of a quantity by buffer.
  template <class Value> auto stepOf(const Value& value) const {
    const auto current = value(now);
    return value(tried) - (current + (current - value(before)) * static_cast<double>(ahead));
  }

  /// True if an evaluation with these sums is the last one.
  GROUSER_HD bool endsWith(const IterationSums& sums) const {
    return judging || !(sums.worst > tolerance(sums)) || iterations >= maxIterations;
  }

  /// Tolerance of the step [m/s]: no iteration reduces the residual below the rounding of its velocities.
  GROUSER_HD double tolerance(const IterationSums& sums) const {
    return residual > sums.rounding ? residual : sums.rounding;
  }

  /// Continues from the current impulses after the rows have changed.
  GROUSER_HD void restart() {
    done = judging = relaxed = false;
    before = now, tried = now == 2 ? 0 : 2;
    ahead = 0, theta = 1, halved = 3e38, halvedAt = iterations;
  }

  /// Takes the sums of an evaluation: stops, accepts the trial, or repeats it with a shorter step if the curvature is
  /// too high, or with the relaxation if Coulomb's law, which has no potential, does not converge.
  GROUSER_HD void take(const IterationSums& sums) {
    ++evaluations, last = sums;
    done = endsWith(sums);
    if (done && relaxed && !judging) {
      judging = true, done = associated = false;
      return;
    }
    if (iterations == 0 || last.worst < 0.5 * halved) halved = last.worst, halvedAt = iterations;
    if (done) return;
    if (iterations - halvedAt > kPatience && !associated) {
      associated = relaxed = true;
      before = now, ahead = 0, theta = 1;
      return;
    }
    const double excess = sums.curvature - static_cast<double>(tau) * sums.length;
    if (tau < Real(kMaxTau) && excess > resolution * sums.contacts) {
      tau *= 2;
      return;
    }
    const bool restarts = sums.against > 0;
    const double next = restarts ? 1 : 0.5 * theta * (sqrt(theta * theta + 4) - theta);
    ahead = restarts ? Real(0) : static_cast<Real>(theta * (1 - theta) / (theta * theta + next));
    theta = next, tau = tau * Real(kLongerStep) > Real(kMinTau) ? tau * Real(kLongerStep) : Real(kMinTau);
    before = now, now = tried, tried = 3 - now - before, ++iterations;
  }
};

} // namespace grouser::terrain
