// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/support/child_process.hpp"

#include <string>
#include <vector>

namespace grouser::support {

/// Exit of a called program.
struct CallOutcome {
  bool started = false;
  int status = -1;    ///< exit status; -1: it was not started, or a signal ended it
  std::string output; ///< stdout and stderr together; then, where there is no exit status, a line with the cause
};

/// Runs a program and waits for it to finish. `words`: the program's name, looked up on the PATH unless it contains a
/// slash, then its arguments. A signal that terminates the calling process is forwarded to the child.
CallOutcome callProgram(const std::vector<std::string>& words, const Environment& environment = {});

/// The last line of what a program has printed: most name the cause of a failure there.
std::string lastLine(std::string output);

} // namespace grouser::support
