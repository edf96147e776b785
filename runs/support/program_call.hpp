// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/support/child_process.hpp"

#include <string>
#include <vector>

namespace grouser::support {

/// Exit of a called program.
struct CallOutcome {
  bool started = false;
  int status = -1;    ///< exit status; -1: not started, or ended by a signal
  std::string output; ///< stdout and stderr together; without an exit status, also a line with the cause
};

/// Runs a program and waits for it to finish. `words`: name of the program, searched on the PATH unless it contains a
/// slash, then its arguments. A signal that terminates the calling process is forwarded to the child.
CallOutcome callProgram(const std::vector<std::string>& words, const Environment& environment = {});

/// The last line of a program's output, which usually names the cause of a failure.
std::string lastLine(std::string output);

} // namespace grouser::support
