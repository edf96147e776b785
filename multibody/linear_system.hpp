// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "multibody/model.hpp"
#include "multibody/state.hpp"

#include <memory>

namespace grouser::multibody {

/// The linear system of a step (detail/elimination.hpp) with all axes free, for measurements of its size and cost. A
/// Solver has its own.
class LinearSystem {
public:
  /// Orders the elimination. The model must outlive the system and not change.
  explicit LinearSystem(const Model& model);
  ~LinearSystem();
  LinearSystem(LinearSystem&&) noexcept;
  LinearSystem& operator=(LinearSystem&&) noexcept;

  int hardRows() const; ///< of all joints, including redundant ones
  int loops() const;    ///< joints that the spanning tree leaves out
  int batches() const;  ///< groups of up to four bodies that fill the lanes of a vector register
  /// Multiplications of one factorisation and one solution, idle lanes not counted.
  long multiplications() const;

  /// Sets the poses of a state.
  void place(const State& state);
  /// Rows and inertias at these poses, and their factorisation.
  void factor();
  /// One solution with the last factor; the right-hand side is the previous result.
  void solve();

private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace grouser::multibody
