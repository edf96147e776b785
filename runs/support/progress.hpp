// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/support/time_left.hpp"

#include <chrono>
#include <optional>
#include <string>

namespace grouser::support {

/// Progress with remaining time, on stderr: on a terminal one line that is updated in place, otherwise a new line every
/// few seconds.
class Progress {
public:
  /// Meaning of fraction 1: the expected end of the work, or a limit that it may not reach.
  enum class End { expected, limit };

  /// `shown`: false on ranks that print nothing, since another rank reports. `from`: fraction done before, 0 to 1.
  explicit Progress(std::string what, bool shown = true, double from = 0, End end = End::expected);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// `fraction` done, 0 to 1; `detail` such as "t 1.20 s". May be called every step: usually it only reads the clock.
  void update(double fraction, const std::string& detail);
  /// The same with a remaining time [s] that the caller has estimated; empty: unknown.
  void update(double fraction, const std::string& detail, std::optional<double> left);
  /// Returns true if the next update would print, so that callers can skip computing `detail`.
  bool due() const;
  /// Starts a new piece of work with this label: the fraction restarts at 0.
  void restart(std::string what);
  /// Prints a line with a result on stdout, without disturbing the progress on stderr.
  void note(const std::string& line);
  /// Prints the last line, with the elapsed time.
  void finish(const std::string& detail);

  /// "42 s", "3 min 05 s", "2 h 10 min".
  static std::string duration(double seconds);
  /// Text of one progress line. `left`: remaining time [s]; empty: unknown.
  static std::string line(const std::string& what, double fraction, std::optional<double> left,
                          const std::string& detail, End end = End::expected);

private:
  using Clock = std::chrono::steady_clock;
  void clearLine();

  std::string what_;
  bool shown_, terminal_;
  End end_;
  TimeLeft left_;
  bool open_ = false; ///< the line on the terminal is not yet terminated
  Clock::time_point start_, next_;
  Clock::time_point begun_ = start_; ///< start of the first piece of work
};

} // namespace grouser::support
