// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>
#include <optional>

namespace grouser::support {

/// Estimates the remaining time of a task from its rate during the last fifth of the elapsed time, so that the estimate
/// follows changes of the machine's load.
class TimeLeft {
public:
  /// `fraction`: fraction done before, e.g. by the run that is resumed.
  explicit TimeLeft(double fraction = 0) : samples_{{0, fraction}} {}

  /// Adds the fraction of the work done at `elapsed`, the time since the start [s]; the fraction must not decrease.
  void add(double elapsed, double fraction);
  /// Remaining time [s] at the time `elapsed` [s]. Empty before the first progress, if the task is overdue, and after a
  /// pause as long as the window of the rate.
  std::optional<double> at(double elapsed) const;

private:
  struct Sample {
    double time, fraction;
  };
  static double window(double elapsed); ///< averaging interval of the rate [s]

  std::deque<Sample> samples_; ///< samples in the window, and the last sample before it
};

} // namespace grouser::support
