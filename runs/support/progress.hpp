// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <string>

namespace grouser::support {

/// Progress with time left, on stderr: one line rewritten in place on a terminal, a plain line every few seconds
/// elsewhere.
class Progress {
public:
  /// `shown`: false keeps it silent, on ranks whose work another one reports.
  explicit Progress(std::string what, bool shown = true);
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
  /// The text of one line.
  static std::string line(const std::string& what, double fraction, double elapsed, const std::string& detail);

private:
  using Clock = std::chrono::steady_clock;
  void clearLine();

  std::string what_;
  bool shown_, terminal_;
  bool open_ = false; ///< a line without its end stands on the terminal
  Clock::time_point start_, next_;
};

} // namespace grouser::support
