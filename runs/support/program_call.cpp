// SPDX-License-Identifier: BSD-3-Clause
#include "runs/support/program_call.hpp"

#include "runs/support/stop_signals.hpp"

#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <utility>

namespace grouser::support {

namespace {
constexpr int kBetweenLooks = 100; ///< between looks at the signals [ms]
}

CallOutcome callProgram(std::vector<std::string> words) {
  std::vector<char*> arguments;
  for (std::string& w : words) arguments.push_back(w.data());
  arguments.push_back(nullptr);
  int ends[2];
  if (pipe(ends) != 0) return {};
  const pid_t child = fork();
  if (child == 0) {
    dup2(ends[1], STDOUT_FILENO), dup2(ends[1], STDERR_FILENO);
    close(ends[0]), close(ends[1]);
    execvp(arguments[0], arguments.data());
    _exit(127);
  }
  close(ends[1]);
  CallOutcome outcome;
  std::array<char, 4096> buffer;
  for (bool told = false; child > 0;) {
    pollfd end{ends[0], POLLIN, 0};
    poll(&end, 1, kBetweenLooks);
    // Who stops this program by its number means the other one too. From a terminal that has had it already.
    if (StopSignals::received() && !std::exchange(told, true)) kill(child, SIGTERM);
    if (!(end.revents & (POLLIN | POLLHUP))) continue;
    const ssize_t n = read(ends[0], buffer.data(), buffer.size());
    if (n <= 0) break;
    outcome.output.append(buffer.data(), static_cast<std::size_t>(n));
  }
  close(ends[0]);
  int status = 0;
  if (child > 0 && waitpid(child, &status, 0) == child && WIFEXITED(status)) outcome.status = WEXITSTATUS(status);
  return outcome;
}

} // namespace grouser::support
