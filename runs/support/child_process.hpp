// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/support/descriptor.hpp"

#include <sys/types.h>

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace grouser::support {

/// Exit of a process.
struct ProcessEnd {
  int status = -1;          ///< its exit status; -1: a signal ended it
  int signal = 0;           ///< the signal that ended it
  std::string text() const; ///< "ended by signal 9 (Killed)", "ended with exit code 3"
};

/// Variables that a process has besides those of its parent, or in their place.
using Environment = std::vector<std::pair<std::string, std::string>>;

struct Program {
  std::vector<std::string> words; ///< its name, looked up on the PATH unless it has a slash, and its arguments
  Environment environment = {};
  std::filesystem::path log = {}; ///< file for its stdout and stderr; empty: a pipe, for read()
  bool append = false;            ///< to the log, which else is emptied first
  bool input = false;             ///< its stdin is a pipe, for write(); else it is that of this process
};

/// A process that this one starts. It is ended with this object, and when this process ends in whatever way: a program
/// by SIGTERM, so that it may save its work, a function by SIGKILL. To be used by the main thread.
class ChildProcess {
public:
  /// Starts a program, with SIGPIPE at its default. Throws base::DeviceError with the cause where that fails.
  explicit ChildProcess(const Program& program);
  /// Calls `work` in a copy of this process, which ends when `work` returns; nothing of the parent's is flushed or
  /// destroyed in it. read() gets the data that `work` writes into the descriptor. SIGINT and SIGHUP are left to the
  /// parent. Call before this process has started any threads. Throws base::DeviceError where no process can be
  /// started.
  explicit ChildProcess(const std::function<void(const Descriptor&)>& work, const Environment& environment = {});
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  /// Writes to its stdin. False if it no longer reads.
  bool write(const std::string& bytes) const { return input_.write(bytes); }
  /// Waits for output and appends it. False at its end.
  bool read(std::string& text);
  int output() const { return output_; } ///< descriptor for poll(); -1 after its end

  /// Asks a program to end, by SIGTERM: once, as many end without saving their work at a second one.
  void terminate();
  /// Empty while it runs.
  std::optional<ProcessEnd> ended() { return end(false); }
  /// Ends its stdin, and waits for it. Its output is to be read before: it may wait for that.
  ProcessEnd wait();

private:
  void start(int endSignal, const Environment& environment, const std::function<void()>& act);
  std::optional<ProcessEnd> end(bool wait);

  Descriptor input_, output_;
  pid_t process_ = -1; ///< -1: has ended
  int endSignal_ = 0;  ///< 0: sent
  std::optional<ProcessEnd> end_;
};

} // namespace grouser::support
