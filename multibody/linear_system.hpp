// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "multibody/model.hpp"
#include "multibody/state.hpp"

#include <memory>

namespace grouser::multibody {

/// The linear system of a step by itself (detail/elimination.hpp), all axes free: for those who want its size or the
/// time that it takes. A Solver has one of its own.
class LinearSystem {
public:
  /// Orders the elimination. The model must outlive the system and not change.
  explicit LinearSystem(const Model& model);
  ~LinearSystem();
  LinearSystem(LinearSystem&&) noexcept;
  LinearSystem& operator=(LinearSystem&&) noexcept;

  int hardRows() const; ///< of all joints, redundant ones included
  int loops() const;    ///< joints that the spanning tree leaves out
  int batches() const;  ///< groups of up to four bodies that fill the lanes of a vector register
  /// Of one factorisation and one solution, idle lanes not counted.
  long multiplications() const;

  /// Puts the bodies where they are in a state.
  void place(const State& state);
  /// Rows and inertias at these poses, and their factorisation.
  void factor();
  /// One solution with the last factor; its right-hand side is what the last one left.
  void solve();

private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace grouser::multibody
