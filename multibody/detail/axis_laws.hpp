// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "multibody/detail/constraint_system.hpp"

namespace grouser::multibody::detail {

/// Work done over one step through a soft or driven row [J].
struct AxisWork {
  double drive = 0, spring = 0, dissipated = 0;
};

/// Puts together what acts along the free axis of each joint and along each point spring in one step: joint damping,
/// springs, end stops, drive. A spring is taken implicitly,
///   F = F_0 - k (x + dt x'_new - x_0) - c x'_new  =  [F_0 - k (x - x_0)]  -  (c + dt k) x'_new,
/// the bracket being known at the start of the step, the rest a soft row with compliance 1 / (dt c + dt^2 k).
class AxisLaws {
public:
  AxisLaws(const Model& model, const std::vector<Constraint>& constraints);

  /// Row along the free axis or the spring; -1 if the kind has none.
  int row(int constraint) const { return row_[static_cast<std::size_t>(constraint)]; }

  void evaluate(const ConstraintSystem& system, const State& state, const Loads& loads, double dt,
                const std::vector<Frame>& frames, std::vector<AxisLaw>& laws) const;

  /// `multiplier`: impulse of the row / dt; `path`: mean rate times dt.
  AxisWork work(const AxisLaw& law, double multiplier, double newRate, double path, double dt) const;

private:
  const Model* model_;
  std::vector<int> row_;
};

} // namespace grouser::multibody::detail
