// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "coupling/mechanism_setup.hpp"
#include "multibody/solver.hpp"
#include "multibody/state.hpp"

#include <cstdint>
#include <functional>

namespace grouser::coupling {

/// Error-controlled steps of a mechanism. Each interval h is computed in one step and in two steps of h / 2. A third of
/// the difference is the error of the two steps (RATTLE is of order 2), which are accepted if for every body
///   |dp| + h |dv|  and  |dphi| + h |dw|   are at most   tolerance h + round-off      [m], [rad]:
/// `tolerance` limits the error per second. The next h is the last h times 0.9 sqrt(tolerance h / error), a factor kept
/// within [0.2, 2]. No step is longer than drives and rotations permit (time_scales.hpp). Decisions depend only on the
/// state, so resumed runs are bitwise identical.
class StepController {
public:
  StepController(const StepControl& control, double largestTurn)
      : control_(control), largestTurn_(largestTurn), record_{control.first, 0, 0, 0, 0} {}

  /// Advances `state` to the time `until` [s]; calls `each` after every accepted interval. Throws base::SimulationError
  /// if no step satisfies the tolerance.
  void advance(multibody::Solver& solver, multibody::State& state, const multibody::Loads& loads, double until,
               const std::function<void()>& each);

  /// Statistics of the whole run. An accepted interval counts as two steps, a rejected one as three.
  struct Record {
    double next = 0; ///< next interval [s]
    std::int64_t taken = 0, rejected = 0;
    double smallest = 0, largest = 0; ///< smallest and largest accepted step [s]
  };
  const Record& record() const { return record_; }
  void restore(const Record& record) { record_ = record; }

private:
  double longest(const multibody::State& state) const;
  bool tryStretch(multibody::Solver& solver, const multibody::Loads& loads, double h);
  double error(double h) const;
  double roundOff() const;

  const StepControl control_;
  const double largestTurn_;
  Record record_;
  multibody::State once_, twice_; ///< states after the interval in one step and in two
};

} // namespace grouser::coupling
