// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdexcept>
#include <string>

namespace grouser::support {

/// A signal has stopped the run, with all files complete. Exit code 128 + signal: 129, 130 or 143. The program adds to
/// the message the command that resumes or repeats the run.
class Stopped : public std::runtime_error {
public:
  /// Whether the stopped call has left results to continue.
  enum class Left { work, nothing };
  Stopped(int signal, const std::string& message, Left left = Left::work)
      : std::runtime_error(message), signal_(signal), left_(left) {}
  int signal() const { return signal_; }
  Left left() const { return left_; }

private:
  int signal_;
  Left left_;
};

/// While an object of this kind lives, the first SIGINT, SIGTERM or SIGHUP is kept for the run to act on at the end of
/// its step. A second one ends the program at once, as ever. They may be nested; not for threads.
class StopSignals {
public:
  StopSignals();
  ~StopSignals();
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;

  /// The signal received, or 0.
  static int received();
  /// "SIGINT"
  static const char* name(int signal);
};

} // namespace grouser::support
