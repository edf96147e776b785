// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "multibody/model.hpp"
#include "multibody/state.hpp"

#include <memory>

namespace grouser::multibody {

/// Linear system of a step (detail/elimination.hpp) with all axes free, for measurements of its size and cost. A Solver
/// owns a separate system.
class LinearSystem {
public:
  /// Determines the elimination order. The model must outlive the system and not change.
  explicit LinearSystem(const Model& model);
  ~LinearSystem();
  LinearSystem(LinearSystem&&) noexcept;
  LinearSystem& operator=(LinearSystem&&) noexcept;

  int hardRows() const; ///< rows of all joints, including redundant ones
  int loops() const;    ///< joints outside the spanning tree
  int batches() const;  ///< groups of up to four bodies, one per SIMD lane
  /// Multiplications of one factorisation and one solution, idle lanes not counted.
  long multiplications() const;

  /// Sets the poses of a state.
  void place(const State& state);
  /// Computes rows and inertias at these poses, and factors the system.
  void factor();
  /// Solves once with the last factorisation; the right-hand side is the previous result.
  void solve();

private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace grouser::multibody
