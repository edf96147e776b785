// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>
#include <optional>

namespace grouser::support {

/// Time left of some work, by its rate of late: a machine that becomes busy, or idle again, is noticed within a fifth
/// of the time spent so far. The mean rate since the start would have the time left count upwards all along.
class TimeLeft {
public:
  /// `fraction`: done before this call, such as by the run that is resumed.
  explicit TimeLeft(double fraction = 0) : samples_{{0, fraction}} {}

  /// So much of the work is done at `elapsed` since the start [s], which never goes back.
  void add(double elapsed, double fraction);
  /// At `elapsed` [s], [s]. Empty where nothing tells: before the first progress, where it has been overdue, and where
  /// none has been made for as long as the rate was measured.
  std::optional<double> at(double elapsed) const;

private:
  struct Sample {
    double time, fraction;
  };
  static double window(double elapsed); ///< in which the rate is measured [s]

  std::deque<Sample> samples_; ///< those of the window, and the last before it
};

} // namespace grouser::support
