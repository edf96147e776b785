// SPDX-License-Identifier: BSD-3-Clause
#include "runs/support/child_process.hpp"

#include "base/error.hpp"
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <stdexcept>

namespace grouser::support {

namespace {

base::DeviceError failure(const std::string& what) {
  return base::DeviceError(fmt::format("{}: {}", what, std::strerror(errno)));
}

struct Pipe {
  Descriptor readEnd, writeEnd;
};

Pipe makePipe() {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) throw failure("cannot create a pipe to another process");
  return {Descriptor(ends[0]), Descriptor(ends[1])};
}

Descriptor openLog(const Program& program) {
  Descriptor file(program.log, O_WRONLY | O_CREAT | (program.append ? O_APPEND : O_TRUNC));
  if (!file.good()) throw failure(program.log.string() + " cannot be written");
  return file;
}

} // namespace

std::string ProcessEnd::text() const {
  return signal != 0 ? fmt::format("ended by signal {} ({})", signal, strsignal(signal))
                     : fmt::format("ended with exit code {}", status);
}

ChildProcess::ChildProcess(const Program& program) {
  std::vector<std::string> words = program.words;
  std::vector<char*> arguments;
  for (std::string& w : words) arguments.push_back(w.data());
  arguments.push_back(nullptr);
  Pipe input, output, cause = makePipe();
  if (program.input) input = makePipe();
  if (program.log.empty())
    output = makePipe();
  else
    output.writeEnd = openLog(program);
  start(SIGTERM, program.environment, [&] {
    if (program.input) dup2(input.readEnd, STDIN_FILENO);
    dup2(output.writeEnd, STDOUT_FILENO), dup2(output.writeEnd, STDERR_FILENO);
    std::signal(SIGPIPE, SIG_DFL);
    execvp(arguments[0], arguments.data());
    cause.writeEnd.write(std::strerror(errno));
  });
  cause.writeEnd.close();
  std::string why; // the pipe stays empty if the program starts
  while (cause.readEnd.read(why)) continue;
  if (!why.empty()) {
    wait();
    throw base::DeviceError(fmt::format("{} cannot be started: {}", words[0], why));
  }
  input_ = std::move(input.writeEnd), output_ = std::move(output.readEnd);
}

ChildProcess::ChildProcess(const std::function<void(const Descriptor&)>& work, const Environment& environment) {
  Pipe output = makePipe();
  start(SIGKILL, environment, [&] {
    output.readEnd.close();
    std::signal(SIGINT, SIG_IGN);
    std::signal(SIGHUP, SIG_IGN);
    std::signal(SIGTERM, SIG_DFL);
    work(output.writeEnd);
  });
  output_ = std::move(output.readEnd);
}

ChildProcess::~ChildProcess() {
  if (process_ < 0) return;
  input_.close(), output_.close(); // the child may wait for input or for a reader of its output
  if (endSignal_ != 0) kill(process_, endSignal_);
  while (waitpid(process_, nullptr, 0) < 0 && errno == EINTR) continue;
}

/// Calls `act` in the child, which must neither return to the parent's code nor throw.
void ChildProcess::start(int endSignal, const Environment& environment, const std::function<void()>& act) {
  const pid_t parent = getpid();
  process_ = fork();
  endSignal_ = endSignal;
  if (process_ < 0) throw failure("cannot start a process");
  if (process_ > 0) return;
  [&]() noexcept {
    prctl(PR_SET_PDEATHSIG, endSignal);
    if (getppid() != parent) _exit(1); // the parent has already ended
    for (const auto& [name, value] : environment) setenv(name.c_str(), value.c_str(), 1);
    act();
  }();
  _exit(0);
}

bool ChildProcess::read(std::string& text) {
  const bool continues = output_.read(text);
  if (!continues) output_.close();
  return continues;
}

void ChildProcess::terminate() {
  if (process_ > 0 && std::exchange(endSignal_, 0) != 0) kill(process_, SIGTERM);
}

ProcessEnd ChildProcess::wait() {
  input_.close();
  return *end(true);
}

std::optional<ProcessEnd> ChildProcess::end(bool wait) {
  if (end_) return end_;
  int status = 0;
  pid_t ended = 0;
  while ((ended = waitpid(process_, &status, wait ? 0 : WNOHANG)) < 0 && errno == EINTR) continue;
  if (ended == 0) return {};
  process_ = -1;
  end_ = WIFEXITED(status) ? ProcessEnd{WEXITSTATUS(status), 0} : ProcessEnd{-1, WTERMSIG(status)};
  if (ended < 0) throw failure("cannot wait for a child process");
  return end_;
}

} // namespace grouser::support
