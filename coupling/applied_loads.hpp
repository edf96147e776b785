// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "coupling/inputs.hpp"
#include "multibody/ledger.hpp"
#include "multibody/state.hpp"

#include <cstddef>
#include <vector>

namespace grouser::coupling {

/// Forces and torques that are set from outside on bodies, and their work: in each step with the means of the
/// velocities before and behind it, as the bodies' books have it.
class AppliedLoads {
public:
  /// The loads among `inputs` from now on; targets are bodies of the model.
  void set(const Inputs& inputs);
  /// Adds them to `loads`, for a step that begins at `state`.
  void add(const multibody::State& state, multibody::Loads& loads);
  /// Books the work of the step of `dt` [s] that has brought the bodies to `state`.
  void book(const multibody::State& state, double dt);
  double work() const { return work_; } ///< since the start [J]

  std::vector<double> save() const { return {work_.sum, work_.lost}; }
  void restore(const std::vector<double>& saved);

private:
  struct Load {
    std::size_t body;
    multibody::Wrench wrench;
    multibody::Twist before; ///< of the body as the step began
  };
  std::vector<Load> loads_;
  multibody::CompensatedSum work_;
};

} // namespace grouser::coupling
