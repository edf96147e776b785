// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdexcept>
#include <string>

namespace grouser::support {

/// A signal has stopped the run; all files are complete. The exit code is 128 + signal: 129, 130, 138 or 143. The
/// program adds the command that resumes or repeats the run to the message.
class Stopped : public std::runtime_error {
public:
  /// Whether the stopped call has left results that can be continued.
  enum class Left { work, nothing };
  Stopped(int signal, const std::string& message, Left left = Left::work)
      : std::runtime_error(message), signal_(signal), left_(left) {}
  int signal() const { return signal_; }
  Left left() const { return left_; }

private:
  int signal_;
  Left left_;
};

/// During the lifetime of a StopSignals object, the first SIGINT, SIGTERM, SIGHUP or SIGUSR1 is stored, so that the run
/// can stop at the end of its step. A second signal ends the program at once. Objects may be nested. Not thread-safe.
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
