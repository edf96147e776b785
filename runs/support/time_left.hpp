// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>
#include <optional>

namespace grouser::support {

/// Remaining time of a task from its recent rate, over a fifth of the time spent so far, so that it follows changes of
/// the machine's load.
class TimeLeft {
public:
  /// `fraction`: done before this call, such as by the run that is resumed.
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
  static double window(double elapsed); ///< in which the rate is measured [s]

  std::deque<Sample> samples_; ///< those of the window, and the last before it
};

} // namespace grouser::support
