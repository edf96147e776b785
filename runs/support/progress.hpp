// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/support/time_left.hpp"

#include <chrono>
#include <optional>
#include <string>

namespace grouser::support {

/// Progress with time left, on stderr: one line rewritten in place on a terminal, a plain line every few seconds
/// elsewhere.
class Progress {
public:
  /// Kind of the work's end: its expected place, or a limit that it may not reach.
  enum class End { expected, limit };

  /// `shown`: false keeps it silent, on ranks whose work another one reports. `from`: fraction done before, 0 to 1.
  explicit Progress(std::string what, bool shown = true, double from = 0, End end = End::expected);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// `fraction` done, 0 to 1; `detail` such as "t 1.20 s". Cheap to call every step: it looks at the clock only.
  void update(double fraction, const std::string& detail);
  /// True when the next update would print; lets the caller leave out making the detail.
  bool due() const;
  /// A line of result on stdout, beside the progress on stderr.
  void note(const std::string& line);
  /// The last line, with the time taken.
  void finish(const std::string& detail);

  /// "42 s", "3 min 05 s", "2 h 10 min".
  static std::string duration(double seconds);
  /// The text of one line. `left` [s]; empty: unknown.
  static std::string line(const std::string& what, double fraction, std::optional<double> left,
                          const std::string& detail, End end = End::expected);

private:
  using Clock = std::chrono::steady_clock;
  void clearLine();

  std::string what_;
  bool shown_, terminal_;
  End end_;
  TimeLeft left_;
  bool open_ = false; ///< a line without its end stands on the terminal
  Clock::time_point start_, next_;
};

} // namespace grouser::support
