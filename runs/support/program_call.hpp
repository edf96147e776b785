// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace grouser::support {

/// How another program has ended.
struct CallOutcome {
  int status = -1;    ///< exit status, 127 where there is no such program; -1: could not be started, or was killed
  std::string output; ///< stdout and stderr together
};

/// Runs a program and waits for it. `words`: its name, which is looked for on the PATH unless it has a slash, and its
/// arguments.
CallOutcome callProgram(std::vector<std::string> words);

} // namespace grouser::support
