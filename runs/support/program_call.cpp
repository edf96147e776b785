// SPDX-License-Identifier: BSD-3-Clause
#include "runs/support/program_call.hpp"

#include "base/error.hpp"
#include "runs/support/stop_signals.hpp"

#include <poll.h>

#include <stdexcept>

namespace grouser::support {

namespace {
constexpr int kBetweenLooks = 100; ///< interval between checks for signals [ms]
}

CallOutcome callProgram(const std::vector<std::string>& words, const Environment& environment) {
  CallOutcome outcome;
  try {
    ChildProcess child(Program{words, environment});
    outcome.started = true;
    while (child.output() >= 0) {
      pollfd end{child.output(), POLLIN, 0};
      poll(&end, 1, kBetweenLooks);
      // A signal to this process also ends the child. From a terminal, the child has received the signal as well.
      if (StopSignals::received()) child.terminate();
      if (end.revents != 0) child.read(outcome.output);
    }
    const ProcessEnd end = child.wait();
    outcome.status = end.status;
    if (end.signal != 0) outcome.output += words.at(0) + " was " + end.text();
  } catch (const base::DeviceError& error) {
    outcome.output += error.what();
  }
  return outcome;
}

std::string lastLine(std::string output) {
  while (!output.empty() && output.back() == '\n') output.pop_back();
  return output.substr(output.rfind('\n') + 1);
}

} // namespace grouser::support
