// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "coupling/inputs.hpp"
#include "multibody/ledger.hpp"
#include "multibody/state.hpp"

#include <cstddef>
#include <vector>

namespace grouser::coupling {

/// External forces and torques on bodies, and their work. The work of a step uses the mean of the velocities before and
/// after it, as in the energy accounting of the bodies.
class AppliedLoads {
public:
  /// Sets the body loads from `inputs`; targets are bodies of the model.
  void set(const Inputs& inputs);
  /// Adds the external loads to `loads`, for a step that begins at `state`.
  void add(const multibody::State& state, multibody::Loads& loads);
  /// Adds the work of the step of `dt` [s] that ended at `state`.
  void accountWork(const multibody::State& state, double dt);
  double work() const { return work_; } ///< work since the start [J]

  std::vector<double> save() const { return {work_.sum, work_.lost}; }
  void restore(const std::vector<double>& saved);

private:
  struct Load {
    std::size_t body;
    multibody::Wrench wrench;
    multibody::Twist before; ///< twist of the body at the start of the step
  };
  std::vector<Load> loads_;
  multibody::CompensatedSum work_;
};

} // namespace grouser::coupling
