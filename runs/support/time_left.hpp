// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>
#include <optional>

namespace grouser::support {

/// Estimates the remaining time of a task from its rate over the last fifth of the time spent so far, and so follows
/// changes of the machine's load.
class TimeLeft {
public:
  /// `fraction`: share done before this call, such as by the run that is resumed.
  explicit TimeLeft(double fraction = 0) : samples_{{0, fraction}} {}

  /// Fraction of the work done at `elapsed` since the start [s], which never decreases.
  void add(double elapsed, double fraction);
  /// Remaining time at `elapsed` [s], [s]. Empty before the first progress, when it is overdue, and after a pause as
  /// long as the window of the rate.
  std::optional<double> at(double elapsed) const;

private:
  struct Sample {
    double time, fraction;
  };
  static double window(double elapsed); ///< interval of the rate [s]

  std::deque<Sample> samples_; ///< samples of the window, and the last before it
};

} // namespace grouser::support
