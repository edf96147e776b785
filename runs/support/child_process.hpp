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
  int status = -1;          ///< exit status; -1: a signal ended the process
  int signal = 0;           ///< signal that ended the process; 0: none
  std::string text() const; ///< "ended by signal 9 (Killed)", "ended with exit code 3"
};

/// Variables that a process has in addition to the environment of its parent, or that replace it.
using Environment = std::vector<std::pair<std::string, std::string>>;

struct Program {
  std::vector<std::string> words; ///< name, searched on the PATH unless it contains a slash, and arguments
  Environment environment = {};
  std::filesystem::path log = {}; ///< file for its stdout and stderr; empty: a pipe, for read()
  bool append = false;            ///< append to the log; false: replace the log
  bool input = false;             ///< true: stdin is a pipe, for write(); false: stdin of this process
};

/// A child process. It is ended when this object is destroyed or this process ends for any reason: a program by
/// SIGTERM, so that it can save its work, a function by SIGKILL. Use in the main thread only.
class ChildProcess {
public:
  /// Starts a program, with the default action of SIGPIPE. Throws base::DeviceError with the cause on failure.
  explicit ChildProcess(const Program& program);
  /// Calls `work` in a copy of this process, which ends when `work` returns, without flushing or destroying objects of
  /// the parent. read() returns the data that `work` writes to the descriptor. The copy ignores SIGINT and SIGHUP. Call
  /// before this process has started any threads. Throws base::DeviceError if no process can be started.
  explicit ChildProcess(const std::function<void(const Descriptor&)>& work, const Environment& environment = {});
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  /// Writes to the stdin of the child. Returns false if the child no longer reads.
  bool write(const std::string& bytes) const { return input_.write(bytes); }
  /// Waits for output and appends it to `text`. Returns false at the end of the output.
  bool read(std::string& text);
  int output() const { return output_; } ///< descriptor of the output, for poll(); -1 after the end of the output

  /// Sends SIGTERM to a program, only once: many programs end without saving their work at a second signal.
  void terminate();
  /// Exit of the child; empty while it runs.
  std::optional<ProcessEnd> ended() { return end(false); }
  /// Closes the stdin of the child and waits for its exit. Read all output before: otherwise the child may wait for a
  /// reader.
  ProcessEnd wait();

private:
  void start(int endSignal, const Environment& environment, const std::function<void()>& act);
  std::optional<ProcessEnd> end(bool wait);

  Descriptor input_, output_;
  pid_t process_ = -1; ///< -1: the process has ended
  int endSignal_ = 0;  ///< signal that ends the child; 0: already sent
  std::optional<ProcessEnd> end_;
};

} // namespace grouser::support
