// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdexcept>
#include <string>

namespace grouser::support {

/// A signal has stopped the run, in good order. Exit code 128 + signal, as shells have it: 129, 130 or 143. The program
/// adds the command that goes on to the message, or begins again.
class Stopped : public std::runtime_error {
public:
  /// Whether a call that goes on finds work left.
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
